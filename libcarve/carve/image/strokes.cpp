#include <algorithm>
#include <cmath>
#include <cstring>

#include "carve/image/labelling.h"

namespace carve::labelling {
namespace {

// Everything below looks at the object's box alone; rasters have its size.

const std::uint8_t* find_value(const std::uint8_t* begin, const std::uint8_t* end, int value) {
  const void* found = begin == end ? nullptr : std::memchr(begin, value, static_cast<std::size_t>(end - begin));
  return found ? static_cast<const std::uint8_t*>(found) : end;
}

// Vertical distance of every pixel to the nearest one of value `seed` in its column, at most `far`; `beyond` says
// whether the pixels outside the raster are of that value.
Raster<std::uint16_t> column_distance(const Mask& mask, std::uint8_t seed, std::uint16_t far, bool beyond) {
  Raster<std::uint16_t> distance(mask.width, mask.height);
  std::vector<std::uint16_t> row(mask.width);
  const auto sweep = [&](int y) {
    const std::uint8_t* in = &mask(0, y);
    std::uint16_t* out = &distance(0, y);
    for (int x = 0; x < mask.width; ++x) {
      const std::uint16_t next = std::min<std::uint16_t>(row[x] + 1, far);
      row[x] = std::min(in[x] == seed ? std::uint16_t{0} : next, out[x]);
      out[x] = row[x];
    }
  };
  std::fill(distance.pixels.begin(), distance.pixels.end(), far);
  std::fill(row.begin(), row.end(), beyond ? 0 : far);
  for (int y = 0; y < mask.height; ++y) sweep(y);
  std::fill(row.begin(), row.end(), beyond ? 0 : far);
  for (int y = mask.height - 1; y >= 0; --y) sweep(y);
  return distance;
}

// 1 where a pixel equal to `seed` (0 or 1) lies within `radius` (centre to centre, Euclidean, exact): each column's
// distance says how far along the row its nearest seed reaches. Linear in the pixels, whatever the radius.
Mask within(const Mask& mask, std::uint8_t seed, double radius, bool beyond) {
  const auto far = static_cast<std::uint16_t>(radius + 1);
  std::vector<int> reach(far + 1, -1);
  for (int d = 0; d < far; ++d) reach[d] = static_cast<int>(std::sqrt(radius * radius - d * d));
  const int from_beyond = beyond ? reach[0] : -1;

  const Raster<std::uint16_t> distance = column_distance(mask, seed, far, beyond);
  Mask out(mask.width, mask.height, 1);
  for (int y = 0; y < mask.height; ++y) {
    const std::uint8_t *in = &mask(0, y), *end = in + mask.width;
    const std::uint16_t* column = &distance(0, y);
    std::uint8_t* row = &out(0, y);
    std::uint16_t nearest = far;
    for (int x = 0; x < mask.width; ++x) nearest = std::min(nearest, column[x]);
    if (nearest == far && !beyond) {
      std::fill(row, row + mask.width, 0);
      continue;
    }
    // Runs of other pixels between seeds, from both sides.
    for (const std::uint8_t* run = find_value(in, end, 1 - seed); run != end;) {
      const std::uint8_t* stop = find_value(run, end, seed);
      const int first = static_cast<int>(run - in), last = static_cast<int>(stop - in) - 1;
      int rest = first > 0 ? reach[0] : from_beyond;
      for (int x = first; x <= last; ++x) {
        rest = std::max(rest - 1, reach[column[x]]);
        row[x] = rest >= 0;
      }
      rest = last + 1 < mask.width ? reach[0] : from_beyond;
      for (int x = last; x >= first; --x) {
        rest = std::max(rest - 1, reach[column[x]]);
        row[x] |= rest >= 0;
      }
      run = find_value(stop, end, 1 - seed);
    }
  }
  return out;
}

bool any(const Mask& mask) {
  const std::uint8_t *begin = mask.pixels.data(), *end = begin + mask.pixels.size();
  return find_value(begin, end, 1) != end;
}

// The ink that is wider than max_stroke: what a disc of that width, kept inside the ink, sweeps. The disc is let grow
// by sqrt(2) on the way back so that right-angled corners of a black area belong to it. Where strokes meet they are
// wider than a stroke, too: an area is more than 3 max_stroke^2.
Mask wide_ink(const Mask& ink, double max_stroke) {
  const int radius = (static_cast<int>(max_stroke) + 1) / 2;
  Mask outer = within(ink, 0, radius, true);
  if (std::memchr(outer.pixels.data(), 0, outer.pixels.size()) == nullptr) return Mask(ink.width, ink.height);
  Mask wide = within(outer, 0, std::sqrt(2.0) * radius, false);
  for (std::size_t i = 0; i < wide.pixels.size(); ++i) wide.pixels[i] &= ink.pixels[i];
  clear_specks(wide, 1, 0, static_cast<std::size_t>(3 * max_stroke * max_stroke));
  return wide;
}

class Strokes {
 public:
  explicit Strokes(const Drawing& drawing)
      : drawing_(drawing), lightness_(drawing.bounds.width(), drawing.bounds.height(), kBackground) {
    const Box& box = drawing.bounds;
    for (int y = 0; y < lightness_.height; ++y) {
      const Rgba* pixels = &drawing.picture(box.x0, box.y0 + y);
      const std::uint8_t* coverage = &drawing.coverage(box.x0, box.y0 + y);
      std::uint8_t* lightness = &lightness_(0, y);
      for (int x = 0; x < lightness_.width; ++x) {
        if (coverage[x] < 128) continue;
        const Rgba p = coverage[x] == 255 ? pixels[x] : colour(x, y);
        lightness[x] = std::min(std::max({p.r, p.g, p.b}), kWhite);
      }
    }
  }

  // 1 = edge.
  Mask find(int level, double max_stroke) const {
    const Mask ink = ink_up_to(level);
    if (!any(ink)) return ink;
    Mask strokes = thin_ink(ink, level, max_stroke);
    if (strokes != ink) {
      // On and around a dark area, strokes show at half the level.
      const Mask blacker = thin_ink(ink_up_to(level / 2), level / 2, max_stroke);
      for (std::size_t i = 0; i < strokes.pixels.size(); ++i) strokes.pixels[i] |= blacker.pixels[i];
    }
    if (!any(strokes)) return strokes;
    Mask edges = strokes;
    Neighbourhood near_strokes(strokes, 1);
    for (int y = 0; y < ink.height; ++y) {
      const std::uint8_t* near = near_strokes.row(y);
      for (int x = 0; x < ink.width; ++x)
        if (near[x] && is_rim(x, y)) edges(x, y) = 1;
    }
    return edges;
  }

 private:
  static constexpr std::uint8_t kBackground = 255, kWhite = 254;

  Mask ink_up_to(int level) const {
    Mask ink(lightness_.width, lightness_.height);
    const std::uint8_t limit = static_cast<std::uint8_t>(std::min<int>(level, kWhite));
    std::transform(lightness_.pixels.begin(), lightness_.pixels.end(), ink.pixels.begin(),
                   [=](std::uint8_t lightness) { return lightness <= limit; });
    return ink;
  }

  // The ink, which goes up to the level, where it is thin even together with what is nearly as dark. None in a
  // silhouette.
  Mask thin_ink(const Mask& ink, int level, double max_stroke) const {
    if (is_all_black(ink)) return Mask(ink.width, ink.height);
    Mask thin = wide_ink(ink_up_to(level + level / 2), max_stroke);
    for (std::size_t i = 0; i < thin.pixels.size(); ++i) thin.pixels[i] = ink.pixels[i] & !thin.pixels[i];
    return thin;
  }

  // No colour but ink and its rim, up to 0.2 % of the object: a silhouette, solid also where it is thin.
  bool is_all_black(const Mask& ink) const {
    const auto background = std::count(lightness_.pixels.begin(), lightness_.pixels.end(), kBackground);
    const std::size_t most = (lightness_.pixels.size() - static_cast<std::size_t>(background)) / 500;
    std::size_t coloured = 0;
    Neighbourhood near_ink(ink, 1);
    for (int y = 0; y < ink.height && coloured <= most; ++y) {
      const std::uint8_t* near = near_ink.row(y);
      for (int x = 0; x < ink.width; ++x) coloured += lightness_(x, y) != kBackground && !near[x];
    }
    return coloured <= most;
  }

  // A stroke's anti-aliased rim: darker than half-way between the darkest and the brightest colour around it.
  bool is_rim(int x, int y) const {
    if (lightness_(x, y) == kBackground) return false;
    const int here = brightness(colour(x, y));
    int darkest = here, brightest = here;
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u) {
        if (!lightness_.contains(u, v) || lightness_(u, v) == kBackground) continue;
        const int there = brightness(colour(u, v));
        darkest = std::min(darkest, there);
        brightest = std::max(brightest, there);
      }
    return 2 * here < darkest + brightest;
  }

  // The object's colour where it covers a pixel together with paper.
  Rgba colour(int x, int y) const {
    const int u = drawing_.bounds.x0 + x, v = drawing_.bounds.y0 + y;
    const int share = drawing_.coverage(u, v);
    const Rgba mixed = drawing_.picture(u, v), paper = drawing_.border;
    if (share == 255 || paper.a == 0) return mixed;
    const auto pure = [=](int c, int p) {
      return static_cast<std::uint8_t>(std::clamp(p + (c - p) * 255 / share, 0, 255));
    };
    return {pure(mixed.r, paper.r), pure(mixed.g, paper.g), pure(mixed.b, paper.b), 255};
  }

  const Drawing& drawing_;
  Mask lightness_;  // the lightest channel up to kWhite, or kBackground; of drawing.bounds
};

}  // namespace

void label_strokes(Drawing& drawing, int ink) {
  const Mask edges = Strokes(drawing).find(ink, drawing.max_stroke);
  for (int y = 0; y < edges.height; ++y)
    for (int x = 0; x < edges.width; ++x)
      if (edges(x, y)) drawing.labels(drawing.bounds.x0 + x, drawing.bounds.y0 + y) = Label::edge;
}

}  // namespace carve::labelling
