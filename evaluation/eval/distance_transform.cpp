#include "eval/distance_transform.h"

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// In a line of squared distances f: min over q of f(q) + (p - q)^2, as the lower envelope of parabolas.
class Envelope {
 public:
  explicit Envelope(int length) : place_(length), from_(length + 1) {}

  void apply(std::span<const double> f, std::span<double> out) {
    int count = 0;
    for (int q = 0; q < static_cast<int>(f.size()); ++q) {
      if (f[q] == kInfinity) continue;
      double start = -kInfinity;
      for (; count > 0; --count) {
        const int p = place_[count - 1];
        start = (f[q] - f[p] + static_cast<double>(q) * q - static_cast<double>(p) * p) / (2.0 * (q - p));
        if (start > from_[count - 1]) break;
        start = -kInfinity;
      }
      place_[count] = q;
      from_[count++] = start;
    }
    for (int p = 0, k = 0; p < static_cast<int>(out.size()); ++p) {
      if (count == 0) {
        out[p] = kInfinity;
        continue;
      }
      while (k + 1 < count && from_[k + 1] <= p) ++k;
      out[p] = f[place_[k]] + static_cast<double>(p - place_[k]) * (p - place_[k]);
    }
  }

 private:
  std::vector<int> place_;
  std::vector<double> from_;
};

}  // namespace

Raster<float> distance_transform(const Mask& mask) {
  Raster<double> squared(mask.width, mask.height);
  parallel_ranges(0, mask.width, 32, [&](int first, int last) {
    Envelope envelope(mask.height);
    std::vector<double> line(mask.height), out(mask.height);
    for (int x = first; x < last; ++x) {
      for (int y = 0; y < mask.height; ++y) line[y] = mask(x, y) ? 0 : kInfinity;
      envelope.apply(line, out);
      for (int y = 0; y < mask.height; ++y) squared(x, y) = out[y];
    }
  });
  Raster<float> distance(mask.width, mask.height);
  parallel_ranges(0, mask.height, 32, [&](int first, int last) {
    Envelope envelope(mask.width);
    std::vector<double> out(mask.width);
    for (int y = first; y < last; ++y) {
      envelope.apply(std::span(squared.pixels).subspan(static_cast<std::size_t>(y) * mask.width, mask.width), out);
      for (int x = 0; x < mask.width; ++x) distance(x, y) = static_cast<float>(std::sqrt(out[x]));
    }
  });
  return distance;
}

}  // namespace carve
