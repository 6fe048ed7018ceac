#include "carve/carving/nearest.h"

#include <cmath>
#include <limits>

namespace carve {
namespace {

class Propagation {
 public:
  explicit Propagation(const Mask& mask) : nearest_(mask.width, mask.height, -1) {
    for (std::size_t i = 0; i < mask.pixels.size(); ++i)
      if (mask.pixels[i]) nearest_.pixels[i] = static_cast<int>(i);
  }

  Raster<int> run() {
    const int w = nearest_.width, h = nearest_.height;
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) improve(x, y, {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}});
      for (int x = w - 1; x >= 0; --x) improve(x, y, {{1, 0}});
    }
    for (int y = h - 1; y >= 0; --y) {
      for (int x = w - 1; x >= 0; --x) improve(x, y, {{1, 0}, {1, 1}, {0, 1}, {-1, 1}});
      for (int x = 0; x < w; ++x) improve(x, y, {{-1, 0}});
    }
    return std::move(nearest_);
  }

 private:
  struct Step {
    int x, y;
  };
  std::int64_t squared(int x, int y, int seed) const {
    const std::int64_t dx = seed % nearest_.width - x, dy = seed / nearest_.width - y;
    return dx * dx + dy * dy;
  }
  void improve(int x, int y, std::initializer_list<Step> steps) {
    int best = nearest_(x, y);
    std::int64_t distance = best < 0 ? std::numeric_limits<std::int64_t>::max() : squared(x, y, best);
    if (distance == 0) return;
    for (const Step& step : steps) {
      if (!nearest_.contains(x + step.x, y + step.y)) continue;
      const int seed = nearest_(x + step.x, y + step.y);
      if (seed < 0 || seed == best) continue;
      if (const std::int64_t d = squared(x, y, seed); d < distance) distance = d, best = seed;
    }
    nearest_(x, y) = best;
  }
  Raster<int> nearest_;
};

}  // namespace

Raster<int> nearest_set(const Mask& mask) { return Propagation(mask).run(); }

Raster<float> distance_to(const Raster<int>& nearest) {
  Raster<float> distance(nearest.width, nearest.height, std::numeric_limits<float>::infinity());
  for (int y = 0; y < nearest.height; ++y)
    for (int x = 0; x < nearest.width; ++x)
      if (const int seed = nearest(x, y); seed >= 0)
        distance(x, y) = static_cast<float>(std::hypot(seed % nearest.width - x, seed / nearest.width - y));
  return distance;
}

}  // namespace carve
