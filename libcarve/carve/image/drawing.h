#pragma once
#include <optional>
#include <span>

#include "carve/core/raster.h"

namespace carve {

/// How a drawing's background is told from the object.
enum class Background {
  automatic,  // alpha if more than 2 % is transparent; flood if strokes alone separate the paper outside from paper
              // inside; else border
  alpha,      // pixels that are transparent (alpha < 128)
  border,     // every pixel of the border's colour, holes included
  flood       // pixels of the border's colour that sides connect with the border: white-filled line art on white paper
};
inline std::span<const char* const> names(Background) {
  static constexpr const char* all[] = {"auto", "alpha", "border", "flood"};
  return all;
}

struct DrawingOptions {
  Background background = Background::automatic;
  double tolerance = 12;                  // colour distance to the border's colour that is still background
  double ink = 64;                        // strokes: every channel at most this
  std::optional<double> max_stroke = {};  // pixels; automatic: 2 % of the drawing's longer side, at least 3
};
template <class Visitor>
void visit_fields(DrawingOptions& o, Visitor&& field) {
  field("background", o.background, "how the background is told from the object");
  field("tolerance", o.tolerance, 0.0, 441.0, "largest RGB distance to the border's colour that is still background");
  field("ink", o.ink, 0.0, 255.0, "a stroke's largest channel value");
  field("max_stroke", o.max_stroke, 1.0, 1000.0, "widest black stroke in pixels; wider black areas are surface");
}

/// A drawing as the stages see it: three labels a pixel (thesis 3.1.1) beside the untouched picture.
/// Everywhere labels(x, y) != Label::background exactly where coverage(x, y) >= 128.
struct Drawing {
  Picture picture;
  Raster<Label> labels;
  Mask coverage;  // share of the pixel that the object covers, 0..255: sub-pixel silhouettes of anti-aliased borders
  Background background = Background::automatic;  // the rule that was used
  Rgba border;                                    // the background's colour (alpha 0 where it is transparency)
  double max_stroke = 0;                          // pixels
  Box bounds;                                     // of all pixels that are not background
};

/// Labels every pixel \cite silva_2018.
/// - coverage is alpha, or else where a colour lies between the border's colour and the first unmixed colour inwards.
/// - In pictures with a lossy format's ripples, pale specks and slits narrower than 5 pixels are taken for noise; in
///   others nothing is, down to single pixels.
/// - Strokes (edge) are thin near-black lines with their anti-aliased rim. Near-black areas wider than max_stroke (to a
///   pixel) and larger than 3 max_stroke^2 are surface; so is all of an object without another colour: a silhouette.
/// \throws std::invalid_argument on an option out of range; NoResult if no pixel, or every pixel, is background
Drawing understand_drawing(Picture picture, const DrawingOptions& options = {});

}  // namespace carve
