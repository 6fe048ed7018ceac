#include "eval/ramp.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace carve {
namespace {

struct Stop {
  double at;
  double r, g, b;
};

// The thesis's figures show CloudCompare's ramp with green at no distance.
const std::vector<Stop> kThesis = {{0, 0, 0, 255}, {0.5, 0, 200, 0}, {0.75, 255, 235, 0}, {1, 255, 0, 0}};
// Stops of ColorBrewer's RdBu and of matplotlib's viridis.
const std::vector<Stop> kDiverging = {{0, 5, 48, 97},       {0.2, 67, 147, 195},   {0.35, 146, 197, 222},
                                      {0.5, 247, 247, 247}, {0.65, 244, 165, 130}, {0.8, 214, 96, 77},
                                      {1, 103, 0, 31}};
const std::vector<Stop> kSequential = {{0, 68, 1, 84},        {0.125, 71, 44, 122},  {0.25, 59, 81, 139},
                                       {0.375, 44, 113, 142}, {0.5, 33, 144, 141},   {0.625, 39, 173, 129},
                                       {0.75, 92, 200, 99},   {0.875, 170, 220, 50}, {1, 253, 231, 37}};

Rgba mix(const std::vector<Stop>& stops, double t) {
  const auto above = std::find_if(stops.begin() + 1, stops.end() - 1, [t](const Stop& s) { return t <= s.at; });
  const Stop &low = *(above - 1), &high = *above;
  const double share = std::clamp((t - low.at) / (high.at - low.at), 0.0, 1.0);
  const auto channel = [share](double from, double to) {
    return static_cast<std::uint8_t>(std::lround(from + share * (to - from)));
  };
  return {channel(low.r, high.r), channel(low.g, high.g), channel(low.b, high.b), 255};
}

}  // namespace

Rgba colour(Ramp ramp, double distance, double range) {
  switch (ramp) {
    case Ramp::thesis:
      return mix(kThesis, std::clamp(0.5 + distance / (2 * range), 0.0, 1.0));
    case Ramp::diverging:
      return mix(kDiverging, std::clamp(0.5 + distance / (2 * range), 0.0, 1.0));
    default:
      return mix(kSequential, std::clamp(std::abs(distance) / range, 0.0, 1.0));
  }
}

}  // namespace carve
