#include <algorithm>

#include "carve/image/labelling.h"

namespace carve::labelling {
namespace {

// Tells white-filled line art from a coloured object with holes: walking in from outside along rows and columns, what
// comes first behind the outer stroke, enclosed paper or the object's own colour?
class OuterStrokes {
 public:
  OuterStrokes(const Picture& picture, const Mask& places, Rgba paper, double widest)
      : picture_(picture), places_(places), paper_(paper), widest_(static_cast<int>(widest)) {}

  // Share of the silhouette behind whose stroke the paper shows, 0 to 1.
  double share_of_paper() {
    std::vector<Run> columns(picture_.width);
    for (int y = 0; y < picture_.height; ++y) {
      Run row;
      for (int x = 0; x < picture_.width; ++x) {
        const Place place = static_cast<Place>(places_(x, y));
        const bool coloured = place == object && !is_stroke_colour(picture_(x, y));
        step(row, place, coloured);
        step(columns[x], place, coloured);
      }
      end(row);
    }
    for (Run& column : columns) end(column);
    return behind_stroke_ == 0 ? 0 : static_cast<double>(behind_stroke_) / static_cast<double>(behind_stroke_ + solid_);
  }

 private:
  // A stretch of object pixels within a row or a column.
  struct Run {
    Place before = object;  // object: the picture's border
    int length = 0, coloured = 0;
  };

  // Paper darkened by black ink, so that anti-aliased strokes count; chroma up to 48 is noise.
  bool is_stroke_colour(Rgba pixel) const {
    const Rgba c = over(pixel, paper_);
    const auto darker = [](int a, int b) { return a * 255 / std::max(b, 1); };
    const int r = darker(c.r, paper_.r), g = darker(c.g, paper_.g), b = darker(c.b, paper_.b);
    return std::max({r, g, b}) - std::min({r, g, b}) <= 48;
  }

  void step(Run& run, Place place, bool coloured) {
    if (place == object) {
      ++run.length;
      run.coloured += coloured;
    } else {
      if (run.length > 0) count(run, place);
      run = {place, 0, 0};
    }
  }
  void end(const Run& run) {
    if (run.length > 0) count(run, object);
  }
  void count(const Run& run, Place after) {
    // A stroke crossed at a slant is longer than wide: up to twice is left undecided.
    if (run.length > 2 * widest_ || 3 * run.coloured > run.length)
      solid_ += (run.before == outside) + (after == outside);
    else if (run.length <= widest_)
      behind_stroke_ += (run.before == outside && after == enclosed) || (run.before == enclosed && after == outside);
  }

  const Picture& picture_;
  const Mask& places_;
  const Rgba paper_;
  const int widest_;
  std::size_t behind_stroke_ = 0, solid_ = 0;
};

}  // namespace

double share_of_enclosed_paper(const Picture& picture, const Mask& places, Rgba paper, double widest_stroke) {
  const bool any = std::find(places.pixels.begin(), places.pixels.end(), enclosed) != places.pixels.end();
  return any ? OuterStrokes(picture, places, paper, widest_stroke).share_of_paper() : 0;
}

}  // namespace carve::labelling
