#include "models/outer_surface.h"

#include <gtest/gtest.h>

#include "carve/mesh/topology.h"
#include "models/primitives.h"
#include "models/procedural.h"

namespace carve {
namespace {

Model boxes(std::initializer_list<std::pair<Vec3, Vec3>> corners) {
  Model model;
  for (const auto& [low, high] : corners) add(model, "m", {}, box(low, high));
  return model;
}

TEST(OuterSurface, OfOneConvexShellIsItself) {
  const Model model = sphere();
  const Mesh outer = outer_surface(model);
  EXPECT_EQ(outer.triangles.size(), model.mesh.triangles.size());
  EXPECT_TRUE(topology(outer).solid());
}

TEST(OuterSurface, DropsAShellInsideAnother) {
  const Model model = boxes({{{0, 0, 0}, {1, 1, 1}}, {{0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}}});
  EXPECT_NEAR(topology(outer_surface(model)).area, 6, 1e-12);
}

TEST(OuterSurface, DropsTheInnerSideOfAHollowBody) {
  Model model = boxes({{{0, 0, 0}, {1, 1, 1}}});
  Mesh inner = box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8});
  for (Triangle& t : inner.triangles) std::swap(t[0], t[1]);
  add(model, "m", {}, inner);
  EXPECT_NEAR(topology(outer_surface(model)).area, 6, 1e-12);
}

// Two boxes that share a part: the union's area is known.
TEST(OuterSurface, CutsShellsWhereTheyMeet) {
  const Model model = boxes({{{0, 0, 0}, {1, 1, 1}}, {{0.5, 0.25, 0.25}, {1.5, 0.75, 0.75}}});
  const double area = 6 + 4 * 0.5 * 0.5;  // the second's near end takes away what its far end gives
  double last = 1;
  for (const double finest : {4.0, 2.0, 1.0}) {
    const double error = std::abs(topology(outer_surface(model, {.finest = finest})).area / area - 1);
    EXPECT_LT(error, 0.01 * finest);
    last = error;
  }
  EXPECT_LT(last, 0.004);
}

TEST(OuterSurface, KeepsWhatOnlyThePocketShows) {
  const Model model = box_pockets();
  EXPECT_NEAR(topology(outer_surface(model)).area, topology(model.mesh).area, 1e-9);
}

TEST(OuterSurface, KeepsAnOpenSheet) {
  Model model;
  model.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_NEAR(topology(outer_surface(model)).area, 0.5, 1e-12);
}

}  // namespace
}  // namespace carve
