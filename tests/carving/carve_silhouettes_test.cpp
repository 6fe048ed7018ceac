#include "carve/carving/carve_silhouettes.h"

#include <gtest/gtest.h>

#include "carve/carving/consistency_report.h"
#include "carve/core/error.h"
#include "carve/grid/shadow.h"
#include "carve/surface/crossings.h"
#include "carve/surface/marching_cubes.h"
#include "shapes.h"
#include "surface/solid_check.h"

namespace carve {
namespace {

double surface_bound(const Shape& shape) {  // more than the hull's area
  const Vec3& s = shape.size;
  return 4 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
}

TEST(Carving, HullVolumesAreWithinALayerOfTheExactOnes) {
  for (const Shape& shape : all_shapes())
    for (int grid : {16, 32, 64}) {
      const ViewSet views = aligned(shape, kThreeViews, {.pixels = 256});
      const VoxelGrid hull = carve_silhouettes(views, {.grid = grid}).grid;
      const double layer = surface_bound(shape) * hull.spacing();
      EXPECT_NEAR(hull.volume(), shape.hull_volume, layer) << shape.name << " " << grid;
      const Mesh mesh = marching_cubes(hull, contour_crossings(views, hull));
      EXPECT_NEAR(signed_volume(mesh), shape.hull_volume, layer / 16) << shape.name << " " << grid;
      EXPECT_EQ(solid_fault(mesh), "") << shape.name << " " << grid;
    }
}

}  // namespace
}  // namespace carve
