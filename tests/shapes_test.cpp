#include "shapes.h"

#include <gtest/gtest.h>

#include <random>

#include "carve/image/outline.h"

namespace carve {
namespace {

class ShapesTest : public testing::TestWithParam<Shape> {};

/// Image coordinates of a point in a view.
Vec2 seen(View view, const Vec3& p) {
  const auto [right, up, toward] = frame(view);
  return {p[right.axis] * right.sign, p[up.axis] * up.sign};
}

bool within(const Spans& spans, double a) {
  return std::ranges::any_of(spans, [&](const auto& span) { return a > span.first && a < span.second; });
}

TEST_P(ShapesTest, SilhouettesAreTheShadowsOfTheSolid) {
  const Shape& shape = GetParam();
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int n = 24;
  for (View view : kViews) {
    const auto [right, up, toward] = frame(view);
    Mask reached(n, n);
    for (int i = 0; i < 200000; ++i) {  // no point of the solid outside; all of the silhouette reached
      const Vec3 low(-shape.size.x() / 2, 0, -shape.size.z() / 2);
      const Vec3 p = low + shape.size.cwiseProduct(Vec3(uniform(generator), uniform(generator), uniform(generator)));
      if (!shape.inside(p)) continue;
      const Vec2 at = seen(view, p);
      ASSERT_TRUE(within(shape.spans(view, at.y()), at.x())) << shape.name << " " << name(view);
      const auto bin = [&](int axis) {
        return std::min(n - 1, static_cast<int>((p[axis] - low[axis]) / shape.size[axis] * n));
      };
      reached(bin(right.axis), bin(up.axis)) = 1;
    }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const auto at = [&](SignedAxis axis, int k) {
          const double low = axis.axis == 1 ? 0 : -shape.size[axis.axis] / 2;
          return (low + (k + 0.5) / n * shape.size[axis.axis]) * axis.sign;
        };
        if (!within(shape.spans(view, at(up, j)), at(right, i))) continue;
        EXPECT_EQ(reached(i, j), 1) << shape.name << " " << name(view) << " " << i << " " << j;
      }
  }
}

TEST_P(ShapesTest, VolumesAreThoseOfTheSolidAndOfItsHull) {
  const Shape& shape = GetParam();
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  int inside = 0, in_hull = 0;
  constexpr int samples = 1000000;
  for (int i = 0; i < samples; ++i) {
    const Vec3 p(uniform(generator), uniform(generator) + 0.5, uniform(generator));
    inside += shape.inside(p);
    const bool hull = std::ranges::all_of(kThreeViews, [&](View view) {
      const Vec2 at = seen(view, p);
      const auto up = frame(view).up;
      const double low = up.axis == 1 ? 0 : -shape.size[up.axis] / 2;
      return at.y() * up.sign > low && at.y() * up.sign < low + shape.size[up.axis] &&
             within(shape.spans(view, at.y()), at.x());
    });
    in_hull += hull;
  }
  EXPECT_NEAR(inside / double{samples}, shape.volume, 0.002) << shape.name;
  EXPECT_NEAR(in_hull / double{samples}, shape.hull_volume, 0.002) << shape.name;
}

TEST_P(ShapesTest, DrawingsFillTheirBounds) {
  for (View view : kViews) {
    const Drawing drawing = draw(GetParam(), view, {.pixels = 64, .margin = 5, .stroke = 2});
    const OutlineBounds bounds = outline_bounds(drawing);
    const auto [right, up, toward] = frame(view);
    EXPECT_NEAR(bounds.x1 - bounds.x0, 64 * GetParam().size[right.axis], 0.1);
    EXPECT_NEAR(bounds.y1 - bounds.y0, 64 * GetParam().size[up.axis], 0.1);
    EXPECT_NEAR(bounds.x0, 5, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShapesTest, testing::ValuesIn(all_shapes()),
                         [](const auto& info) { return info.param.name; });

TEST(Shapes, StrokesAreEdgesWithinTheSilhouette) {
  const Drawing front = draw(walled_stairs(), View::front, {.pixels = 64, .stroke = 2});
  const auto edges = std::ranges::count(front.labels.pixels, Label::edge);
  EXPECT_NEAR(edges, 2 * (2 * 64 + 3 * 48), 24);  // two walls, three steps, two pixels wide
  EXPECT_EQ(std::ranges::count(draw(walled_stairs(), View::side, {.stroke = 2}).labels.pixels, Label::edge), 0);
}

TEST(Shapes, RandomMasksAreNeverEmptyAndDifferBySeed) {
  int different = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Mask mask = random_mask(9, 7, seed);
    EXPECT_GT(std::ranges::count(mask.pixels, 1), 0);
    EXPECT_EQ(mask, random_mask(9, 7, seed));
    different += mask != random_mask(9, 7, seed + 1);
  }
  EXPECT_GT(different, 90);
}

}  // namespace
}  // namespace carve
