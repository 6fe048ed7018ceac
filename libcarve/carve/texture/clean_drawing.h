#pragma once
#include "carve/image/drawing.h"

namespace carve {

/// A drawing as paint without lines: what a texture may take. Covers the drawing's bounds and a margin, so that what
/// projects just beside the object finds its colour too.
struct CleanDrawing {
  Picture picture;     // opaque
  int x0 = 0, y0 = 0;  // the drawing's pixel at (0, 0)

  /// Bilinear between pixels' centres, at continuous pixel coordinates of the drawing; beyond the picture its rim.
  void sample(double column, double row, float colour[3]) const;
};

/// Pixels that are strokes, background, or a rim of `fringe` pixels beside either (as far as a core is left) take the
/// colour of the nearest pixel that is none, going through the object; then the background is filled from the object.
/// A part that is nothing but strokes keeps its colour. With inpaint off, only the background is filled.
CleanDrawing clean(const Drawing& drawing, bool inpaint, int fringe);

}  // namespace carve
