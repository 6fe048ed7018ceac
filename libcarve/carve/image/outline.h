#pragma once
#include "carve/image/drawing.h"

namespace carve {

/// The region of the plane that a drawing's object covers, to a fraction of a pixel (pixel (i, j) is [i, i+1] x
/// [j, j+1]): whole pixels as they are; within a pixel that is covered in part, where the coverage, interpolated
/// bilinearly between the pixels' centres, is at least one half. So hard drawings keep their pixels' corners, soft
/// borders give smooth contours. Borders belong to the region, to within kOutlineTolerance.
class Outline {
 public:
  /// \param coverage  0..255 as in Drawing; referred to, not copied
  explicit Outline(const Mask& coverage) : coverage_(coverage) {}

  bool contains(double column, double row) const;

  /// Where the straight way along a pixel row, from column `from` to `to`, first leaves the region: `from` if it starts
  /// outside, `to` if it ends inside.
  double leave_along_row(double from, double to, double row) const;
  /// The same along a pixel column, from row `from` to `to`.
  double leave_along_column(double from, double to, double column) const;

 private:
  const Mask& coverage_;
};

inline constexpr double kOutlineTolerance = 1e-6;  // pixels

/// The drawing's bounds to a fraction of a pixel.
struct OutlineBounds {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
OutlineBounds outline_bounds(const Drawing& drawing);

}  // namespace carve
