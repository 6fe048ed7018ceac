#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "carve/core/raster.h"
#include "carve/views/frame.h"
#include "models/model.h"
#include "models/ray_scene.h"

namespace carve {

/// The middle of the model's box in the picture, and pixels a unit.
struct Placement {
  double scale = 1;
  double column = 0, row = 0;
};

/// A rectangle of samples, `samples` x `samples` a pixel; the row of index 0 is sample row `first_row` of the picture.
struct SampleBlock {
  int width = 0, height = 0, first_row = 0;
  std::vector<int> triangle;  // -1: background
  std::vector<double> depth;  // towards the viewer
  std::vector<Rgba> colours;
  std::size_t at(int i, int j) const { return static_cast<std::size_t>(j) * width + i; }
  bool hit(int i, int j) const { return triangle[at(i, j)] >= 0; }
  const Rgba& colour(int i, int j) const { return colours[at(i, j)]; }
};

/// What a view's rays meet. Coordinates are samples: sample (i, j) has its centre at (i + 0.5, j + 0.5).
class ViewSampler {
 public:
  ViewSampler(const Model& model, const RayScene& scene, View view, const Placement& place, int samples);
  SampleBlock sample(int first_row, int last_row, int width) const;

  struct Hit {
    int triangle = -1;
    double depth = 0;
  };
  Hit hit(double x, double y) const;
  Vec3 normal(int triangle) const;  // unit, turned to the viewer; right, up, toward
  double spacing() const { return 1 / scale_; }

 private:
  struct Corner {
    double right, up, toward;
  };
  Corner corner(int triangle, int k) const;
  Corner point(double x, double y) const;
  Rgba colour(int triangle, const Corner& p) const;

  const Model& model_;
  const RayScene& scene_;
  Frame frame_;
  double scale_, column_, row_;                    // in samples
  double middle_right_, middle_up_, nearest_ = 0;  // of the model's box
  double low_x_, high_x_, low_y_, high_y_;         // the box in samples
};

/// Where strokes go and how wide they are.
struct StrokeRule {
  int samples = 1;                                                          // a pixel
  double width = 3;                                                         // pixels
  double jump = 0.01;                                                       // units
  std::optional<double> crease = {};                                        // degrees
  std::function<std::pair<double, double>(double x, double y)> waver = {};  // pixels
  double largest_waver = 0;
  double reach() const { return width + largest_waver; }
};

/// The samples that are ink: within `width` of the silhouette, or half of it of a jump or crease.
Mask strokes(const ViewSampler& sampler, const SampleBlock& block, const StrokeRule& rule);

}  // namespace carve
