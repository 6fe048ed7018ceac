#include "eval/distance_transform.h"

#include <cmath>
#include <span>
#include <vector>

#include "carve/core/lower_envelope.h"
#include "carve/core/parallel.h"

namespace carve {

Raster<float> distance_transform(const Mask& mask) {
  Raster<double> squared(mask.width, mask.height);
  parallel_ranges(0, mask.width, 32, [&](int first, int last) {
    LowerEnvelope envelope(mask.height);
    std::vector<double> line(mask.height), out(mask.height);
    for (int x = first; x < last; ++x) {
      for (int y = 0; y < mask.height; ++y) line[y] = mask(x, y) ? 0 : LowerEnvelope::kNone;
      envelope.apply(line, out);
      for (int y = 0; y < mask.height; ++y) squared(x, y) = out[y];
    }
  });
  Raster<float> distance(mask.width, mask.height);
  parallel_ranges(0, mask.height, 32, [&](int first, int last) {
    LowerEnvelope envelope(mask.width);
    std::vector<double> out(mask.width);
    for (int y = first; y < last; ++y) {
      envelope.apply(std::span(squared.pixels).subspan(static_cast<std::size_t>(y) * mask.width, mask.width), out);
      for (int x = 0; x < mask.width; ++x) distance(x, y) = static_cast<float>(std::sqrt(out[x]));
    }
  });
  return distance;
}

}  // namespace carve
