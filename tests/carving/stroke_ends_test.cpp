#include "carve/carving/stroke_ends.h"

#include <gtest/gtest.h>

#include <set>

#include "carve/carving/region_strokes.h"

namespace carve {
namespace {

constexpr int kLow = 30, kHigh = 230;  // the square's outline

/// A square with an outline and a stroke of three pixels from its left side to the column `end`, at an angle.
Raster<Label> square(int end, double slope) {
  Raster<Label> label(260, 260, Label::background);
  for (int y = kLow; y < kHigh; ++y)
    for (int x = kLow; x < kHigh; ++x) {
      const bool rim = std::min({x - kLow, y - kLow, kHigh - 1 - x, kHigh - 1 - y}) < 3;
      const bool stroke = x < end && std::abs(y - 130 - slope * (x - kLow)) < 1.5 * std::hypot(1, slope);
      label(x, y) = rim || stroke ? Label::edge : Label::surface;
    }
  return label;
}

int parts(const Raster<Label>& label, double gap, double longest) {
  const Raster<int> part =
      cut_at_ends(label, stroke_components(label, 4), stroke_width(where(label, Label::edge)), gap, longest);
  std::set<int> names;
  for (std::size_t i = 0; i < part.pixels.size(); ++i) {
    EXPECT_EQ(part.pixels[i] >= 0, label.pixels[i] == Label::surface);
    if (part.pixels[i] >= 0) names.insert(part.pixels[i]);
  }
  return static_cast<int>(names.size());
}

TEST(StrokeEnds, AStrokeEndsAtItsTipAndGoesOnAsItRan) {
  for (const double slope : {0.0, 0.2, -0.4})
    for (const int end : {80, 130, 200}) {
      const std::vector<StrokeEnd> ends = stroke_ends(square(end, slope), 3);
      ASSERT_EQ(ends.size(), 1u) << slope << ' ' << end;
      EXPECT_NEAR(ends[0].x, end - 1, 2);
      EXPECT_NEAR(ends[0].y, 130 + slope * (end - kLow), 3);
      EXPECT_GT(ends[0].onward.dot(Vec2(1, slope).normalized()), 0.97);
    }
}

TEST(StrokeEnds, OutlinesAndStrokesFromSideToSideHaveNone) {
  EXPECT_TRUE(stroke_ends(square(kLow, 0), 3).empty());
  EXPECT_TRUE(stroke_ends(square(kHigh, 0.1), 3).empty());
}

TEST(StrokeEnds, ARegionIsCutWhereTheWayOnIsNotTooLong) {
  for (const int way : {20, 50, 90}) {  // to the right side
    const Raster<Label> label = square(kHigh - 3 - way, 0);
    EXPECT_EQ(parts(label, 8, way + 5), 2) << way;
    EXPECT_EQ(parts(label, 8, way - 5), 1) << way;
  }
}

TEST(StrokeEnds, AGapInAStrokeIsNoCut) {
  for (const int way : {14, 30}) {
    Raster<Label> label = square(kHigh, 0);
    for (int y = 120; y < 140; ++y)
      for (int x = 130; x < 130 + way; ++x) label(x, y) = Label::surface;
    ASSERT_EQ(stroke_ends(label, 3).size(), 2u);
    EXPECT_EQ(parts(label, way + 2, 50), 1) << way;
    EXPECT_EQ(parts(label, way - 4, 50), 2) << way;
  }
}

}  // namespace
}  // namespace carve
