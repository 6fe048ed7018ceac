#include "carve/surface/guides.h"

#include <cmath>

#include "carve/core/parallel.h"
#include "carve/surface/contour_normals.h"

namespace carve {
namespace {

constexpr int kFace = 6;       // voxels that a face is followed for, each way
constexpr int kSmallStep = 2;  // voxels: what continues so near is the same face, slanted

class GuideFinder {
 public:
  GuideFinder(const VoxelGrid& grid, const Crossings& crossings)
      : grid_(grid),
        crossings_(crossings),
        xy_(contour_normals(crossings.xy)),
        xz_(contour_normals(crossings.xz)),
        yz_(contour_normals(crossings.yz)) {}

  Guide operator()(const Vec3& position) const {
    const Vec3 at = (position - grid_.low()) / grid_.spacing() - Vec3::Constant(0.5);
    Vec3i upper = at.array().round().cast<int>();
    int axis = 0;
    (at - upper.cast<double>()).cwiseAbs().maxCoeff(&axis);
    upper[axis] = static_cast<int>(std::ceil(at[axis]));
    const bool upper_inside = inside(upper);
    const int x = upper.x(), y = upper.y(), z = upper.z();
    Nearest nearest{upper_inside ? -1.f : 1.f};
    if (axis == 0) {
      nearest.see(crossings_.xy.first, xy_.first, x, y, 0, 1);
      nearest.see(crossings_.xz.first, xz_.first, x, z, 0, 2);
    } else if (axis == 1) {
      nearest.see(crossings_.xy.second, xy_.second, x, y, 0, 1);
      nearest.see(crossings_.yz.first, yz_.first, y, z, 1, 2);
    } else {
      nearest.see(crossings_.xz.second, xz_.second, x, z, 0, 2);
      nearest.see(crossings_.yz.second, yz_.second, y, z, 1, 2);
    }
    const float edge = nearest.sign * crossings_.edges[axis](x, y, z);
    if (edge > 0 && edge < nearest.distance) return {};
    if (nearest.distance < 1) {
      if (nearest.normal.isZero()) return {};
      return {Guide::Kind::plane, nearest.normal};
    }
    if (!on_face(upper, axis, upper_inside)) return {};
    return {Guide::Kind::plane, Eigen::Vector3f::Unit(axis) * (upper_inside ? -1.f : 1.f)};
  }

 private:
  struct Nearest {
    float sign;  // of the distances that say where the inside centre is
    float distance = 1;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();

    void see(const Raster<float>& plane, const Raster<PlaneNormals::Normal>& normals, int i, int j, int first,
             int second) {
      const float at = plane.contains(i, j) ? sign * plane(i, j) : 0;
      if (at <= 0 || at >= distance) return;
      distance = at;
      normal.setZero();
      normal[first] = normals(i, j)[0];
      normal[second] = normals(i, j)[1];
    }
  };

  bool inside(const Vec3i& v) const { return grid_.contains(v.x(), v.y(), v.z()) && grid_(v.x(), v.y(), v.z()); }
  bool cut(const Vec3i& upper, int axis, bool upper_inside) const {
    return inside(upper) == upper_inside && inside(upper - Vec3i::Unit(axis)) != upper_inside;
  }

  bool on_face(const Vec3i& upper, int axis, bool upper_inside) const {
    for (const int turn : {1, 2})
      for (const int sign : {-1, 1}) {
        const Vec3i way = sign * Vec3i::Unit((axis + turn) % 3);
        for (int k = 1; k <= kFace; ++k) {
          const Vec3i next = upper + k * way;
          if (cut(next, axis, upper_inside)) continue;
          for (int step = -kSmallStep; step <= kSmallStep; ++step)
            if (cut(next + step * Vec3i::Unit(axis), axis, upper_inside)) return false;
          break;
        }
      }
    return true;
  }

  const VoxelGrid& grid_;
  const Crossings& crossings_;
  PlaneNormals xy_, xz_, yz_;
};

}  // namespace

Guides vertex_guides(const Mesh& mesh, const VoxelGrid& grid, const Crossings& crossings) {
  const GuideFinder guide(grid, crossings);
  Guides guides(mesh.positions.size());
  parallel_ranges(0, static_cast<int>(guides.size()), 1 << 12, [&](int first, int last) {
    for (int v = first; v < last; ++v) guides[v] = guide(mesh.positions[v]);
  });
  return guides;
}

}  // namespace carve
