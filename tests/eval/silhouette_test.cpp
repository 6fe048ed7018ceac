#include "eval/silhouette.h"

#include <gmock/gmock.h>

#include "eval/meshes.h"
#include "shapes.h"

namespace carve {
namespace {

// The box of shapes.h, [-1/2, 1/2] x [0, 3/4] x [-1/4, 1/4].
Mesh box_mesh() {
  return mapped(cube(), [](const Vec3& p) { return Vec3(p.x(), 0.75 * (p.y() + 0.5), 0.5 * p.z()); });
}

// Boxes under the steps of shapes.h's stairs, which rise from the front (+z) to the back.
Mesh stairs_mesh(const Shape& shape, int steps) {
  Mesh mesh;
  const Vec3 size = shape.size;
  for (int i = 0; i < steps; ++i) {
    const double front = size.z() / 2 - i * size.z() / steps, height = size.y() * (i + 1) / steps;
    mesh = joined(mesh, mapped(cube(), [&](const Vec3& p) {
                    return Vec3(size.x() * p.x(), height * (p.y() + 0.5), front + size.z() / steps * (p.z() - 0.5));
                  }));
  }
  return mesh;
}

TEST(Silhouette, OfTheDrawnObjectAgreesExactly) {
  const SilhouetteScores scores = silhouette_scores(box_mesh(), aligned(box()));
  EXPECT_EQ(scores.fit, Fit::object);
  ASSERT_EQ(scores.views.size(), 3u);
  for (const ViewScore& view : scores.views) {
    EXPECT_EQ(view.iou, 1) << name(view.view);
    EXPECT_EQ(view.missing + view.extra, 0);
    EXPECT_FALSE(view.stroke_f());
  }
  EXPECT_EQ(scores.least_iou(), 1);
}

TEST(Silhouette, OfABallAgreesToAPixel) {
  const SilhouetteScores scores = silhouette_scores(
      mapped(carve::ball(60, 0.5), [](const Vec3& p) { return Vec3(p + Vec3(0, 0.5, 0)); }), aligned(carve::ball()));
  EXPECT_GT(scores.least_iou(), 0.985);
}

TEST(Silhouette, MissesAndExtrasAreCounted) {
  const ViewSet views = aligned(box());
  const SilhouetteScores wide = silhouette_scores(
      mapped(box_mesh(), [](const Vec3& p) { return Vec3(1.125 * p.x(), p.y(), p.z()); }), views, {.fit = Fit::object});
  EXPECT_EQ(wide.views[0].missing, 0);
  EXPECT_EQ(wide.views[0].extra, 128 * 96 / 8);
  EXPECT_DOUBLE_EQ(wide.views[0].iou, 8.0 / 9);
  EXPECT_EQ(wide.views[1].iou, 1);
  const SilhouetteScores low = silhouette_scores(
      mapped(box_mesh(), [](const Vec3& p) { return Vec3(p.x(), 0.5 * p.y(), p.z()); }), views, {.fit = Fit::object});
  EXPECT_EQ(low.views[0].missing, 128 * 96 / 2);
  EXPECT_EQ(low.least_iou(), 0.5);
}

TEST(Silhouette, AMeshInAnyUnitIsFittedByItsBox) {
  const Mesh far = mapped(box_mesh(), [](const Vec3& p) { return Vec3(100 * p + Vec3(7, 8, 9)); });
  const SilhouetteScores scores = silhouette_scores(far, aligned(box()));
  EXPECT_EQ(scores.fit, Fit::box);
  EXPECT_EQ(scores.least_iou(), 1);
  EXPECT_EQ(silhouette_scores(far, aligned(box()), {.fit = Fit::object}).least_iou(), 0);
}

TEST(Silhouette, DrawnStrokesMatchTheDepthsJumps) {
  const Shape shape = stairs(3);
  const ViewSet views = aligned(shape, kThreeViews, {.pixels = 256, .stroke = 3});
  const SilhouetteScores right = silhouette_scores(stairs_mesh(shape, 3), views);
  const SilhouetteScores block = silhouette_scores(
      mapped(cube(), [&](const Vec3& p) { return Vec3((p + Vec3(0, 0.5, 0)).cwiseProduct(shape.size)); }), views);
  for (const int i : {0, 2}) {  // front and top show the steps
    EXPECT_EQ(right.views[i].stroke_f(), 1) << name(right.views[i].view);
    EXPECT_EQ(block.views[i].stroke_f(), 0);
    EXPECT_EQ(block.views[i].stroke_recall, 0);
    EXPECT_FALSE(block.views[i].stroke_precision);
  }
}

TEST(Silhouette, FlippedDrawingsAreComparedAsDrawn) {
  const Shape shape = stairs(4);
  std::map<View, Drawing> drawings = draw(shape);
  drawings.at(View::side) = mirrored(drawings.at(View::side));
  const ViewSet as_given = align(drawings), flipped = align(drawings, {.flip = {"side"}});
  EXPECT_LT(silhouette_scores(stairs_mesh(shape, 4), as_given).views[1].iou, 0.7);
  EXPECT_GT(silhouette_scores(stairs_mesh(shape, 4), flipped).views[1].iou, 0.98);
}

TEST(Silhouette, RefusesWhatCannotBeSeen) {
  const ViewSet views = aligned(box());
  EXPECT_THROW(silhouette_scores({}, views), std::invalid_argument);
  EXPECT_THROW(silhouette_scores(square(2), views, {.fit = Fit::box}), std::invalid_argument);
  EXPECT_THROW(silhouette_scores(box_mesh(), views, {.jump = 0}), std::invalid_argument);
}

TEST(Silhouette, ReportsNameEveryView) {
  const SilhouetteScores scores = silhouette_scores(box_mesh(), aligned(box()));
  std::ostringstream text;
  text << scores;
  for (const ViewScore& view : scores.views) {
    EXPECT_THAT(text.str(), testing::HasSubstr(name(view.view)));
    EXPECT_THAT(to_json(scores), testing::HasSubstr(name(view.view)));
  }
}

}  // namespace
}  // namespace carve
