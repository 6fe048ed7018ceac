#include "carve/texture/paint.h"

#include <algorithm>
#include <cmath>

#include "carve/mesh/neighbours.h"

namespace carve {

std::vector<Paint> paint_by_view(const ViewChoice& choice) {
  std::vector<Paint> paints(choice.projection.size());
  for (std::size_t t = 0; t < paints.size(); ++t) {
    const int view = choice.projections[choice.projection[t]].view;
    if (view >= 0) paints[t][0] = {view, 1};
  }
  return paints;
}

std::vector<Paint> paint_by_normal(const Mesh& mesh, const ViewSet& views, Mirror mirror) {
  const std::vector<Vec3> normals = triangle_normals(mesh);
  const bool sides = (views.find(View::side) != nullptr) != (views.find(View::left) != nullptr);
  std::vector<Paint> paints(normals.size());
  for (std::size_t t = 0; t < paints.size(); ++t) {
    double sum = 0;
    std::array<double, 3> weight{};
    for (int v = 0; v < static_cast<int>(views.views.size()); ++v) {
      const SignedAxis toward = frame(views.views[v].view).toward;
      double cosine = toward.sign * normals[t][toward.axis];
      if (toward.axis == 0 && sides && mirror != Mirror::no) cosine = std::abs(cosine);
      if (!(cosine > 0)) continue;
      // Of two drawings along one axis only one has a positive cosine.
      paints[t][toward.axis].view = v;
      sum += weight[toward.axis] = std::min(cosine, 1.0);
    }
    for (int axis = 0; axis < 3; ++axis)
      if (sum > 0) paints[t][axis].weight = static_cast<float>(weight[axis] / sum);
  }
  return paints;
}

Drawings::Drawings(const ViewSet& views, const TextureOptions& options) : views_(views) {
  for (const AlignedView& view : views.views) clean_.push_back(clean(view.drawing, options.inpaint, options.fringe));
}

Vec2 Drawings::pixel(int view, const Vec3& point) const {
  const AlignedView& v = views_.views[view];
  const Frame f = frame(v.view);
  return {v.column(point[f.right.axis]), v.row(point[f.up.axis])};
}

Colour Drawings::at(const Paint& paint, const Vec3& point) const {
  Colour sum = Colour::Zero();
  for (const auto [view, weight] : paint) {
    if (!(weight > 0)) continue;
    const Vec2 pixel = this->pixel(view, point);
    Colour colour;
    clean_[view].sample(pixel.x(), pixel.y(), colour.data());
    sum += weight * colour;
  }
  return sum;
}

Colour Drawings::mean_at(const Paint& paint, const Vec3& point, const Vec3& across, const Vec3& down) const {
  constexpr int kMost = 8;
  double pixels = 0;  // that one step passes
  for (const auto [view, weight] : paint)
    if (weight > 0)
      for (const Vec3& step : {across, down})
        pixels = std::max(pixels, (pixel(view, point + step) - pixel(view, point)).cwiseAbs().maxCoeff());
  const int count = std::clamp(static_cast<int>(std::ceil(pixels - 0.25)), 1, kMost);
  if (count == 1) return at(paint, point);
  Colour sum = Colour::Zero();
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i)
      sum += at(paint, point + ((i + 0.5) / count - 0.5) * across + ((j + 0.5) / count - 0.5) * down);
  return sum / static_cast<float>(count * count);
}

Colour Drawings::mean() const {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const CleanDrawing& drawing : clean_) {
    for (const Rgba p : drawing.picture.pixels) sum += Vec3(p.r, p.g, p.b);
    count += static_cast<double>(drawing.picture.pixels.size());
  }
  return (sum / std::max(count, 1.0)).cast<float>();
}

}  // namespace carve
