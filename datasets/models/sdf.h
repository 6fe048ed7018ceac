#pragma once
#include <algorithm>
#include <cmath>

#include "carve/core/vector.h"

namespace carve::sdf {

/// Fields for polygonise: negative inside, about the distance near the surface.
inline double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii) {
  const Vec3 q = (p - centre).cwiseQuotient(radii);
  const double k = q.norm(), slope = q.cwiseQuotient(radii).norm();
  return slope > 0 ? k * (k - 1) / slope : -radii.minCoeff();
}

/// Around the segment from a to b, the radius changing from ra to rb.
inline double capsule(const Vec3& p, const Vec3& a, const Vec3& b, double ra, double rb) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - (ra + t * (rb - ra));
}

/// Union whose seam is rounded over a width of k.
inline double join(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k / 4;
}

/// a without b, rounded likewise.
inline double cut(double a, double b, double k) { return -join(-a, b, k); }

}  // namespace carve::sdf
