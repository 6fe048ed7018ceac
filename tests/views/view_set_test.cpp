#include "carve/views/view_set.h"

#include <gmock/gmock.h>

#include <random>

#include "carve/core/error.h"
#include "shapes.h"

namespace carve {
namespace {

Drawing rectangle(int width, int height, int margin = 1) {
  Mask mask(width + 2 * margin, height + 2 * margin);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) mask(margin + x, margin + y) = 1;
  return drawing_of(mask);
}

std::string error_of(std::map<View, Drawing> drawings, const AlignOptions& options = {}) {
  try {
    align(std::move(drawings), options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Frame, NoViewIsMirrored) {
  for (View view : kViews) {
    const auto [right, up, toward] = frame(view);
    const auto axis = [](SignedAxis a) { return Vec3(a.sign * Vec3::Unit(a.axis)); };
    const Vec3 r = axis(right), u = axis(up);
    const Vec3 cross(r.y() * u.z() - r.z() * u.y(), r.z() * u.x() - r.x() * u.z(), r.x() * u.y() - r.y() * u.x());
    EXPECT_EQ(cross, axis(toward)) << name(view);
  }
}

TEST(Align, RecoversTheSizesOfRandomlyScaledDrawings) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 generator(seed);
    const auto extent = [&] { return 0.2 + generator() % 1000 / 1000.0; };
    Vec3 size(extent(), extent(), extent());
    size /= size.maxCoeff();
    std::map<View, Drawing> drawings;
    for (View view : kViews) {
      const double scale = 100 + generator() % 200;
      const auto pixels = [&](SignedAxis axis) { return static_cast<int>(std::lround(scale * size[axis.axis])); };
      if (view == View::front || view == View::side || view == View::top || generator() % 2)
        drawings[view] =
            rectangle(pixels(frame(view).right), pixels(frame(view).up), static_cast<int>(generator() % 9));
    }
    const ViewSet views = align(drawings);
    EXPECT_EQ(views.size.maxCoeff(), 1);
    EXPECT_LT((views.size - size).cwiseAbs().maxCoeff(), 0.02) << seed;
    EXPECT_LT(views.disagreement, 0.05);
    EXPECT_EQ(views.views.size(), drawings.size());
  }
}

TEST(Align, BoxesLieOnEachOther) {
  // Drawings that contradict each other: every box is stretched onto the fitted size all the same.
  const ViewSet views = align({{View::front, rectangle(40, 20)},
                               {View::side, rectangle(30, 30)},
                               {View::top, rectangle(50, 10)},
                               {View::back, rectangle(44, 21)},
                               {View::left, rectangle(10, 20)},
                               {View::bottom, rectangle(40, 20)}});
  EXPECT_GT(views.disagreement, 0.1);
  for (const AlignedView& view : views.views) {
    const auto [right, up, toward] = frame(view.view);
    const Box& box = view.drawing.bounds;
    const Vec3 low = views.low(), high = views.high();
    const double left = view.column(right.sign > 0 ? low[right.axis] : high[right.axis]);
    const double end = view.column(right.sign > 0 ? high[right.axis] : low[right.axis]);
    const double bottom = view.row(up.sign > 0 ? low[up.axis] : high[up.axis]);
    const double top = view.row(up.sign > 0 ? high[up.axis] : low[up.axis]);
    EXPECT_NEAR(left, box.x0, 1e-9) << name(view.view);
    EXPECT_NEAR(end, box.x1, 1e-9) << name(view.view);
    EXPECT_NEAR(top, box.y0, 1e-9) << name(view.view);
    EXPECT_NEAR(bottom, box.y1, 1e-9) << name(view.view);
  }
}

TEST(Align, FitsProportionsByLeastSquaresOfLogarithms) {
  // Front says x : y = 2, back says 8; nothing else measures it: the fit is their geometric mean.
  const ViewSet views =
      align({{View::front, rectangle(40, 20)}, {View::back, rectangle(160, 20)}, {View::side, rectangle(20, 20)}});
  EXPECT_NEAR(views.size.x() / views.size.y(), 4, 1e-9);
  EXPECT_NEAR(views.size.z() / views.size.y(), 1, 1e-9);
  EXPECT_NEAR(views.disagreement, 0.5, 1e-9);  // each is a factor sqrt 2 off in both directions
}

TEST(Align, TwoDrawingsAlwaysAgree) {
  const ViewSet views = align({{View::front, rectangle(40, 20)}, {View::side, rectangle(90, 60)}});
  EXPECT_NEAR(views.disagreement, 0, 1e-12);
  EXPECT_NEAR(views.size.x(), 1, 1e-12);
  EXPECT_NEAR(views.size.y(), 0.5, 1e-12);
  EXPECT_NEAR(views.size.z(), 0.75, 1e-12);
}

TEST(Align, AFlippedDrawingIsReadBackwards) {
  const std::map<View, Drawing> drawings = draw(stairs());
  std::map<View, Drawing> flipped = drawings;
  flipped[View::side] = mirrored(flipped[View::side]);
  const ViewSet plain = align(drawings), undone = align(flipped, {.flip = {"side"}});
  const AlignedView &a = *plain.find(View::side), &b = *undone.find(View::side);
  for (double z : {-0.5, -0.1, 0.3}) EXPECT_NEAR(a.column(z), a.drawing.labels.width - b.column(z), 1e-9);
}

TEST(Align, ASideFromTheLeftIsTheLeftView) {
  std::map<View, Drawing> drawings = draw(stairs());
  drawings[View::side] = draw(stairs(), View::left);
  const ViewSet views = align(drawings, {.side_from_left = true});
  EXPECT_EQ(views.find(View::side), nullptr);
  ASSERT_NE(views.find(View::left), nullptr);
  EXPECT_GT(views.find(View::left)->column_per_unit, 0);
  drawings[View::left] = drawings[View::side];
  EXPECT_THAT(error_of(drawings, {.side_from_left = true}), testing::StartsWith("align.side_from_left must be off"));
}

TEST(Align, ErrorsSayWhichViewIsMissing) {
  const Drawing drawing = rectangle(4, 4);
  EXPECT_EQ(error_of({{View::front, drawing}}),
            "views must show all three axes, got front: nothing shows z (depth), add one of side, top, left, bottom");
  EXPECT_EQ(
      error_of({{View::top, drawing}, {View::bottom, drawing}}),
      "views must show all three axes, got top, bottom: nothing shows y (height), add one of front, side, back, left");
  EXPECT_EQ(
      error_of({{View::side, drawing}, {View::left, drawing}}),
      "views must show all three axes, got side, left: nothing shows x (width), add one of front, top, back, bottom");
  EXPECT_THAT(error_of({}), testing::HasSubstr("got none"));
  EXPECT_EQ(error_of({{View::front, drawing}, {View::top, drawing}}, {.flip = {"frnt"}}),
            "align.flip must be one of front|side|top|back|left|bottom, got frnt");
}

TEST(Align, AnEmptyDrawingHasNoResult) {
  EXPECT_THROW(align({{View::front, rectangle(4, 4)}, {View::top, drawing_of(Mask(5, 5))}}), NoResult);
}

TEST(Align, BoundsBeyondTheRasterAreRefused) {
  Drawing drawing = rectangle(4, 4);
  drawing.bounds.x1 = 100;
  EXPECT_THAT(error_of({{View::front, rectangle(4, 4)}, {View::top, drawing}}),
              "top: bounds must lie inside the labels");
}

}  // namespace
}  // namespace carve
