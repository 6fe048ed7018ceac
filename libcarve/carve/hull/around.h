#pragma once
// Internal to the linking of facets: sides grouped around points and sorted around lines.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "carve/core/vector.h"
#include "carve/hull/facets.h"

namespace carve::hull {

inline Vec3 position(const ExactPoint& p) { return {p.coordinate(0), p.coordinate(1), p.coordinate(2)}; }
inline Vec3 unit_normal(const FacetPlane& plane) {
  return Vec3(plane.normal[0], plane.normal[1], plane.normal[2]).normalized();
}

/// Side indices with one key in 0..keys-1 (negative: none), in rising order: counting sort.
struct Groups {
  std::vector<int> start, items;

  template <class Key>
  Groups(int count, int keys, Key&& key) : start(keys + 1), items() {
    for (int i = 0; i < count; ++i)
      if (key(i) >= 0) ++start[key(i) + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    items.resize(start.back());
    std::vector<int> at(start.begin(), start.end() - 1);
    for (int i = 0; i < count; ++i)
      if (key(i) >= 0) items[at[key(i)]++] = i;
  }
  std::span<int> operator[](int k) { return {items.data() + start[k], items.data() + start[k + 1]}; }
};

/// Sides around an axis, by their angles about it.
class Spokes {
 public:
  explicit Spokes(const Vec3& axis) : right_(axis.unitOrthogonal()), up_(axis.cross(right_)) {}

  /// \param way  from the axis outwards  \param starts  what reaches, counter-clockwise, to the next spoke
  void add(const Vec3& way, int side, bool starts) {
    spokes_.push_back({std::atan2(way.dot(up_) + 0.0, way.dot(right_)), starts, side});
  }
  /// Calls use(side, next side) for what starts and the spoke where it ends.
  /// \throws std::logic_error with this text where starts and ends do not alternate
  template <class Use>
  void each_sector(const char* error, Use&& use) {
    std::sort(spokes_.begin(), spokes_.end());
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
      const auto& [angle, starts, side] = spokes_[i];
      const auto& [next_angle, next_starts, next_side] = spokes_[(i + 1) % spokes_.size()];
      if (!starts) continue;
      if (next_starts) throw std::logic_error(error);
      use(side, next_side);
    }
  }

 private:
  Vec3 right_, up_;
  std::vector<std::tuple<double, bool, int>> spokes_;
};

}  // namespace carve::hull
