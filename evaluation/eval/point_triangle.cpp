#include "eval/point_triangle.h"

#include "eval/point_triangle_kernel.h"

namespace carve {
namespace {

using kernel::V3;

V3<double> load(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

Footpoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const V3<double> pk = load(p), ak = load(a), bk = load(b), ck = load(c);
  double v, w, t, squared, best;
  kernel::point_face(pk - ak, bk - ak, ck - ak, v, w, best);
  Footpoint foot{a + v * (b - a) + w * (c - a), 0, Feature::face};
  const auto offer = [&](const Vec3& from, const Vec3& to, Feature at_from, Feature between, Feature at_to) {
    if (!(squared < best)) return;
    best = squared;
    foot.feature = t == 0 ? at_from : t == 1 ? at_to : between;
    foot.point = t == 0 ? from : t == 1 ? to : from + t * (to - from);
  };
  kernel::point_segment(pk - ak, bk - ak, t, squared);
  offer(a, b, Feature::corner_a, Feature::edge_ab, Feature::corner_b);
  kernel::point_segment(pk - ak, ck - ak, t, squared);
  offer(a, c, Feature::corner_a, Feature::edge_ca, Feature::corner_c);
  kernel::point_segment(pk - bk, ck - bk, t, squared);
  offer(b, c, Feature::corner_b, Feature::edge_bc, Feature::corner_c);
  foot.squared_distance = best;
  return foot;
}

}  // namespace carve
