#include "carve/hull/exact_point.h"

#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

namespace carve::hull {
namespace {

int sign(auto x) { return (x > 0) - (x < 0); }

std::uint64_t hash(const ExactPoint& p) {
  std::uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis) {
    h ^= std::bit_cast<std::uint64_t>(p.part[axis]) + static_cast<std::uint32_t>(p.whole[axis]);
    h *= 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  return h;
}

// The determinant of homogeneous coordinates, up to 190 bits.
int exact_orientation(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r, int i, int j) {
  using Wide = boost::multiprecision::int256_t;
  const auto relative = [&](const ExactPoint& a, int axis) {
    return Wide(a.whole[axis] - p.whole[axis]) * a.den + a.rest[axis];
  };
  const Wide px = p.rest[i], py = p.rest[j], qx = relative(q, i), qy = relative(q, j), rx = relative(r, i),
             ry = relative(r, j);
  const Wide qrx = qx * p.den - px * q.den, qry = qy * p.den - py * q.den;
  const Wide rrx = rx * p.den - px * r.den, rry = ry * p.den - py * r.den;
  return (qrx * rry - qry * rrx).sign();
}

}  // namespace

ExactPoint exact_point(const std::array<Int128, 3>& numerators, std::int64_t den) {
  ExactPoint point{{}, {}, den, {}};
  for (int axis = 0; axis < 3; ++axis) {
    const Int128 n = numerators[axis];
    auto whole = static_cast<std::int64_t>(std::floor(static_cast<double>(n) / static_cast<double>(den)));
    Int128 rest = n - static_cast<Int128>(whole) * den;
    for (; rest < 0; rest += den) --whole;
    for (; rest >= den; rest -= den) ++whole;
    point.whole[axis] = static_cast<std::int32_t>(whole);
    point.rest[axis] = static_cast<std::int64_t>(rest);
    point.part[axis] = static_cast<double>(point.rest[axis]) / static_cast<double>(den);
  }
  if ((point.rest[0] | point.rest[1] | point.rest[2]) == 0) point.den = 1;
  return point;
}

int compare(const ExactPoint& p, const ExactPoint& q, int axis) {
  if (p.whole[axis] != q.whole[axis]) return p.whole[axis] < q.whole[axis] ? -1 : 1;
  if (p.part[axis] != q.part[axis]) return p.part[axis] < q.part[axis] ? -1 : 1;  // rounding keeps the order
  if (p.den == q.den) return sign(p.rest[axis] - q.rest[axis]);
  return sign(static_cast<Int128>(p.rest[axis]) * q.den - static_cast<Int128>(q.rest[axis]) * p.den);
}

bool ExactPoint::operator==(const ExactPoint& other) const {
  return whole == other.whole && part == other.part && compare(*this, other, 0) == 0 && compare(*this, other, 1) == 0 &&
         compare(*this, other, 2) == 0;
}

int orientation(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r, int i, int j) {
  const auto difference = [](const ExactPoint& a, const ExactPoint& b, int axis) {
    return (a.whole[axis] - b.whole[axis]) + (a.part[axis] - b.part[axis]);
  };
  const double qx = difference(q, p, i), qy = difference(q, p, j);
  const double rx = difference(r, p, i), ry = difference(r, p, j);
  const double determinant = qx * ry - qy * rx;
  if (p.den == 1 && q.den == 1 && r.den == 1) return sign(determinant);  // integers below 2^35: exact
  // Each difference is off by at most 2^-52 (1 + its size).
  const double error = 5e-16 * (std::abs(qx) + std::abs(qy) + std::abs(rx) + std::abs(ry)) +
                       2e-15 * (std::abs(qx * ry) + std::abs(qy * rx)) + 1e-30;
  if (std::abs(determinant) > error) return sign(determinant);
  return exact_orientation(p, q, r, i, j);
}

int PointIndex::operator()(const ExactPoint& point) {
  if (2 * points_.size() >= slots_.size()) grow();
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hash(point) & mask;
  for (; slots_[at] >= 0; at = (at + 1) & mask)
    if (points_[slots_[at]] == point) return slots_[at];
  slots_[at] = static_cast<std::int32_t>(points_.size());
  points_.push_back(point);
  return slots_[at];
}

void PointIndex::grow() {
  slots_.assign(2 * slots_.size(), -1);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    std::size_t at = hash(points_[i]) & mask;
    while (slots_[at] >= 0) at = (at + 1) & mask;
    slots_[at] = static_cast<std::int32_t>(i);
  }
}

}  // namespace carve::hull
