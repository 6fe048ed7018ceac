#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/pca_estimate_normals.h>
#include <CGAL/property_map.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "carve/photo/stereo.h"

namespace carve {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using PointAndNormal = std::pair<Kernel::Point_3, Kernel::Vector_3>;

constexpr int kNeighbours = 18;  // that a plane is fitted to

bool agrees(const DepthMap& map, const Vec3& point, double tolerance) {
  const double z = map.camera.in_camera(point).z();
  if (z <= 0) return false;
  const Vec2 at = project(map.camera, point);
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
  return map.depth.contains(x, y) && map.depth(x, y) > 0 && std::abs(map.depth(x, y) - z) <= tolerance;
}

struct Supported {
  Vec3 point, to_camera;
};

// One map's points in the box that enough others agree with.
std::vector<Supported> supported(std::span<const DepthMap> maps, std::size_t index, const Vec3& low, const Vec3& high,
                                 const StereoOptions& options) {
  const DepthMap& map = maps[index];
  const Vec3 eye = map.camera.centre();
  const double tolerance = options.agreement / 100 * (high - low).norm();
  std::vector<Supported> found;
  for (int y = 0; y < map.depth.height; ++y)
    for (int x = 0; x < map.depth.width; ++x) {
      if (map.depth(x, y) <= 0) continue;
      const Vec3 point = eye + map.depth(x, y) * ray(map.camera, {x + 0.5, y + 0.5});
      if ((point.array() < low.array()).any() || (point.array() > high.array()).any()) continue;
      int support = 0;
      for (std::size_t other = 0; other < maps.size() && support < options.support; ++other)
        support += other != index && agrees(maps[other], point, tolerance);
      if (support >= options.support) found.push_back({point, (eye - point).normalized()});
    }
  return found;
}

struct Sum {
  Vec3 point = Vec3::Zero(), to_camera = Vec3::Zero();
  int count = 0;
};

}  // namespace

OrientedPoints fuse(std::span<const DepthMap> maps, const Vec3& low, const Vec3& high, const StereoOptions& options,
                    const Monitor& monitor) {
  check("stereo", options);
  monitor.at("fusion", 0);
  std::vector<std::vector<Supported>> found(maps.size());
  parallel_ranges(0, static_cast<int>(maps.size()), 1, [&](int first, int last) {
    for (int i = first; i < last; ++i) found[i] = supported(maps, i, low, high, options);
  });
  const double cube = options.spacing / 100 * (high - low).norm();
  std::map<std::array<int, 3>, Sum> cubes;
  for (const auto& points : found)
    for (const Supported& p : points) {
      const Vec3 at = (p.point - low) / cube;
      Sum& sum = cubes[{static_cast<int>(at.z()), static_cast<int>(at.y()), static_cast<int>(at.x())}];
      sum.point += p.point, sum.to_camera += p.to_camera, ++sum.count;
    }

  std::vector<Vec3> positions, towards;
  for (const auto& [_, sum] : cubes) {
    positions.push_back(sum.point / sum.count);
    towards.push_back(sum.to_camera);
  }
  return with_normals(positions, towards);
}

OrientedPoints with_normals(const std::vector<Vec3>& positions, const std::vector<Vec3>& towards) {
  std::vector<PointAndNormal> all;
  all.reserve(positions.size());
  for (const Vec3& p : positions) all.push_back({Kernel::Point_3(p.x(), p.y(), p.z()), CGAL::NULL_VECTOR});
  OrientedPoints result;
  if (all.size() <= kNeighbours) return result;
  CGAL::pca_estimate_normals<CGAL::Sequential_tag>(
      all, kNeighbours,
      CGAL::parameters::point_map(CGAL::First_of_pair_property_map<PointAndNormal>())
          .normal_map(CGAL::Second_of_pair_property_map<PointAndNormal>()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [p, n] = all[i];
    const Vec3 normal(n.x(), n.y(), n.z());
    result.positions.emplace_back(p.x(), p.y(), p.z());
    result.normals.push_back(normal.dot(towards[i]) < 0 ? Vec3(-normal) : normal);
  }
  return result;
}

}  // namespace carve
