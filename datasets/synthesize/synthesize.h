#pragma once
#include <map>
#include <string>
#include <vector>

#include "carve/views/frame.h"
#include "models/model.h"
#include "synthesize/degrade.h"

namespace carve {

struct SynthesizeOptions {
  std::vector<std::string> views = {"front", "side", "top"};
  int size = 512;
  double margin = 6;                  // % of size
  double stroke = 3;                  // pixels
  double jump = 1;                    // % of the diagonal of the model's box
  std::optional<double> crease = {};  // degrees
  int darkest = 80;
  std::string background = "transparent";
  int samples = 4;
};
template <class Visitor>
void visit_fields(SynthesizeOptions& o, Visitor&& field) {
  field("views", o.views, "drawings to make: front, side, top, back, left, bottom");
  field("size", o.size, 16, 16384, "width and height of a drawing in pixels");
  field("margin", o.margin, 0.0, 40.0, "empty border in % of the size");
  field("stroke", o.stroke, 0.0, 64.0, "width of a stroke in pixels; 0: none");
  field("jump", o.jump, 0.01, 100.0, "smallest depth discontinuity that is drawn, in % of the box's diagonal");
  field("crease", o.crease, 1.0, 180.0, "also draw edges at which the surface turns by more degrees; auto: none");
  field("darkest", o.darkest, 0, 255,
        "near-black surfaces are lifted to this channel value, to tell them from strokes");
  field("background", o.background, "transparent, white or #rrggbb");
  field("samples", o.samples, 1, 16, "rays a pixel, along each axis");
}

/// Concept art of a model: orthographic drawings as views/frame.h defines them, flat-lit, all at one scale (the model's
/// longest side fills the picture but for the margin), each with the model's box in its middle. Back faces show.
///
/// Strokes are black. The outline is drawn inside the silhouette, so the object's bounding box stays true. A stroke at
/// an inner depth jump is centred on it, half on the nearer and half on the farther surface: what lies between two
/// strokes is then wrong by half a stroke on either side, whichever side it is. A jump is where the depth changes by
/// more than `jump` within jump / 100: a steep but continuous slope (up to 89.4 degrees) is none.
///
/// \throws std::invalid_argument on an option out of range, or a model without triangles
std::map<View, Picture> synthesize(const Model& model, const SynthesizeOptions& options = {},
                                   const DegradeOptions& degrade = {});

}  // namespace carve
