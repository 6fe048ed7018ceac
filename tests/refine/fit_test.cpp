#include "carve/refine/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "carve/carving/carve_silhouettes.h"
#include "carve/core/parallel.h"
#include "carve/mesh/topology.h"
#include "carve/refine/contour.h"
#include "carve/surface/crossings.h"
#include "carve/surface/marching_cubes.h"
#include "carve/surface/smooth.h"
#include "shapes.h"

namespace carve {
namespace {

// The visual hull's surface, as the pipeline makes it.
Mesh hull_of(const ViewSet& views, int grid) {
  const Carving hull = carve_silhouettes(views, {.grid = grid});
  return smooth(marching_cubes(hull.grid, contour_crossings(views, hull.grid)));
}

double mean_distance_to_ball(const Mesh& mesh) {
  double sum = 0;
  for (const Vec3& p : mesh.positions) sum += std::abs((p - Vec3(0, 0.5, 0)).norm() - 0.5);
  return sum / static_cast<double>(mesh.positions.size());
}

double farthest_move(const Mesh& a, const Mesh& b) {
  double most = 0;
  for (std::size_t v = 0; v < a.positions.size(); ++v) most = std::max(most, (a.positions[v] - b.positions[v]).norm());
  return most;
}

// Mean distance between the outline and the outermost vertex along it, in pixels.
double rim_gap(const Mesh& mesh, const AlignedView& view) {
  const refining::Contour contour(view);
  std::vector<double> outermost(contour.pieces() / 16, -1);  // stretches longer than an edge
  for (const Vec3& p : mesh.positions) {
    const refining::Nearest at = contour.nearest(p);
    if (const std::size_t i = at.piece / 16; i < outermost.size()) outermost[i] = std::max(outermost[i], at.distance);
  }
  double sum = 0;
  for (const double distance : outermost) sum += std::abs(distance);
  return sum / static_cast<double>(outermost.size()) * std::abs(view.column_per_unit);
}

class FitTest : public testing::Test {
 protected:
  const ViewSet circles_ = aligned(ball());
  const Mesh hull_ = hull_of(circles_, 24), fitted_ = fit(hull_, circles_);
};

TEST_F(FitTest, ThreeCirclesMakeASphere) {
  EXPECT_LT(mean_distance_to_ball(fitted_), 0.5 * mean_distance_to_ball(hull_));
}

TEST_F(FitTest, RimsLieOnTheOutlines) {
  for (const AlignedView& view : circles_.views) EXPECT_LT(rim_gap(fitted_, view), 0.25) << name(view.view);
}

TEST_F(FitTest, NothingLeavesTheVisualHull) {
  for (const AlignedView& view : circles_.views) {
    const refining::Contour contour(view);
    double farthest = 0;  // pixels
    for (const Vec3& p : fitted_.positions)
      farthest = std::max(farthest, contour.nearest(p).distance * std::abs(view.column_per_unit));
    EXPECT_LT(farthest, 0.05) << name(view.view);
  }
}

TEST_F(FitTest, TrianglesStay) {
  EXPECT_EQ(fitted_.triangles, hull_.triangles);
  EXPECT_EQ(fit(hull_, circles_, {.rounds = 0}), hull_);
}

TEST_F(FitTest, ThreadsDoNotChangeTheBytes) {
  set_thread_count(1);
  const Mesh one = fit(hull_, circles_, {.rounds = 2});
  set_thread_count(4);
  EXPECT_EQ(one, fit(hull_, circles_, {.rounds = 2}));
  set_thread_count(0);
}

TEST(FitWalls, BoxesStayBoxes) {
  for (const Shape& shape : {box(), stairs()}) {
    const ViewSet views = aligned(shape);
    const Mesh hull = hull_of(views, 32);
    EXPECT_LT(farthest_move(hull, fit(hull, views)), 0.5 / 32) << shape.name;
  }
}

TEST(FitContour, DistancesAreThoseOfTheDrawnCircle) {
  const ViewSet views = aligned(ball());
  const refining::Contour contour(*views.find(View::front));
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.1 * i, radius = 0.1 + 0.003 * i;
    const Vec3 p(radius * std::cos(angle), 0.5 + radius * std::sin(angle), 0.3);
    const refining::Nearest at = contour.nearest(p);
    EXPECT_NEAR(at.distance, radius - 0.5, 0.5 / 128);
    EXPECT_GT(at.outward.dot(Vec2(std::cos(angle), std::sin(angle))), 0.9);
    EXPECT_NEAR(contour.radius(at.piece), 0.5, 0.1);
    EXPECT_FALSE(contour.straight(at.piece));
  }
}

TEST(FitContour, ABoxHasStraightWalls) {
  for (const View view : kThreeViews) {
    const ViewSet views = aligned(box());
    const refining::Contour contour(*views.find(view));
    int straight = 0;
    for (int i = 0; i < contour.pieces(); ++i) straight += contour.straight(i);
    EXPECT_GT(straight, 0.9 * contour.pieces());
  }
}

TEST(Fit, BadOptionsAreRefused) {
  const ViewSet views = aligned(ball());
  const Mesh hull = hull_of(views, 8);
  EXPECT_THROW(fit(hull, views, {.rounds = -1}), std::invalid_argument);
  EXPECT_THROW(fit(hull, views, {.bend = -0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace carve
