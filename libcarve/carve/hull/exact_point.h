#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace carve::hull {

__extension__ typedef __int128 Int128;

/// A point with rational coordinates, whole + rest / den. Where three planes with the lattice's coefficients meet, den
/// is below 2^53; `part` is rest / den correctly rounded, so it depends on the value alone, whatever the fraction.
struct ExactPoint {
  std::array<std::int32_t, 3> whole;
  std::array<std::int64_t, 3> rest;  // 0 <= rest < den
  std::int64_t den;
  std::array<double, 3> part;

  double coordinate(int axis) const { return whole[axis] + part[axis]; }
  bool operator==(const ExactPoint& other) const;
};

/// The point numerators / den, den > 0. Its coordinates must lie within 2^30.
ExactPoint exact_point(const std::array<Int128, 3>& numerators, std::int64_t den);

/// Sign of p's coordinate less q's.
int compare(const ExactPoint& p, const ExactPoint& q, int axis);

/// Sign of the area of the triangle p, q, r in the plane of axes i (to the right) and j (upwards).
int orientation(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r, int i, int j);

/// Points by their exact value: equal points get one index.
class PointIndex {
 public:
  PointIndex() : slots_(1 << 12, -1) {}
  int operator()(const ExactPoint& point);
  const std::vector<ExactPoint>& points() const { return points_; }

 private:
  void grow();
  std::vector<ExactPoint> points_;
  std::vector<std::int32_t> slots_;
};

}  // namespace carve::hull
