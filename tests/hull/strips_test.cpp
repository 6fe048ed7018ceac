#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "carve/core/error.h"
#include "carve/hull/contours.h"
#include "carve/hull/polyhedral_hull.h"
#include "carve/mesh/self_intersections.h"
#include "carve/mesh/topology.h"
#include "hull/polygons.h"
#include "shapes.h"

namespace carve {
namespace {

void expect_sound(const PolyhedralHull& hull, const std::string& what) {
  const Topology t = topology(hull.mesh);
  EXPECT_TRUE(t.solid()) << what << '\n' << t;
  EXPECT_EQ(t.degenerate_triangles, 0) << what;
  EXPECT_EQ(t.unused_vertices, 0) << what;
  EXPECT_GT(t.volume, 0) << what;
  EXPECT_EQ(self_intersections(hull.mesh).size(), 0u) << what;
  EXPECT_EQ(hull.sources.size(), hull.mesh.triangles.size()) << what;
}

std::string cubed(std::int64_t units) { return std::to_string(units * units * units); }

// Pixels of these masks that meet only in a corner are joined by a third.
void fill_touching_corners(Mask& mask) {
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y + 1 < mask.height; ++y)
      for (int x = 0; x + 1 < mask.width; ++x)
        if (mask(x, y) == mask(x + 1, y + 1) && mask(x + 1, y) == mask(x, y + 1) && mask(x, y) != mask(x + 1, y)) {
          mask(x, y) = mask(x + 1, y) = 1;
          changed = true;
        }
  }
}

std::int64_t voxels(const std::map<View, Mask>& masks, const Vec3i& size) {
  std::int64_t count = 0;
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x)
        count += masks.at(View::front)(x, size.y() - 1 - y) &&
                 masks.at(View::side)(size.z() - 1 - z, size.y() - 1 - y) && masks.at(View::top)(x, z);
  return count;
}

TEST(StripsTest, ThreeRectanglesMakeABox) {
  const Silhouettes box = box_silhouettes({10, 20, 30}, {11, 22, 33});
  const PolyhedralHull hull = polyhedral_hull(box, HullMethod::strips, true);
  EXPECT_EQ(hull.volume, "6");
  EXPECT_EQ(hull.facets, 6);
  EXPECT_EQ(hull.mesh.positions.size(), 8u);
  EXPECT_EQ(hull.mesh.triangles.size(), 12u);
  expect_sound(hull, "box");
}

TEST(StripsTest, TwoCrossedRoofsMeetInAPyramid) {
  Silhouettes s;
  const LatticeLoop triangle{{0, 0}, {600, 0}, {300, 300}};
  s.along = {{2, View::front, {triangle}}, {0, View::side, {{{0, 0}, {300, 300}, {0, 600}}}}};
  const PolyhedralHull hull = polyhedral_hull(s, HullMethod::strips, true);
  EXPECT_EQ(hull.volume, "36000000");  // 600 * 600 * 300 / 3
  EXPECT_EQ(hull.facets, 5);
  EXPECT_EQ(hull.mesh.positions.size(), 5u);
  expect_sound(hull, "pyramid");
}

/// A groove from above along z and one from below along x, each half as deep as the block, or a bit less.
Silhouettes grooves(std::int32_t depth) {
  Silhouettes s;
  s.along = {{2, View::front, {{{0, 0}, {800, 0}, {800, 600}, {500, 600}, {400, 600 - depth}, {300, 600}, {0, 600}}}},
             {0, View::side, {{{0, 0}, {600, 0}, {600, 900}, {0, 900}, {0, 600}, {300, 500}, {0, 400}}}}};
  return s;
}

TEST(StripsTest, GroovesThatTouchAreInContact) {
  for (const HullMethod method : {HullMethod::strips, HullMethod::nef}) {
    const PolyhedralHull apart = polyhedral_hull(grooves(290), method),
                         touching = polyhedral_hull(grooves(300), method);
    expect_sound(apart, "apart");
    EXPECT_TRUE(topology(touching.mesh).solid());
    const auto meeting = self_intersections(touching.mesh);
    EXPECT_GT(meeting.size(), 0u);
    EXPECT_EQ(contacts(touching.mesh, meeting), meeting);
  }
  const Mesh through = polyhedral_hull(grooves(310)).mesh;  // a hole where they meet
  EXPECT_EQ(topology(through).euler, 0);
  EXPECT_EQ(self_intersections(through).size(), 0u);
}

class RandomHullTest : public testing::TestWithParam<unsigned> {};

TEST_P(RandomHullTest, IsASolidWithoutSelfIntersection) {
  for (unsigned seed = 20 * GetParam(); seed < 20 * GetParam() + 20; ++seed) {
    const std::string what = "seed " + std::to_string(seed);
    try {
      expect_sound(polyhedral_hull(random_silhouettes(seed)), what);
    } catch (const NoResult&) {
      EXPECT_EQ(seed % 5, 4u) << what;  // all others hold the middle
    }
  }
}

TEST_P(RandomHullTest, RenamingTheAxesChangesNoVolume) {
  const Silhouettes s = random_silhouettes(GetParam());
  Silhouettes turned = s;
  for (Silhouette& one : turned.along) one.axis = (one.axis + 1) % 3;
  if (GetParam() % 5 == 4) return;  // may be empty
  EXPECT_EQ(polyhedral_hull(s, HullMethod::strips, true).volume,
            polyhedral_hull(turned, HullMethod::strips, true).volume);
}

TEST_P(RandomHullTest, MasksGiveTheVolumeOfTheirVoxels) {
  const Vec3i size(8, 16, 4);
  auto masks = random_masks(size, GetParam());
  for (auto& [view, mask] : masks) fill_touching_corners(mask);
  const std::int64_t count = voxels(masks, size);
  if (count == 0) return;
  const PolyhedralHull hull = polyhedral_hull(pixel_contours(views_of_masks(masks)), HullMethod::strips, true);
  const std::int64_t voxel = std::int64_t{kLattice / 8} * (kLattice / 16) * (kLattice / 4);
  EXPECT_EQ(hull.volume, std::to_string(count * voxel));
  expect_sound(hull, "seed " + std::to_string(GetParam()));
}

TEST_P(RandomHullTest, PixelsThatTouchInCornersAreParted) {
  const Vec3i size(9, 7, 11);
  const auto masks = random_masks(size, GetParam());
  const std::int64_t count = voxels(masks, size);
  const ViewSet views = views_of_masks(masks);
  const Silhouettes contours = pixel_contours(views);
  if (count == 0) {
    EXPECT_THROW(polyhedral_hull(contours), NoResult);
    return;
  }
  const PolyhedralHull hull = polyhedral_hull(contours);
  expect_sound(hull, "seed " + std::to_string(GetParam()));
  // Each cut takes at most a lattice unit's triangle off a row of voxels.
  const double whole = static_cast<double>(count) * views.size.prod() / size.prod();
  EXPECT_NEAR(topology(hull.mesh).volume, whole, 1e-6 * whole);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomHullTest, testing::Range(0u, 15u));

TEST(StripsTest, OneWallSharedByTwoSilhouettesIsMadeOnce) {
  // Front and top both end at x = 200 above y = 100 and z = 100 alone.
  Silhouettes s = box_silhouettes({0, 0, 0}, {300, 300, 300});
  s.along[2].loops = {{{0, 0}, {300, 0}, {300, 100}, {200, 100}, {200, 300}, {0, 300}}};  // (x, y)
  s.along[1].loops = {{{0, 0}, {300, 0}, {300, 200}, {100, 200}, {100, 300}, {0, 300}}};  // (z, x)
  const PolyhedralHull hull = polyhedral_hull(s, HullMethod::strips, true);
  // Beyond x = 200: y < 100, z < 100 or, in the top view, all z for x < 200.
  EXPECT_EQ(hull.volume, std::to_string(200 * 300 * 300 + 100 * 100 * 100));
  expect_sound(hull, "shared wall");
}

TEST(StripsTest, HolesAndIslandsInThem) {
  Silhouettes s = box_silhouettes({0, 0, 0}, {500, 500, 500});
  for (Silhouette& one : s.along) {
    one.loops.push_back(reversed(rectangle(100, 100, 400, 400)));
    one.loops.push_back(rectangle(200, 200, 300, 300));
  }
  const PolyhedralHull hull = polyhedral_hull(s, HullMethod::strips, true);
  // Of 5^3 cells of 100: frame cells or the middle in all three views.
  int cells = 0;
  const auto shown = [](int i, int j) {
    const auto border = [](int k) { return k == 0 || k == 4; };
    return border(i) || border(j) || (i == 2 && j == 2);
  };
  for (int x = 0; x < 5; ++x)
    for (int y = 0; y < 5; ++y)
      for (int z = 0; z < 5; ++z) cells += shown(x, y) && shown(y, z) && shown(z, x);
  EXPECT_EQ(hull.volume, std::to_string(cells * std::stoll(cubed(100))));
  expect_sound(hull, "islands");
}

TEST(StripsTest, OctantsThatMeetInAPointAreParted) {
  // Each view leaves out one quadrant, cyclically: only (+, +, +) and (-, -, -) remain, which share the middle.
  Silhouettes s;
  const LatticeLoop without_right_lower{{0, 0}, {200, 0}, {200, 200}, {400, 200}, {400, 400}, {0, 400}};
  for (int axis = 0; axis < 3; ++axis) s.along.push_back({axis, View::front, {without_right_lower}});
  const PolyhedralHull hull = polyhedral_hull(s, HullMethod::strips, true);
  EXPECT_EQ(hull.volume, std::to_string(2 * std::stoll(cubed(200))));
  EXPECT_EQ(hull.split_points, 1);
  EXPECT_EQ(topology(hull.mesh).components, 2);
  expect_sound(hull, "two octants");
}

TEST(StripsTest, WedgesThatMeetInALineAreParted) {
  // The front ends at y = 200, the side has a notch from below that reaches just there.
  Silhouettes s = box_silhouettes({0, 0, 0}, {400, 400, 400});
  s.along[2].loops = {rectangle(0, 0, 400, 200)};
  s.along[0].loops = {{{0, 0}, {400, 0}, {400, 400}, {0, 400}, {200, 200}}};  // (y, z)
  const PolyhedralHull hull = polyhedral_hull(s, HullMethod::strips, true);
  EXPECT_EQ(hull.volume, std::to_string(400 * 200 * 200));
  EXPECT_EQ(topology(hull.mesh).components, 2);
  expect_sound(hull, "two wedges");
}

TEST(StripsTest, TouchingLoopsAreAccepted) {
  Silhouettes s = box_silhouettes({0, 0, 0}, {400, 400, 400});
  s.along[2].loops = {rectangle(0, 0, 200, 200), rectangle(200, 200, 400, 400)};
  const PolyhedralHull hull = polyhedral_hull(s, HullMethod::strips, true);
  EXPECT_EQ(hull.volume, std::to_string(2 * 200 * 200 * 400));
  expect_sound(hull, "touching");
}

TEST(StripsTest, NothingInCommonIsNoResult) {
  Silhouettes s = box_silhouettes({0, 0, 0}, {400, 400, 400});
  s.along[0].loops = {rectangle(500, 0, 600, 400)};
  EXPECT_THROW(polyhedral_hull(s), NoResult);
  s.along[0].loops = {rectangle(400, 0, 600, 400)};  // a shared wall without volume
  EXPECT_THROW(polyhedral_hull(s), NoResult);
  s.along[0].loops = {};
  EXPECT_THROW(polyhedral_hull(s), NoResult);
}

TEST(StripsTest, SourcesNameTheContourEdge) {
  const PolyhedralHull hull = polyhedral_hull(box_silhouettes({0, 0, 0}, {kLattice, kLattice, kLattice}));
  for (const ContourSide& source : hull.sources) {
    EXPECT_EQ(source.loop, 0);
    EXPECT_GE(source.edge, 0);
    EXPECT_LT(source.edge, 4);
  }
}

TEST(StripsTest, BadSilhouettesAreRefused) {
  Silhouettes s = box_silhouettes({0, 0, 0}, {400, 400, 400});
  s.along[1].axis = 0;
  EXPECT_THROW(polyhedral_hull(s), std::invalid_argument);
  s = box_silhouettes({0, 0, 0}, {400, 400, kLattice + 1});
  EXPECT_THROW(polyhedral_hull(s), std::invalid_argument);
  s = box_silhouettes({0, 0, 0}, {400, 400, 400});
  s.along[1].loops[0].resize(2);
  EXPECT_THROW(polyhedral_hull(s), std::invalid_argument);
  s.along.resize(1);
  EXPECT_THROW(polyhedral_hull(s), std::invalid_argument);
}

}  // namespace
}  // namespace carve
