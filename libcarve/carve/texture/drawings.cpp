#include "carve/texture/drawings.h"

#include <algorithm>
#include <cmath>

namespace carve {

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
