#pragma once
#include <functional>
#include <stop_token>
#include <string_view>

#include "carve/core/error.h"

namespace carve {

/// What a long stage is given besides its input: where to tell how far it is, and whether to go on.
struct Monitor {
  std::function<void(std::string_view stage, double fraction)> progress = {};  // fraction in [0, 1]
  std::stop_token stop = {};

  /// Reports progress; throws Cancelled once a stop was requested.
  void at(std::string_view stage, double fraction) const {
    if (stop.stop_requested()) throw Cancelled();
    if (progress) progress(stage, fraction);
  }
};

}  // namespace carve
