#include "carve/image/drawing.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "carve/core/bounds.h"
#include "carve/core/error.h"
#include "carve/core/options.h"
#include "carve/image/labelling.h"

namespace carve {
namespace {

double stroke_width(const Picture& picture, const DrawingOptions& options) {
  return options.max_stroke.value_or(std::max(3.0, 0.02 * std::max(picture.width, picture.height)));
}

std::string describe(const labelling::Ground& ground) {
  if (ground.colour.a == 0) return "transparent";
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", ground.colour.r, ground.colour.g, ground.colour.b);
  return text;
}

void require_object_and_background(const Mask& coverage, const labelling::Ground& ground) {
  const auto objects = std::count_if(coverage.pixels.begin(), coverage.pixels.end(), [](int c) { return c >= 128; });
  if (objects != 0 && static_cast<std::size_t>(objects) != coverage.pixels.size()) return;
  throw NoResult(std::string("the drawing shows ") + (objects ? "no background: every" : "no object: every") +
                 " pixel is " + (objects ? "not " : "") + describe(ground) + " (rule " +
                 names(ground.rule)[static_cast<int>(ground.rule)] + ")");
}

}  // namespace

Drawing understand_drawing(Picture picture, const DrawingOptions& options) {
  check("drawing", options);
  if (picture.empty()) throw std::invalid_argument("a drawing must have at least one pixel");
  Drawing drawing;
  drawing.max_stroke = stroke_width(picture, options);
  labelling::Ground ground = labelling::find_ground(picture, options, drawing.max_stroke);
  drawing.background = ground.rule;
  drawing.border = ground.colour;
  drawing.coverage = labelling::estimate_coverage(picture, ground);
  require_object_and_background(drawing.coverage, ground);
  ground.background = {};  // a large drawing needs the memory

  drawing.labels = Raster<Label>(picture.width, picture.height);
  std::transform(drawing.coverage.pixels.begin(), drawing.coverage.pixels.end(), drawing.labels.pixels.begin(),
                 [](int c) { return c >= 128 ? Label::surface : Label::background; });
  drawing.bounds = bounds(drawing.labels, [](Label label) { return label != Label::background; });
  drawing.picture = std::move(picture);
  labelling::label_strokes(drawing, static_cast<int>(options.ink));
  return drawing;
}

}  // namespace carve
