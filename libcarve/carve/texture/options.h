#pragma once
#include <span>

namespace carve {

enum class TextureArm {
  automatic,  // best_view where the result is written to a format that holds a texture, else none
  none,
  blend,     // Equations 3.9 and 3.10: drawings mixed by the triangle's normal
  best_view  // each triangle takes one drawing
};
inline std::span<const char* const> names(TextureArm) {
  static constexpr const char* all[] = {"auto", "none", "blend", "best_view"};
  return all;
}

/// Whether a side that no drawing shows takes the drawing of the side across.
enum class Mirror {
  automatic,  // left from side (or side from left) if the drawings are symmetric; all others where the object is thin
  yes,        // wherever the side across was drawn
  no
};
inline std::span<const char* const> names(Mirror) {
  static constexpr const char* all[] = {"auto", "yes", "no"};
  return all;
}

struct TextureOptions {
  TextureArm arm = TextureArm::automatic;
  Mirror mirror = Mirror::automatic;
  bool inpaint = true;
  int fringe = 1;
  double agree = 20;
  double seam = 0.003;
  double steepest = 84;
  double thin = 0.06;
  double level = 32;
};
template <class Visitor>
void visit_fields(TextureOptions& o, Visitor&& field) {
  field("arm", o.arm, "where the colours come from: blend as the thesis has it, best_view without ghosts");
  field("mirror", o.mirror, "whether sides that were not drawn take the drawing of the side across");
  field("inpaint", o.inpaint, "strokes and rims give way to the colours beside them");
  field("fringe", o.fringe, 0, 16, "width of the rim beside strokes and background that is not trusted, pixels");
  field("agree", o.agree, 0.0, 100.0,
        "how much it counts that the drawing taken agrees with the others that see a triangle");
  field("seam", o.seam, 0.0, 1.0, "cost of a seam's length against the area that is seen at an angle, object units");
  field("steepest", o.steepest, 60.0, 89.0, "largest angle at which a drawing still colours a triangle, degrees");
  field("thin", o.thin, 0.0, 1.0, "how thick a part may be whose back takes the drawing of its front, object units");
  field("level", o.level, 0.0, 442.0, "largest difference of colour across a seam that is levelled, RGB distance");
}

enum class AtlasArm {
  view_charts,  // a chart = connected triangles that take the same drawing, laid out as drawn
  clusters      // charts by planarity and compactness, unfolded: the thesis's
};
inline std::span<const char* const> names(AtlasArm) {
  static constexpr const char* all[] = {"view_charts", "clusters"};
  return all;
}

struct AtlasOptions {
  AtlasArm arm = AtlasArm::view_charts;
  int size = 1024;
  int gutter = 4;
  bool exact = true;
  double max_distortion = 0.02;
  int max_clusters = 120;
};
template <class Visitor>
void visit_fields(AtlasOptions& o, Visitor&& field) {
  field("arm", o.arm, "how the surface is cut into charts");
  field("size", o.size, 16, 8192, "texels along the texture's side");
  field("gutter", o.gutter, 1, 64, "least texels between two charts");
  field("exact", o.exact, "a texel is a pixel of the drawing, or a whole part of one, where the charts fit so");
  field("max_distortion", o.max_distortion, 1e-4, 1.0,
        "clusters: largest root mean square distance of a chart from its plane, object units");
  field("max_clusters", o.max_clusters, 1, 100000,
        "clusters: charts are joined until there are so few, as far as max_distortion lets them");
}

}  // namespace carve
