#include "eval/morton.h"

#include <array>
#include <utility>

namespace carve {
namespace {

// The ten low bits of x, two zeros between them.
std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 16)) & 0x030000ff;
  x = (x | (x << 8)) & 0x0300f00f;
  x = (x | (x << 4)) & 0x030c30c3;
  x = (x | (x << 2)) & 0x09249249;
  return x;
}

struct Coded {
  std::uint32_t code;
  std::int32_t index;
};

}  // namespace

std::vector<std::int32_t> morton_order(std::span<const Vec3> points) {
  if (points.empty()) return {};
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double side = (high - low).maxCoeff();
  const double steps = side > 0 ? 1023 / side : 0;
  std::vector<Coded> from(points.size()), to(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 cell = (points[i] - low) * steps;
    from[i] = {spread(static_cast<std::uint32_t>(cell.x())) | spread(static_cast<std::uint32_t>(cell.y())) << 1 |
                   spread(static_cast<std::uint32_t>(cell.z())) << 2,
               static_cast<std::int32_t>(i)};
  }
  for (int shift = 0; shift < 30; shift += 10) {
    std::array<std::uint32_t, 1024> start{};
    for (const Coded& entry : from) ++start[entry.code >> shift & 1023];
    std::uint32_t sum = 0;
    for (std::uint32_t& count : start) sum += std::exchange(count, sum);
    for (const Coded& entry : from) to[start[entry.code >> shift & 1023]++] = entry;
    from.swap(to);
  }
  std::vector<std::int32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = from[i].index;
  return order;
}

}  // namespace carve
