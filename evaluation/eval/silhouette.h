#pragma once
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carve/mesh/mesh.h"
#include "carve/views/view_set.h"

namespace carve {

/// Where the mesh is placed before it is drawn.
enum class Fit {
  automatic,  // object if its box is within 10 % of the drawings' box, else box
  object,     // its coordinates are object units (views/view_set.h): what carve writes
  box         // its bounding box is stretched onto the drawings' box
};
inline std::span<const char* const> names(Fit) {
  static constexpr const char* all[] = {"auto", "object", "box"};
  return all;
}

struct SilhouetteOptions {
  Fit fit = Fit::automatic;
  double jump = 2;
  double reach = 1;
  double least_iou = 0.95;
};
template <class Visitor>
void visit_fields(SilhouetteOptions& o, Visitor&& field) {
  field("fit", o.fit, "where the mesh is placed: object units as they are, or its box stretched onto the drawings'");
  field("jump", o.jump, 0.01, 100.0, "depth difference of neighbouring pixels that makes a stroke, % of the object");
  field("reach", o.reach, 0.0, 100.0, "how far a stroke may lie from its match, % of the drawing's box");
  field("least_iou", o.least_iou, 0.0, 1.0, "silhouette IoU that every view must reach");
}

/// One view of the mesh against its drawing, pixel by pixel. Strokes are compared away from the outline only (what the
/// outline does the IoU tells): drawn strokes against the rendered depth's jumps. Nothing: there were none to compare.
struct ViewScore {
  View view = View::front;
  double iou = 0;                               // of the silhouettes
  std::int64_t missing = 0, extra = 0;          // pixels drawn but not covered, covered but not drawn
  std::optional<double> stroke_precision = {};  // share of rendered strokes with a drawn one in reach
  std::optional<double> stroke_recall = {};     // share of drawn strokes with a rendered one in reach
  std::optional<double> stroke_f() const;       // their harmonic mean; 0 where both are 0
  Picture overlay = {};  // grey: both, red: missing, blue: extra; black: drawn strokes, green: rendered ones
};

struct SilhouetteScores {
  Fit fit = Fit::object;         // that was used
  std::vector<ViewScore> views;  // in the drawings' order
  double least_iou() const;
};

std::ostream& operator<<(std::ostream& out, const SilhouetteScores& scores);  // a line a view
std::string to_json(const SilhouetteScores& scores);

/// \throws std::invalid_argument: a mesh without triangles or extent, options out of range
SilhouetteScores silhouette_scores(const Mesh& mesh, const ViewSet& views, const SilhouetteOptions& options = {});

}  // namespace carve
