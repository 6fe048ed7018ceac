#include <gtest/gtest.h>

#include <algorithm>

#include "carve/hull/contours.h"
#include "carve/hull/polyhedral_hull.h"
#include "carve/pipeline/reconstruct.h"
#include "eval/mesh_distance.h"
#include "shapes.h"

namespace carve {
namespace {

double farthest(const Mesh& from, const Mesh& to) {
  const std::vector<double> all = distances(from.positions, to);
  return *std::max_element(all.begin(), all.end());
}

class ConvergenceTest : public testing::TestWithParam<int> {};

TEST_P(ConvergenceTest, TheVoxelHullIsWithinAVoxelsDiagonalOfTheExactHull) {
  PipelineOptions options;
  options.carve.grid = GetParam();
  options.consistency.arm = Consistency::none;
  options.convex.arm = false;
  options.smooth.steps = 0;
  for (const Shape& shape : {ball(), torus(0.2), stairs(3)}) {
    const auto drawings = draw(shape, kThreeViews, {.pixels = 100});
    const Mesh exact = polyhedral_hull(pixel_contours(align(drawings))).mesh;
    for (const bool intersections : {false, true}) {
      options.intersections = intersections;
      const Mesh voxels = reconstruct(drawings, options).mesh;
      const double diagonal = std::sqrt(3.0) / GetParam();
      EXPECT_LE(farthest(voxels, exact), diagonal) << shape.name << (intersections ? ", intersections" : "");
      EXPECT_LE(farthest(exact, voxels), diagonal) << shape.name << (intersections ? ", intersections" : "");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Grids, ConvergenceTest, testing::Values(8, 13, 24, 32, 50, 64, 100, 128));

}  // namespace
}  // namespace carve
