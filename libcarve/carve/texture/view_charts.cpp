#include <algorithm>
#include <cmath>

#include "carve/texture/atlas.h"
#include "carve/texture/chart_uvs.h"

namespace carve {
namespace {

constexpr double kUnseenDensity = 0.5;  // texels a pixel

// A linear map from the world to a chart's plane: x to the right, y down.
struct Plane {
  int right, up;  // axes
  Vec2 origin, per_unit;

  Vec2 operator()(const Vec3& p) const { return origin + Vec2(per_unit.x() * p[right], per_unit.y() * p[up]); }
};

Plane plane_of_drawing(const AlignedView& view, bool across) {
  const Frame f = frame(view.view);
  // Seen from where the triangles look to, x must grow to the right.
  const double sign = (view.column_per_unit * f.right.sign > 0) != across ? 1 : -1;
  return {f.right.axis, f.up.axis, {sign * view.column0, view.row0}, {sign * view.column_per_unit, view.row_per_unit}};
}

Plane plane_of_side(SignedAxis toward, double density) {
  const View view = *std::ranges::find_if(
      kViews, [&](View v) { return frame(v).toward.axis == toward.axis && frame(v).toward.sign == toward.sign; });
  const Frame f = frame(view);
  return {f.right.axis, f.up.axis, Vec2::Zero(), {density * f.right.sign, -density * f.up.sign}};
}

double density_of(const ViewSet& views) {
  double largest = 0;
  for (const AlignedView& view : views.views)
    largest = std::max({largest, std::abs(view.column_per_unit), std::abs(view.row_per_unit)});
  return largest;
}

}  // namespace

Charts view_charts(const Mesh& mesh, const ViewSet& views, const ViewChoice& choice) {
  std::vector<Plane> planes;
  for (const Projection& p : choice.projections)
    planes.push_back(p.view < 0 ? plane_of_side(p.toward, kUnseenDensity * density_of(views))
                                : plane_of_drawing(views.views[p.view],
                                                   p.toward.sign != frame(views.views[p.view].view).toward.sign));
  Charts charts{{}, {}, choice.patch, choice.patches};
  share_corners(mesh, charts,
                [&](int triangle, int vertex) { return planes[choice.projection[triangle]](mesh.positions[vertex]); });
  charts.height.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < charts.height.size(); ++t) {
    const SignedAxis toward = choice.projections[choice.projection[t]].toward;
    for (const int v : mesh.triangles[t]) charts.height[t] += toward.sign * mesh.positions[v][toward.axis];
  }
  return charts;
}

}  // namespace carve
