#include <gtest/gtest.h>

#include "carve/hull/contours.h"
#include "hull/agreement.h"
#include "hull/polygons.h"
#include "shapes.h"

namespace carve {
namespace {

class MethodsTest : public testing::TestWithParam<unsigned> {};

TEST_P(MethodsTest, AgreeOnPolygons) {
  const Agreement agreement = compare_methods(random_silhouettes(GetParam()));
  EXPECT_EQ(agreement.differences, "");
}

TEST_P(MethodsTest, AgreeOnPixelContours) {
  const Agreement agreement = compare_methods(pixel_contours(views_of_masks(random_masks({7, 6, 5}, GetParam()))));
  EXPECT_EQ(agreement.differences, "");
}

INSTANTIATE_TEST_SUITE_P(Seeds, MethodsTest, testing::Range(0u, 10u));

TEST(MethodsOnTwoViewsTest, Agree) {
  Silhouettes s = random_silhouettes(11);
  s.along.pop_back();
  const Agreement agreement = compare_methods(s);
  EXPECT_EQ(agreement.differences, "");
  EXPECT_FALSE(agreement.empty);
}

TEST(MethodsOnShapesTest, Agree) {
  for (const Shape& shape : {torus(), stairs(3)}) {
    const ViewSet views = aligned(shape, kThreeViews, {.pixels = 24});
    for (const bool subpixel : {false, true}) {
      const Agreement agreement = compare_methods(pixel_contours(views, {.subpixel = subpixel}));
      EXPECT_EQ(agreement.differences, "") << shape.name;
      EXPECT_FALSE(agreement.empty) << shape.name;
    }
  }
}

}  // namespace
}  // namespace carve
