#pragma once

namespace carve::kernel {

template <class R>
struct V3 {
  R x, y, z;
};
template <class R>
[[gnu::always_inline]] inline V3<R> operator-(const V3<R>& a, const V3<R>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
[[gnu::always_inline]] inline V3<R> operator*(const R& s, const V3<R>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class R>
[[gnu::always_inline]] inline void dot(const V3<R>& a, const V3<R>& b, R& out) {
  out = a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Nearest point a + t * side of a segment to a + ap, and its squared distance; t = 0 on a segment without length.
template <class R>
[[gnu::always_inline]] inline void point_segment(const V3<R>& ap, const V3<R>& side, R& t, R& squared) {
  const R zero{}, one = zero + 1.0;
  R along, length;
  dot(ap, side, along);
  dot(side, side, length);
  t = length > zero ? along / length : zero;
  t = t < zero ? zero : t;
  t = t > one ? one : t;
  const V3<R> rest = ap - t * side;
  dot(rest, rest, squared);
}

/// Nearest point a + v ab + w ac of the triangle's plane, and its squared distance; infinity where that point lies
/// outside the triangle. Orthogonalises ac against ab first: backward stable where the normal equations are not.
template <class R>
[[gnu::always_inline]] inline void point_face(const V3<R>& ap, const V3<R>& ab, const V3<R>& ac, R& v, R& w,
                                              R& squared) {
  const R zero{}, one = zero + 1.0, infinity = zero + __builtin_inf();
  R length, along_p, along_c, height, rise;
  dot(ab, ab, length);
  dot(ap, ab, along_p);
  dot(ac, ab, along_c);
  const R safe_length = length > zero ? length : one;
  const R s = along_p / safe_length, g = along_c / safe_length;
  const V3<R> up = ac - g * ab, rest = ap - s * ab;
  dot(up, up, height);
  dot(rest, up, rise);
  const R safe_height = height > zero ? height : one;
  w = rise / safe_height;
  v = s - w * g;
  const V3<R> gap = (ap - v * ab) - w * ac;
  dot(gap, gap, squared);
  // Nested selections rather than &: the same text serves double and vectors of double.
  squared = v >= zero ? squared : infinity;
  squared = w >= zero ? squared : infinity;
  squared = v + w <= one ? squared : infinity;
  squared = height > zero ? squared : infinity;
}

/// Squared distance of p to triangle abc; the very operations of closest_on_triangle.
template <class R>
[[gnu::always_inline]] inline void point_triangle(const V3<R>& p, const V3<R>& a, const V3<R>& b, const V3<R>& c,
                                                  R& squared) {
  const V3<R> ap = p - a, ab = b - a, ac = c - a;
  R t, v, w, side;
  point_face(ap, ab, ac, v, w, squared);
  point_segment(ap, ab, t, side);
  squared = side < squared ? side : squared;
  point_segment(ap, ac, t, side);
  squared = side < squared ? side : squared;
  point_segment(p - b, c - b, t, side);
  squared = side < squared ? side : squared;
}

}  // namespace carve::kernel
