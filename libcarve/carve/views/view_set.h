#pragma once
#include <map>
#include <string>
#include <vector>

#include "carve/image/drawing.h"
#include "carve/views/frame.h"

namespace carve {

/// A drawing placed in the world. Object units: the aligned object's longest side is 1; its box is centred on x and z
/// and stands on y = 0.
struct AlignedView {
  View view = View::front;
  Drawing drawing;
  /// Continuous pixel coordinates (pixel (i, j) covers [i, i+1) x [j, j+1)) of object coordinate a along the view's
  /// right axis and b along its up axis: column = column0 + column_per_unit * a, row = row0 + row_per_unit * b.
  /// The signs are the frame's; a flipped drawing has the sign of column_per_unit reversed, its pixels stay as drawn.
  double column0 = 0, column_per_unit = 1, row0 = 0, row_per_unit = -1;

  double column(double a) const { return column0 + column_per_unit * a; }
  double row(double b) const { return row0 + row_per_unit * b; }
};

/// The drawings of one object, brought to one scale (thesis 3.1.1).
struct ViewSet {
  std::vector<AlignedView> views;  // in the order of kViews
  Vec3 size = Vec3::Ones();        // of the object's box; the largest entry is 1
  double disagreement = 0;         // largest relative difference between two drawings' extents along an axis they share

  const AlignedView* find(View view) const;
  Vec3 low() const { return {-size.x() / 2, 0, -size.z() / 2}; }
  Vec3 high() const { return low() + size; }
};

struct AlignOptions {
  std::vector<std::string> flip = {};  // names of views that were drawn mirrored
  bool side_from_left = false;         // the drawing given as side is seen from -X
};
template <class Visitor>
void visit_fields(AlignOptions& o, Visitor&& field) {
  field("flip", o.flip, "views whose drawings are mirrored left-right, by name");
  field("side_from_left", o.side_from_left, "the side drawing is seen from -X (the object's right-hand side)");
}

/// Scales the drawings so that their bounding boxes (to a fraction of a pixel, image/outline.h) agree along shared axes
/// (thesis 3.1.1): the object's proportions are the least-squares fit (of logarithms) of all drawings' proportions, and
/// each drawing's box is stretched onto them. \throws std::invalid_argument: an axis that no drawing shows (so fewer
/// than two drawings), two drawings of one name, a flip of no view; NoResult if a drawing is empty
ViewSet align(std::map<View, Drawing> drawings, const AlignOptions& options = {});

}  // namespace carve
