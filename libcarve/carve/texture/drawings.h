#pragma once
#include <array>
#include <vector>

#include "carve/texture/clean_drawing.h"
#include "carve/texture/options.h"
#include "carve/views/view_set.h"

namespace carve {

/// What a triangle is coloured with: a sum of drawings. Weights sum to 1, or are all 0: no drawing shows it.
struct Layer {
  int view = -1;  // index of ViewSet::views
  float weight = 0;
};
using Paint = std::array<Layer, 3>;

using Colour = Eigen::Vector3f;  // 0 to 255, sRGB

/// The drawings of a ViewSet as paint.
class Drawings {
 public:
  Drawings(const ViewSet& views, const TextureOptions& options);
  Colour at(const Paint& paint, const Vec3& point) const;
  /// Of points as far apart as `across` and `down`: the mean over the parallelogram around the point.
  Colour mean_at(const Paint& paint, const Vec3& point, const Vec3& across, const Vec3& down) const;
  /// Over everything drawn.
  Colour mean() const;

 private:
  Vec2 pixel(int view, const Vec3& point) const;

  const ViewSet& views_;
  std::vector<CleanDrawing> clean_;
};

}  // namespace carve
