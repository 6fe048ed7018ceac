#include "eval/sample.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "carve/core/parallel.h"
#include "carve/core/random.h"

namespace carve {
namespace {

// The n-th number of the stream `seed`, uniform in [0, 1): of a counter, so that any thread can make any sample.
double uniform(std::uint64_t seed, std::uint64_t n) {
  return unit(spread(spread((seed + 1) * kGolden + n * 0xd1342543de82ef95u)));
}

}  // namespace

Samples sample_surface(const Mesh& mesh, int count, unsigned seed) {
  if (count < 1) throw std::invalid_argument("sample count must be at least 1, got " + std::to_string(count));
  std::vector<double> area_before{0};
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& origin = mesh.positions[a];
    const double area = (mesh.positions[b] - origin).cross(mesh.positions[c] - origin).norm() / 2;
    area_before.push_back(area_before.back() + area);
  }
  const double total = area_before.back();
  if (!(total > 0)) throw std::invalid_argument("a mesh without area cannot be sampled");

  Samples samples{std::vector<Vec3>(count), std::vector<int>(count)};
  parallel_ranges(0, count, 8192, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const double reach = (i + uniform(seed, 3ull * i)) / count * total;
      // The triangle whose stretch of the running area holds `reach`; one without area is never it.
      const auto after = std::upper_bound(area_before.begin() + 1, area_before.end() - 1, reach);
      const int t = static_cast<int>(after - area_before.begin()) - 1;
      const auto& [a, b, c] = mesh.triangles[t];
      const double root = std::sqrt(uniform(seed, 3ull * i + 1)), v = uniform(seed, 3ull * i + 2);
      samples.points[i] =
          (1 - root) * mesh.positions[a] + root * (1 - v) * mesh.positions[b] + root * v * mesh.positions[c];
      samples.triangles[i] = t;
    }
  });
  return samples;
}

}  // namespace carve
