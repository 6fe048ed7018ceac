#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carve/core/error.h"
#include "carve/hull/contours.h"
#include "carve/hull/polyhedral_hull.h"
#include "carve/mesh/topology.h"
#include "shapes.h"

namespace carve {
namespace {

std::size_t vertices(const Silhouettes& s) {
  std::size_t count = 0;
  for (const Silhouette& one : s.along)
    for (const LatticeLoop& loop : one.loops) count += loop.size();
  return count;
}

class SimplifyTest : public testing::TestWithParam<unsigned> {};

TEST_P(SimplifyTest, KeepsEveryLoopAndOnlyGivenVertices) {
  const ViewSet views = views_of_masks(random_masks({24, 20, 30}, GetParam()));
  const Silhouettes all = pixel_contours(views), some = pixel_contours(views, {.tolerance = 0.8});
  ASSERT_EQ(all.along.size(), some.along.size());
  for (std::size_t k = 0; k < all.along.size(); ++k) {
    ASSERT_EQ(all.along[k].loops.size(), some.along[k].loops.size());
    for (std::size_t l = 0; l < all.along[k].loops.size(); ++l)
      for (const LatticePoint& p : some.along[k].loops[l])
        EXPECT_EQ(std::count(all.along[k].loops[l].begin(), all.along[k].loops[l].end(), p), 1);
  }
}

TEST_P(SimplifyTest, ItsHullIsASolid) {
  const ViewSet views = views_of_masks(random_masks({24, 20, 30}, GetParam()));
  try {
    const PolyhedralHull hull = polyhedral_hull(pixel_contours(views, {.tolerance = 0.8}));
    EXPECT_TRUE(topology(hull.mesh).solid());
  } catch (const NoResult&) {
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SimplifyTest, testing::Range(0u, 8u));

TEST(SimplifyBallTest, StaircasesVanishAndExtentsStay) {
  const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 100});
  const Silhouettes stairs = pixel_contours(views), smooth = pixel_contours(views, {.tolerance = 1});
  EXPECT_LT(4 * vertices(smooth), vertices(stairs));
  for (const Silhouette& one : smooth.along)
    for (int k = 0; k < 2; ++k) {
      const auto less = [k](const LatticePoint& p, const LatticePoint& q) { return p[k] < q[k]; };
      const auto [low, high] = std::minmax_element(one.loops[0].begin(), one.loops[0].end(), less);
      EXPECT_EQ((*low)[k], 0);
      EXPECT_NEAR((*high)[k] * smooth.unit[(one.axis + 1 + k) % 3], views.size[(one.axis + 1 + k) % 3], 1e-12);
    }
}

}  // namespace
}  // namespace carve
