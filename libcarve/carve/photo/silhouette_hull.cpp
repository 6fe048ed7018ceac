#include "carve/photo/silhouette_hull.h"

#include "carve/core/parallel.h"

namespace carve {
namespace {

bool outside(const Photo& photo, const Vec3& point) {
  const Vec3 p = photo.camera.in_camera(point);
  if (p.z() <= 0) return false;
  const Vec2 at = photo.camera.focal / p.z() * p.head<2>() + photo.camera.principal;
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() < photo.mask.width && at.y() < photo.mask.height)) return false;
  return photo.mask(static_cast<int>(at.x()), static_cast<int>(at.y())) == 0;
}

}  // namespace

VoxelGrid silhouette_hull(std::span<const Photo> photos, const VoxelGrid& region, const Monitor& monitor) {
  check_photos(photos);
  VoxelGrid hull = region;
  const Vec3i size = hull.size();
  monitor.at("silhouettes", 0);
  parallel_ranges(0, size.z(), 1, [&](int first, int last) {
    for (int z = first; z < last; ++z)
      for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) {
          if (!hull(x, y, z)) continue;
          const Vec3 centre = hull.centre(x, y, z);
          for (const Photo& photo : photos)
            if (outside(photo, centre)) {
              hull.set(x, y, z, false);
              break;
            }
        }
  });
  return hull;
}

}  // namespace carve
