#include "carve/hull/contours.h"

#include <gtest/gtest.h>

#include "carve/core/error.h"
#include "carve/hull/polyhedral_hull.h"
#include "carve/mesh/topology.h"
#include "hull/agreement.h"
#include "shapes.h"

namespace carve {
namespace {

double area(const Silhouette& silhouette) {
  double twice = 0;
  for (const LatticeLoop& loop : silhouette.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const LatticePoint &p = loop[i], &q = loop[(i + 1) % loop.size()];
      twice += static_cast<double>(p[0]) * q[1] - static_cast<double>(q[0]) * p[1];
    }
  return twice / 2;
}

std::map<View, Mask> full_masks(int width, int height, int depth) {
  return {
      {View::front, Mask(width, height, 1)}, {View::side, Mask(depth, height, 1)}, {View::top, Mask(width, depth, 1)}};
}

TEST(ContoursTest, ExtentsAgreeBetweenViewsOfDifferentSize) {
  std::map<View, Drawing> drawings;
  drawings.emplace(View::front, drawing_of(Mask(30, 20, 1)));
  drawings.emplace(View::side, drawing_of(Mask(35, 50, 1)));
  drawings.emplace(View::top, drawing_of(Mask(90, 42, 1)));
  const Silhouettes s = pixel_contours(align(std::move(drawings)));
  for (int axis = 0; axis < 3; ++axis) {
    std::int32_t size = 0;
    for (const Silhouette& one : s.along)
      for (int k = 0; k < 2; ++k) {
        if ((one.axis + 1 + k) % 3 != axis) continue;
        ASSERT_EQ(one.loops.size(), 1u);
        std::int32_t low = kLattice, high = 0;
        for (const LatticePoint& p : one.loops[0]) low = std::min(low, p[k]), high = std::max(high, p[k]);
        EXPECT_EQ(low, 0);
        if (size == 0) size = high;
        EXPECT_EQ(high, size);
      }
  }
  const PolyhedralHull hull = polyhedral_hull(s);
  EXPECT_EQ(hull.facets, 6);
}

TEST(ContoursTest, TheLatticeHoldsThePixelsOfAllViews) {
  auto masks = full_masks(6, 10, 15);
  const Silhouettes s = pixel_contours(views_of_masks(masks));
  const Vec3 size = views_of_masks(masks).size;
  EXPECT_NEAR(size.x() / s.unit.x(), kLattice / 6 * 6, 1e-6);
  EXPECT_NEAR(size.y() / s.unit.y(), kLattice / 10 * 10, 1e-6);
  EXPECT_NEAR(size.z() / s.unit.z(), kLattice / 15 * 15, 1e-6);
}

TEST(ContoursTest, OnePixelIsASquare) {
  auto masks = full_masks(8, 8, 8);
  masks[View::front] = Mask(8, 8);
  masks[View::front](3, 2) = 1;
  const Silhouettes s = pixel_contours(views_of_masks(masks));
  const Silhouette& front = s.along[2];
  ASSERT_EQ(front.axis, 2);
  ASSERT_EQ(front.loops.size(), 1u);
  EXPECT_EQ(front.loops[0].size(), 4u);
  const double pixel = kLattice / 8;
  EXPECT_EQ(area(front), pixel * pixel);
  const auto [low, high] = std::minmax_element(front.loops[0].begin(), front.loops[0].end());
  EXPECT_EQ(*low, (LatticePoint{3 * kLattice / 8, 5 * kLattice / 8}));  // row 2 from above is row 5 from below
  EXPECT_EQ(*high, (LatticePoint{4 * kLattice / 8, 6 * kLattice / 8}));
}

class RandomContoursTest : public testing::TestWithParam<unsigned> {};

TEST_P(RandomContoursTest, TheirAreaIsThatOfThePixels) {
  const auto masks = random_masks({16, 32, 8}, GetParam());
  const Silhouettes s = pixel_contours(views_of_masks(masks));
  const View views[] = {View::side, View::top, View::front};
  for (const Silhouette& one : s.along) {
    const Mask& mask = masks.at(views[one.axis]);
    const double pixel = double{kLattice} / mask.width * kLattice / mask.height;
    const auto lit = std::count(mask.pixels.begin(), mask.pixels.end(), 1);
    const std::int64_t cuts = 4 * static_cast<std::int64_t>(mask.pixels.size());  // at most one a pixel's corner
    EXPECT_NEAR(area(one), static_cast<double>(lit) * pixel, static_cast<double>(cuts));
  }
}

TEST_P(RandomContoursTest, TheBackViewCutsOffWhatItDoesNotShow) {
  std::map<View, Mask> masks = full_masks(12, 16, 8);
  masks[View::front] = random_mask(12, 16, GetParam());
  Mask back = random_mask(12, 16, GetParam() + 100), both = masks[View::front];
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 12; ++x) both(x, y) &= back(11 - x, y);
  auto combined = masks;
  masks[View::back] = back;
  combined[View::front] = both;
  const Silhouettes s = pixel_contours(views_of_masks(masks)), expected = pixel_contours(views_of_masks(combined));
  ASSERT_EQ(s.along.size(), 3u);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(s.along[k].loops, expected.along[k].loops);
}

double circle_error(const Silhouettes& s, const Silhouette& one) {
  double most = 0;
  for (const LatticeLoop& loop : one.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const auto at = [&](const LatticePoint& p) {
        Vec3 place = s.origin;
        for (int k = 0; k < 2; ++k) place[(one.axis + 1 + k) % 3] += s.unit[(one.axis + 1 + k) % 3] * p[k];
        place -= Vec3(0, 0.5, 0);
        place[one.axis] = 0;
        return place;
      };
      const Vec3 p = at(loop[i]), q = at(loop[(i + 1) % loop.size()]);
      most = std::max({most, std::abs(p.norm() - 0.5), std::abs(((p + q) / 2).norm() - 0.5)});
    }
  return most;
}

TEST(SubpixelContoursTest, ACircleIsTruerThanItsPixels) {
  for (const int pixels : {32, 64, 128, 256}) {
    const ViewSet views = aligned(ball(), kThreeViews, {.pixels = pixels});
    const Silhouettes hard = pixel_contours(views), soft = pixel_contours(views, {.subpixel = true});
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(soft.along[k].loops.size(), 1u);
      EXPECT_LT(circle_error(soft, soft.along[k]), 0.2 / pixels);
      EXPECT_LT(circle_error(soft, soft.along[k]), 0.25 * circle_error(hard, hard.along[k]));
    }
    // All of the three cylinders' common part lies half a unit from the centre, so its area is six times its volume.
    const double volume = ball().hull_volume;
    const Topology t = topology(polyhedral_hull(soft).mesh), stairs = topology(polyhedral_hull(hard).mesh);
    EXPECT_NEAR(t.volume / volume, 1, 10. / pixels / pixels);
    EXPECT_NEAR(t.area / (6 * volume), 1, 0.02);
    EXPECT_GT(stairs.area / (6 * volume), 1.1);
  }
}

TEST_P(RandomContoursTest, SubpixelLoopsReachTheBoxAndTheMethodsAgreeOnThem) {
  // Blurred noise: coverages of all values.
  const Vec3i size(9, 8, 7);
  std::map<View, Drawing> drawings;
  for (const auto& [view, mask] : random_masks(size, GetParam())) {
    Drawing drawing = drawing_of(mask);
    const Mask sharp = drawing.coverage;
    for (int y = 0; y < sharp.height; ++y)
      for (int x = 0; x < sharp.width; ++x) {
        int sum = 0;
        for (int k = 0; k < 9; ++k)
          if (sharp.contains(x + k % 3 - 1, y + k / 3 - 1)) sum += sharp(x + k % 3 - 1, y + k / 3 - 1);
        drawing.coverage(x, y) = static_cast<std::uint8_t>(std::max<int>(sum / 9, sharp(x, y) ? 128 : 0));
      }
    drawings.emplace(view, std::move(drawing));
  }
  const ViewSet views = align(std::move(drawings));
  const Silhouettes s = pixel_contours(views, {.subpixel = true});
  for (int axis = 0; axis < 3; ++axis) {
    std::int32_t size_seen = 0;
    for (const Silhouette& one : s.along)
      for (int k = 0; k < 2; ++k) {
        if ((one.axis + 1 + k) % 3 != axis) continue;
        std::int32_t low = kLattice, high = 0;
        for (const LatticeLoop& loop : one.loops)
          for (const LatticePoint& p : loop) low = std::min(low, p[k]), high = std::max(high, p[k]);
        EXPECT_EQ(low, 0);
        EXPECT_EQ(high, size_seen == 0 ? high : size_seen);
        size_seen = high;
      }
  }
  for (const Silhouette& one : s.along) EXPECT_GT(area(one), 0);
  EXPECT_EQ(compare_methods(s).differences, "");
}

TEST(SubpixelContoursTest, OppositeViewsShowTheirCommonPart) {
  const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 64});
  std::map<View, Drawing> drawings;
  for (const AlignedView& view : views.views) drawings.emplace(view.view, view.drawing);
  const Silhouettes three = pixel_contours(views, {.subpixel = true});
  for (const auto& [view, opposite] : {std::pair(View::front, View::back), std::pair(View::side, View::left)})
    drawings.emplace(opposite, mirrored(drawings.at(view)));
  const Silhouettes five = pixel_contours(align(std::move(drawings)), {.subpixel = true});
  for (int k = 0; k < 3; ++k) EXPECT_EQ(three.along[k].loops, five.along[k].loops);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomContoursTest, testing::Range(0u, 12u));

}  // namespace
}  // namespace carve
