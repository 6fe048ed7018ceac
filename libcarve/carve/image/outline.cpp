#include "carve/image/outline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace carve {
namespace {

constexpr double kHalf = 127.5;  // of 255

/// The coverage with rows and columns exchanged on demand: `along` is the coordinate a line runs along.
struct Lines {
  const Mask& coverage;
  bool along_rows;

  int pixel(int along, int across) const {
    const int x = along_rows ? along : across, y = along_rows ? across : along;
    return coverage.contains(x, y) ? coverage(x, y) : 0;
  }
  double interpolated(double along, double across) const {
    const double i = std::floor(along - 0.5), j = std::floor(across - 0.5);
    const double u = along - 0.5 - i, v = across - 0.5 - j;
    const auto at = [&](int di, int dj) { return pixel(static_cast<int>(i) + di, static_cast<int>(j) + dj); };
    return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
  }
  bool contains(int i, int j, double along, double across) const {
    const int c = pixel(i, j);
    return c == 255 || (c > 0 && interpolated(along, across) >= kHalf);
  }

  /// From `from` to `to` within one partly covered pixel's half, where the coverage is linear.
  double leave_half(double from, double to, double across) const {
    const double start = interpolated(from, across), end = interpolated(to, across);
    if (start < kHalf) return from;
    return end >= kHalf ? to : from + (to - from) * (start - kHalf) / (start - end);
  }

  /// Along pixel row `j` of the lines.
  double leave(double from, double to, double across, int j) const {
    const int step = to > from ? 1 : -1;
    // The pixel that lies ahead.
    int i = static_cast<int>(step > 0 ? std::floor(from + kOutlineTolerance) : std::ceil(from - kOutlineTolerance) - 1);
    for (double x = from; (to - x) * step > 0; i += step) {
      const int c = pixel(i, j);
      if (c == 0) return x;
      const auto nearer_end = [&](double end) { return (to - end) * step < 0 ? to : end; };
      const double end = nearer_end(step > 0 ? i + 1 : i);
      if (c < 255) {
        const double middle = nearer_end(i + 0.5);
        if ((middle - x) * step > 0) {
          const double left = leave_half(x, middle, across);
          if (left != middle) return left;
          x = middle;
        }
        const double left = leave_half(x, end, across);
        if (left != end) return left;
      }
      x = end;
    }
    return to;
  }

  /// A line between two pixel rows belongs to both: it leaves where the later one does.
  double leave(double from, double to, double across) const {
    const int low = static_cast<int>(std::floor(across - kOutlineTolerance));
    const int high = static_cast<int>(std::floor(across + kOutlineTolerance));
    const double a = leave(from, to, across, low), b = high == low ? a : leave(from, to, across, high);
    return to > from ? std::max(a, b) : std::min(a, b);
  }

  /// How far the object reaches beyond the centre line of `last`, the last pixels of its bounds, in direction `step`.
  double reach(int last, int step, int begin, int end) const {
    double farthest = 0.5;  // the bounds as they are, if the object does not touch them
    bool touched = false;
    for (int j = begin; j < end; ++j) {
      const int inner = pixel(last, j), outer = pixel(last + step, j);
      if (inner < kHalf) continue;
      const double here = outer >= kHalf ? 0.5 : (inner - kHalf) / (inner - outer);
      farthest = touched ? std::max(farthest, here) : here;
      touched = true;
    }
    return farthest;
  }
};

}  // namespace

bool Outline::contains(double column, double row) const {
  const Lines lines{coverage_, true};
  const auto pixels = [](double x) {
    return std::pair(static_cast<int>(std::floor(x - kOutlineTolerance)),
                     static_cast<int>(std::floor(x + kOutlineTolerance)));
  };
  const auto [left, right] = pixels(column);
  const auto [top, bottom] = pixels(row);
  for (int j = top; j <= bottom; ++j)
    for (int i = left; i <= right; ++i)
      if (lines.contains(i, j, column, row)) return true;
  return false;
}

double Outline::leave_along_row(double from, double to, double row) const {
  return Lines{coverage_, true}.leave(from, to, row);
}

double Outline::leave_along_column(double from, double to, double column) const {
  return Lines{coverage_, false}.leave(from, to, column);
}

OutlineBounds outline_bounds(const Drawing& drawing) {
  const Box& box = drawing.bounds;
  const Lines rows{drawing.coverage, true}, columns{drawing.coverage, false};
  return {box.x0 + 0.5 - rows.reach(box.x0, -1, box.y0, box.y1),
          box.y0 + 0.5 - columns.reach(box.y0, -1, box.x0, box.x1),
          box.x1 - 0.5 + rows.reach(box.x1 - 1, +1, box.y0, box.y1),
          box.y1 - 0.5 + columns.reach(box.y1 - 1, +1, box.x0, box.x1)};
}

}  // namespace carve
