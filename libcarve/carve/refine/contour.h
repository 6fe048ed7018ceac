#pragma once
// Internal to carve/refine: a drawing's outline as lines, and how far points lie from it.
#include <cstdint>
#include <vector>

#include "carve/core/raster.h"
#include "carve/views/view_set.h"

namespace carve::refining {

/// Where a point lies against an outline, in the view's plane (right, up; object units).
struct Nearest {
  double distance = 0;          // signed, positive outside
  Vec2 outward = Vec2::Zero();  // unit, the way in which the distance grows
  int piece = 0;                // of the outline
};

/// The outline of one drawing in object units, at the precision of image/outline.h: pieces of at most a pixel's length,
/// one after another around each loop.
class Contour {
 public:
  explicit Contour(const AlignedView& view);

  Vec2 project(const Vec3& p) const { return {p[right_], p[up_]}; }
  void shift(Vec3& p, const Vec2& by) const { p[right_] += by.x(), p[up_] += by.y(); }
  Nearest nearest(const Vec3& p) const;
  int pieces() const { return static_cast<int>(from_.size()); }
  double length(int piece) const { return (to_[piece] - from_[piece]).norm(); }
  /// Part of a line that is too long and straight for the outline of something round.
  bool straight(int piece) const { return straight_[piece] != 0; }
  /// Of the largest circle inside the outline that touches the piece.
  double radius(int piece) const { return radius_[piece]; }
  /// Within a line that was drawn inside the outline.
  bool on_stroke(const Vec3& p) const;

 private:
  void trace();
  void find_straight(int first, int last);
  void spread_nearest();
  void find_radii();
  Nearest nearest_in_plane(const Vec2& p) const;
  int cell(double x, double low, int count) const;
  double distance2(int piece, const Vec2& p) const;
  Vec2 closest(int piece, const Vec2& p) const;

  const AlignedView& view_;
  int right_, up_;
  double pixel_;                 // object units
  std::vector<Vec2> from_, to_;  // pieces; the object lies to their left
  std::vector<std::uint8_t> straight_;
  std::vector<double> radius_;
  Vec2 low_;
  double cell_ = 1;
  Raster<int> nearest_;  // piece nearest to the cells' centres
};

}  // namespace carve::refining
