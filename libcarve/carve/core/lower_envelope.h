#pragma once
#include <limits>
#include <span>
#include <vector>

namespace carve {

/// Along a line of values f, min over q of f[q] + (p - q)^2 for each place p: of values that are 0 or infinite, the
/// squared distance to the nearest 0. By the lower envelope of parabolas \cite felzenszwalb_2012, linear in the line's
/// length. Lines along one axis after the other give it for rasters and grids.
class LowerEnvelope {
 public:
  static constexpr double kNone = std::numeric_limits<double>::infinity();  // no parabola there

  /// \param longest  values of a line, at most
  explicit LowerEnvelope(int longest) : place_(longest), from_(longest + 1) {}

  void apply(std::span<const double> f, std::span<double> out) {
    int count = 0;
    for (int q = 0; q < static_cast<int>(f.size()); ++q) {
      if (f[q] == kNone) continue;
      double start = -kNone;
      for (; count > 0; --count) {
        const int p = place_[count - 1];
        start = (f[q] - f[p] + static_cast<double>(q) * q - static_cast<double>(p) * p) / (2.0 * (q - p));
        if (start > from_[count - 1]) break;
        start = -kNone;
      }
      place_[count] = q;
      from_[count++] = start;
    }
    for (int p = 0, k = 0; p < static_cast<int>(out.size()); ++p) {
      if (count == 0) {
        out[p] = kNone;
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

}  // namespace carve
