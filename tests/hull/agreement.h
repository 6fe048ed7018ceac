#pragma once
#include <string>

#include "carve/hull/polyhedral_hull.h"

namespace carve {

struct Agreement {
  std::string differences;         // empty: the methods agree
  std::string volume;              // exact
  bool empty = false;              // nothing in common, by all methods
  bool not_representable = false;  // corefinement refused a result that touches itself
};

/// The three methods on one input: the same volume as exact rationals, the same area to 1e-12 of it, each a solid
/// without degenerate triangles or self-intersection.
Agreement compare_methods(const Silhouettes& silhouettes);

}  // namespace carve
