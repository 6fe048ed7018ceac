#pragma once
// Internal to carve/image: the three steps of understand_drawing.
#include <bit>
#include <utility>
#include <vector>

#include "carve/image/drawing.h"

namespace carve::labelling {

/// Squared RGB distance.
inline int distance2(Rgba a, Rgba b) {
  const int r = a.r - b.r, g = a.g - b.g, z = a.b - b.b;
  return r * r + g * g + z * z;
}

inline int brightness(Rgba p) { return p.r + p.g + p.b; }

/// The colour seen where `pixel` lies on paper of colour `paper`.
inline Rgba over(Rgba pixel, Rgba paper) {
  if (pixel.a == 255) return pixel;
  const auto mix = [&](int above, int below) {
    return static_cast<std::uint8_t>((above * pixel.a + below * (255 - pixel.a) + 127) / 255);
  };
  return {mix(pixel.r, paper.r), mix(pixel.g, paper.g), mix(pixel.b, paper.b), 255};
}

inline bool same(Rgba a, Rgba b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
inline bool is_transparent(Rgba pixel) { return pixel.a < 128; }

/// What a pixel is while the background is looked for: `enclosed` and `outside` are paper, `faint` is nearly.
enum Place : std::uint8_t { object, enclosed, outside, faint, seen };
inline constexpr int kFaint = 4;  // up to this many times the tolerance

/// Turns connected pixels of one value into another and counts them: a span at a time, with a stack of its own, so that
/// neither a large sheet nor a spiral needs recursion.
class Flood {
 public:
  enum Connection { sides = 0, corners = 1 };  // 4 or 8 neighbours
  explicit Flood(Mask& places, Connection connection = sides) : places_(places), reach_(connection) {}
  std::size_t operator()(int x, int y, std::uint8_t from, std::uint8_t to);

 private:
  void push_runs(int first, int last, int y, std::uint8_t value);

  Mask& places_;
  int reach_;
  std::vector<std::pair<int, int>> seeds_;
};
/// Paper that a path leads to from the picture's border becomes `outside`.
void flood_from_border(Mask& places);
/// Calls visit(x, y) once for each of the outermost pixels.
template <class Visit>
void for_each_border_pixel(int width, int height, Visit&& visit) {
  for (int x = 0; x < width; ++x) visit(x, 0);
  for (int y = 1; y + 1 < height; ++y) {
    visit(0, y);
    if (width > 1) visit(width - 1, y);
  }
  if (height > 1)
    for (int x = 0; x < width; ++x) visit(x, height - 1);
}
void replace(Mask& mask, std::uint8_t from, std::uint8_t to);
/// Pixels of value `from` become `to` where no more than `largest` of them hang together by sides or corners.
void clear_specks(Mask& mask, std::uint8_t from, std::uint8_t to, std::size_t largest);
inline constexpr std::size_t kLargestSpeck = 12;  // pixels; in lossy drawings, smaller things are noise

/// Whether the picture comes from a lossy format; `places` has object, enclosed and faint.
bool has_ripples(const Picture& picture, const Mask& places);
/// Takes a lossy format's noise out of `places`, which then has object, enclosed and outside.
void clear_noise(Mask& places);

/// Tells white-filled line art (1) from coloured objects with holes (0): the share of the silhouette behind whose
/// stroke, at most `widest_stroke` pixels, lies enclosed paper instead of the object's own colour.
double share_of_enclosed_paper(const Picture& picture, const Mask& places, Rgba paper, double widest_stroke);

/// Where the background is, before the borders are looked at closely.
struct Ground {
  Background rule;     // alpha, border or flood
  Rgba colour;         // of the background; alpha 0 where it is transparency
  Mask background;     // 1 = background
  bool lossy = false;  // the picture comes from a lossy format
};
Ground find_ground(const Picture& picture, const DrawingOptions& options, double max_stroke);

/// Drawing::coverage from the ground.
Mask estimate_coverage(const Picture& picture, const Ground& ground);

/// Turns `surface` labels into `edge` where strokes are; all else of the drawing is there already.
void label_strokes(Drawing& drawing, int ink);

/// Per row, where a pixel of a mask within `radius` columns and rows is set; pixels outside the mask are not.
class Neighbourhood {
 public:
  Neighbourhood(const Mask& mask, int radius);
  const std::uint8_t* row(int y);  // valid until the next call

 private:
  const Mask& mask_;
  int radius_;
  std::vector<std::uint8_t> columns_, near_;
};

}  // namespace carve::labelling
