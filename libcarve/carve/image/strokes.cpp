#include <algorithm>
#include <cmath>

#include "carve/image/labelling.h"

namespace carve::labelling {
namespace {

// 1 where a pixel equal to `seed` lies within `radius` (centre to centre, Euclidean, exact); `beyond` says whether the
// pixels outside the raster are such. Linear: distances along the columns, then per row how far each of them reaches.
Mask within(const Mask& mask, std::uint8_t seed, double radius, bool beyond) {
  const int width = mask.width, height = mask.height;
  const int far = static_cast<int>(radius) + 1;
  std::vector<int> reach(far + 1, -1);  // along the row, from a column whose nearest seed is this far
  for (int d = 0; d < far; ++d) reach[d] = static_cast<int>(std::sqrt(radius * radius - d * d));

  Raster<std::uint16_t> above(width, height);
  std::vector<int> distance(width, beyond ? 0 : far);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      distance[x] = mask(x, y) == seed ? 0 : std::min(distance[x] + 1, far);
      above(x, y) = static_cast<std::uint16_t>(distance[x]);
    }

  Mask out(width, height);
  std::fill(distance.begin(), distance.end(), beyond ? 0 : far);
  for (int y = height - 1; y >= 0; --y) {
    std::uint8_t* row = &out(0, y);
    int rest = beyond ? static_cast<int>(radius) : -1;
    for (int x = 0; x < width; ++x) {
      distance[x] = mask(x, y) == seed ? 0 : std::min(distance[x] + 1, far);
      rest = std::max(rest - 1, reach[std::min<int>(distance[x], above(x, y))]);
      row[x] = rest >= 0;
    }
    rest = beyond ? static_cast<int>(radius) : -1;
    for (int x = width - 1; x >= 0; --x) {
      rest = std::max(rest - 1, reach[std::min<int>(distance[x], above(x, y))]);
      row[x] |= rest >= 0;
    }
  }
  return out;
}

// The ink that is wider than max_stroke: what a disc of that width, kept inside the ink, sweeps. The disc is let grow
// by sqrt(2) on the way back so that right-angled corners of a black area belong to it.
Mask wide_ink(const Mask& ink, double max_stroke) {
  const int radius = (static_cast<int>(max_stroke) + 1) / 2;
  Mask core = within(ink, 0, radius, true);
  if (std::find(core.pixels.begin(), core.pixels.end(), 0) == core.pixels.end()) return Mask(ink.width, ink.height);
  Mask wide = within(core, 0, std::sqrt(2.0) * radius, false);
  for (std::size_t i = 0; i < wide.pixels.size(); ++i) wide.pixels[i] &= ink.pixels[i];
  return wide;
}

int brightness(Rgba p) { return p.r + p.g + p.b; }

// A stroke's anti-aliased rim: darker than half-way between the darkest and the brightest colour around it.
bool is_rim(const Picture& picture, const Raster<Label>& labels, int x, int y) {
  int darkest = 3 * 255, brightest = 0;
  for (int v = std::max(0, y - 1); v <= std::min(picture.height - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(picture.width - 1, x + 1); ++u) {
      if (labels(u, v) == Label::background) continue;
      darkest = std::min(darkest, brightness(picture(u, v)));
      brightest = std::max(brightest, brightness(picture(u, v)));
    }
  return 2 * brightness(picture(x, y)) <= darkest + brightest;
}

// No colour but ink and its rim, up to 0.2 % of the object: a silhouette, solid also where it is thin.
bool is_all_black(const Raster<Label>& labels, const Mask& ink) {
  std::size_t objects = 0, coloured = 0;
  std::vector<std::uint8_t> near;
  for (int y = 0; y < labels.height; ++y) {
    near_row(ink, y, 1, near);
    for (int x = 0; x < labels.width; ++x) {
      objects += labels(x, y) != Label::background;
      coloured += labels(x, y) != Label::background && !near[x];
    }
  }
  return 500 * coloured <= objects;
}

}  // namespace

void label_strokes(const Picture& picture, int ink_level, double max_stroke, Raster<Label>& labels) {
  Mask ink(picture.width, picture.height);
  bool any = false;
  for (std::size_t i = 0; i < ink.pixels.size(); ++i) {
    const Rgba p = picture.pixels[i];
    ink.pixels[i] = labels.pixels[i] != Label::background && std::max({p.r, p.g, p.b}) <= ink_level;
    any |= ink.pixels[i];
  }
  if (!any || is_all_black(labels, ink)) return;

  const Mask wide = wide_ink(ink, max_stroke);
  for (std::size_t i = 0; i < ink.pixels.size(); ++i) ink.pixels[i] &= !wide.pixels[i];  // the strokes
  std::vector<std::uint8_t> near;
  for (int y = 0; y < picture.height; ++y) {
    near_row(ink, y, 1, near);
    for (int x = 0; x < picture.width; ++x)
      if (ink(x, y) || (near[x] && labels(x, y) != Label::background && !wide(x, y) && is_rim(picture, labels, x, y)))
        labels(x, y) = Label::edge;
  }
}

}  // namespace carve::labelling
