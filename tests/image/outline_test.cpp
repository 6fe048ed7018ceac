#include "carve/image/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "shapes.h"

namespace carve {
namespace {

Mask hard(const Mask& mask) {
  Mask coverage = mask;
  for (auto& c : coverage.pixels) c = c ? 255 : 0;
  return coverage;
}

TEST(Outline, HardPixelsAreTheirSquares) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Mask mask = random_mask(8, 6, seed);
    const Mask coverage = hard(mask);
    const Outline outline(coverage);
    for (double y = -0.95; y < 7; y += 0.1)
      for (double x = -0.95; x < 9; x += 0.1) {
        const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
        ASSERT_EQ(outline.contains(x, y), mask.contains(i, j) && mask(i, j)) << x << " " << y;
      }
  }
}

TEST(Outline, BordersBelongToIt) {
  Mask coverage(3, 3);
  coverage(1, 1) = 255;
  const Outline outline(coverage);
  for (double t : {1.0, 1.3, 2.0})
    for (double side : {1.0, 2.0}) {
      EXPECT_TRUE(outline.contains(t, side));
      EXPECT_TRUE(outline.contains(side, t));
    }
  EXPECT_FALSE(outline.contains(1.5, 2.001));
}

TEST(Outline, ALineLeavesWhereTheRegionEnds) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Mask coverage = hard(random_mask(12, 9, seed));
    std::mt19937 generator(seed);
    for (auto& c : coverage.pixels)
      if (generator() % 3 == 0) c = static_cast<std::uint8_t>(generator() % 256);
    const Outline outline(coverage);
    const auto uniform = [&](double low, double high) { return low + (high - low) * (generator() % 9973) / 9973.0; };
    const double from = uniform(0, 12), to = uniform(-1, 13), y = uniform(0, 9);
    const double left = outline.leave_along_row(from, to, y);
    EXPECT_GE((left - from) * (to - from), 0);
    EXPECT_GE((to - left) * (to - from), 0);
    for (int k = 1; k < 400; ++k) {  // inside all the way there, outside right after
      const double x = from + (left - from) * k / 400;
      ASSERT_TRUE(std::abs(x - left) < 1e-4 || outline.contains(x, y)) << seed;
    }
    const double after = left + (to > from ? 1e-4 : -1e-4);
    ASSERT_TRUE(std::abs(to - left) < 1e-4 || !outline.contains(after, y)) << seed;
  }
}

TEST(Outline, RowsAndColumnsAreTreatedAlike) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 generator(seed);
    Mask coverage(7, 5), turned(5, 7);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) turned(y, x) = coverage(x, y) = static_cast<std::uint8_t>(generator() % 256);
    const Outline a(coverage), b(turned);
    const double from = generator() % 70 / 10.0, to = generator() % 70 / 10.0, at = generator() % 50 / 10.0;
    EXPECT_DOUBLE_EQ(a.leave_along_row(from, to, at), b.leave_along_column(from, to, at));
    EXPECT_EQ(a.contains(from, at), b.contains(at, from));
  }
}

TEST(Outline, StraightSoftBordersAreExact) {
  for (int c = 1; c < 255; ++c) {  // a border that covers a share of its pixels
    Mask coverage(6, 3);
    for (int y = 0; y < 3; ++y) coverage(1, y) = coverage(2, y) = 255, coverage(3, y) = static_cast<std::uint8_t>(c);
    EXPECT_NEAR(Outline(coverage).leave_along_row(2.5, 5.5, 1.5), 3 + c / 255.0, 0.09) << c;
  }
}

TEST(Outline, ADiscsOutlineIsWithinATenthOfAPixel) {
  const Drawing disc = draw(ball(), View::front, {.pixels = 100, .margin = 2});
  const Outline outline(disc.coverage);
  for (int degree = 0; degree < 3600; ++degree) {
    const double angle = degree * std::numbers::pi / 1800, c = std::cos(angle), s = std::sin(angle);
    EXPECT_TRUE(outline.contains(52 + 49.9 * c, 52 + 49.9 * s)) << degree;
    EXPECT_FALSE(outline.contains(52 + 50.1 * c, 52 + 50.1 * s)) << degree;
  }
}

TEST(Outline, BoundsAreThoseOfASoftBox) {
  // A box from (2.25, 1.5) to (6.75, 4.9): shares of its border pixels.
  const auto share = [](double low, double high, int i) {
    return std::max(0.0, std::min<double>(high, i + 1) - std::max<double>(low, i));
  };
  Drawing drawing;
  drawing.labels = Raster<Label>(9, 7);
  drawing.coverage = Mask(9, 7);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x) {
      drawing.coverage(x, y) = static_cast<std::uint8_t>(std::lround(255 * share(2.25, 6.75, x) * share(1.5, 4.9, y)));
      if (drawing.coverage(x, y) >= 128) drawing.labels(x, y) = Label::surface;
    }
  drawing.bounds = {2, 1, 7, 5};
  const OutlineBounds bounds = outline_bounds(drawing);
  EXPECT_NEAR(bounds.x0, 2.25, 0.1);
  EXPECT_NEAR(bounds.y0, 1.5, 0.1);
  EXPECT_NEAR(bounds.x1, 6.75, 0.1);
  EXPECT_NEAR(bounds.y1, 4.9, 0.1);
}

}  // namespace
}  // namespace carve
