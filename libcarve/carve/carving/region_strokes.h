#pragma once
#include "carve/carving/nearest.h"
#include "carve/core/raster.h"

namespace carve {

/// The part of a drawing that its regions are found in: a margin of background around all else.
struct RegionWindow {
  int x0, y0;  // of its pixel (0, 0) in the drawing
  Raster<Label> label;
  Raster<Rgba> colour;
};

Mask where(const Raster<Label>& labels, Label wanted);

/// Median width of the strokes in pixels: the shorter of the horizontal and the vertical run through each edge pixel.
double stroke_width(const Mask& edge);

/// Keeps the strokes that are drawn like the outline: as dark, and, gaps closed, not only specks of less than
/// `smallest` pixels. The others, dark spots of a texture, become surface. \param width  stroke_width()
void drop_false_strokes(RegionWindow& window, const NearestSet& background, double width, double gap, double smallest);

/// How long gaps in the strokes are, in pixels: the median length of what is missing of the outline, which is closed in
/// truth. 0 where it is drawn all around, or where the drawing has hardly any.
double outline_gap(const Raster<Label>& label);

/// Components of the surface between strokes, as a watershed of the distance to them: two basins are one if the pass
/// between them is wider than the gap, or nearly as wide as the narrower basin. -1 on strokes and background.
Raster<int> stroke_components(const Raster<Label>& label, double gap);

/// Components of less than `smallest` pixels, left between the pieces of broken strokes, become part of the strokes.
void fill_specks(Raster<Label>& label, Raster<int>& component, double smallest);

}  // namespace carve
