#pragma once
// Internal to carve/image: the three steps of understand_drawing.
#include <vector>

#include "carve/image/drawing.h"

namespace carve::labelling {

/// Squared RGB distance.
inline int distance2(Rgba a, Rgba b) {
  const int r = a.r - b.r, g = a.g - b.g, z = a.b - b.b;
  return r * r + g * g + z * z;
}

/// The colour seen where `pixel` lies on paper of colour `paper`.
inline Rgba over(Rgba pixel, Rgba paper) {
  if (pixel.a == 255) return pixel;
  const auto mix = [&](int above, int below) {
    return static_cast<std::uint8_t>((above * pixel.a + below * (255 - pixel.a) + 127) / 255);
  };
  return {mix(pixel.r, paper.r), mix(pixel.g, paper.g), mix(pixel.b, paper.b), 255};
}

/// Where the background is, before the borders are looked at closely.
struct Ground {
  Background rule;  // alpha, border or flood
  Rgba colour;      // of the background; alpha 0 where it is transparency
  Mask background;  // 1 = background
};
Ground find_ground(const Picture& picture, const DrawingOptions& options, double max_stroke);

/// Drawing::coverage from the ground.
Mask estimate_coverage(const Picture& picture, const Ground& ground);

/// Turns `surface` labels into `edge` where strokes are.
void label_strokes(const Picture& picture, int ink, double max_stroke, Raster<Label>& labels);

/// near[x] = 1 where a pixel of `mask` within `radius` columns and rows of (x, y) is set; pixels outside are not.
void near_row(const Mask& mask, int y, int radius, std::vector<std::uint8_t>& near);

}  // namespace carve::labelling
