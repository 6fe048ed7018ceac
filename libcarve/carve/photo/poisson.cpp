#include "carve/photo/poisson.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Poisson_reconstruction_function.h>
#include <CGAL/Random.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "carve/surface/marching_cubes.h"

namespace carve {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using PointAndNormal = std::pair<Point, Kernel::Vector_3>;

constexpr std::size_t kFewestPoints = 1100;  // of fewer CGAL makes noise
constexpr double kThin = 0.25;               // voxels: of points in one such cube the first is enough
constexpr double kOffCentre = 0.02;          // voxels, so that no triangle degenerates

// Those of the region's box; points that nearly coincide would break CGAL's triangulation.
std::vector<PointAndNormal> thinned(const OrientedPoints& points, const VoxelGrid& region) {
  const Vec3 size = region.size().cast<double>();
  std::set<std::array<int, 3>> taken;
  std::vector<PointAndNormal> all;
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const Vec3 &p = points.positions[i], &n = points.normals[i];
    const Vec3 at = (p - region.low()) / region.spacing();
    if (!((at.array() >= 0).all() && (at.array() <= size.array()).all())) continue;
    const Vec3i cube = (at / kThin).cast<int>();
    if (taken.insert({cube.x(), cube.y(), cube.z()}).second)
      all.emplace_back(Point(p.x(), p.y(), p.z()), Kernel::Vector_3(n.x(), n.y(), n.z()));
  }
  return all;
}

// The function at every voxel's centre, x fastest.
std::vector<float> sampled(const OrientedPoints& points, const VoxelGrid& region, const Monitor& monitor) {
  std::vector<PointAndNormal> all = thinned(points, region);
  if (all.size() < kFewestPoints)
    throw NoResult("Poisson: " + std::to_string(all.size()) + " points are too few for a surface");
  // CGAL shuffles points by a generator that all its users share.
  CGAL::get_default_random() = CGAL::Random(0);
  CGAL::Poisson_reconstruction_function<Kernel> function(all.begin(), all.end(),
                                                         CGAL::First_of_pair_property_map<PointAndNormal>(),
                                                         CGAL::Second_of_pair_property_map<PointAndNormal>());
  if (!function.compute_implicit_function()) throw NoResult("Poisson: the points make no surface");
  const Vec3i size = region.size();
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(size.x()) * size.y() * size.z());
  for (int z = 0; z < size.z(); ++z) {
    monitor.at("poisson", static_cast<double>(z) / size.z());
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const Vec3 c = region.centre(x, y, z);
        values.push_back(static_cast<float>(function(Point(c.x(), c.y(), c.z()))));
      }
  }
  return values;
}

// Where the function is zero between two neighbouring centres along an axis.
EdgeCrossings zeros(const std::vector<float>& values, const Vec3i& size, int axis) {
  const std::size_t step = axis == 0 ? 1 : axis == 1 ? size.x() : static_cast<std::size_t>(size.x()) * size.y();
  EdgeCrossings edges{.size = size};
  std::size_t at = 0;
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y) {
      edges.first.push_back(static_cast<std::uint32_t>(edges.entries.size()));
      for (int x = 0; x < size.x(); ++x, ++at) {
        if ((axis == 0 ? x : axis == 1 ? y : z) == 0) continue;
        const float lower = values[at - step], upper = values[at];
        if ((lower < 0) == (upper < 0)) continue;
        const double inside = lower < 0 ? lower : upper, outside = lower < 0 ? upper : lower;
        const double distance = std::clamp(inside / (inside - outside), kOffCentre, 1 - kOffCentre);
        edges.entries.push_back({x, static_cast<float>(lower < 0 ? distance : -distance)});
      }
    }
  edges.first.push_back(static_cast<std::uint32_t>(edges.entries.size()));
  return edges;
}

}  // namespace

Mesh poisson_surface(const OrientedPoints& points, const VoxelGrid& region, const Monitor& monitor) {
  const std::vector<float> values = sampled(points, region, monitor);
  VoxelGrid grid(region.size(), region.low(), region.spacing());
  const Vec3i size = grid.size();
  std::size_t at = 0;
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x, ++at)
        if (values[at] < 0) grid.set(x, y, z, true);
  if (grid.count() == 0) throw NoResult("Poisson: the points make no surface in the box");
  Crossings crossings;
  for (int axis = 0; axis < 3; ++axis) crossings.edges[axis] = zeros(values, size, axis);
  return marching_cubes(grid, crossings);
}

}  // namespace carve
