#pragma once
#include <array>
#include <span>

#include "carve/core/raster.h"

namespace carve {

enum class Ramp {
  thesis,     // signed: blue shrunk, green near, yellow inflated, red far (thesis 4.1.1)
  diverging,  // signed, safe for colour-blind readers: blue inside, white at 0, red outside
  sequential  // unsigned, safe for colour-blind readers: dark near, yellow far
};
inline std::span<const char* const> names(Ramp) {
  static constexpr const char* all[] = {"thesis", "diverging", "sequential"};
  return all;
}
inline bool is_signed(Ramp ramp) { return ramp != Ramp::sequential; }

/// The colour of a distance; beyond the range it is that of the range's end. Signed ramps span [-range, range],
/// sequential spans [0, range] and takes the distance's absolute value. range > 0.
Rgba colour(Ramp ramp, double distance, double range);

}  // namespace carve
