#include <algorithm>
#include <array>
#include <bit>

#include "carve/image/labelling.h"

namespace carve::labelling {
namespace {

constexpr Rgba kWhite{255, 255, 255, 255};

// More than 2 % of the border, or of the whole, is transparent: fewer are rounded corners and accidents.
bool is_cut_out(const Picture& picture) {
  std::size_t border = 0, transparent = 0;
  for_each_border_pixel(picture.width, picture.height, [&](int x, int y) {
    ++border;
    transparent += is_transparent(picture(x, y));
  });
  if (50 * transparent > border) return true;
  const auto all = std::count_if(picture.pixels.begin(), picture.pixels.end(), is_transparent);
  return 50 * static_cast<std::size_t>(all) > picture.pixels.size();
}

// The most frequent colour of the outermost pixels: the fullest cube of 16 levels a side, then the median of the pixels
// in it. An object may touch the border along less than the paper does.
Rgba border_colour(const Picture& picture) {
  constexpr int kBins = 33;  // 8 levels each; a cube is 2 x 2 x 2 of them
  std::vector<int> histogram(kBins * kBins * kBins, 0);
  const auto bin = [](int r, int g, int b) { return (r * kBins + g) * kBins + b; };
  for_each_border_pixel(picture.width, picture.height, [&](int x, int y) {
    const Rgba p = picture(x, y);
    if (is_transparent(p)) return;
    for (int i = 0; i < 8; ++i) ++histogram[bin(p.r / 8 + (i & 1), p.g / 8 + (i >> 1 & 1), p.b / 8 + (i >> 2))];
  });
  const auto fullest = std::max_element(histogram.begin(), histogram.end());
  if (*fullest == 0) return kWhite;
  const int index = static_cast<int>(fullest - histogram.begin());
  const int r = index / kBins / kBins, g = index / kBins % kBins, b = index % kBins;

  std::array<std::array<int, 256>, 3> counts{};
  int members = 0;
  const auto in = [](int value, int high_bin) { return value / 8 == high_bin || value / 8 == high_bin - 1; };
  for_each_border_pixel(picture.width, picture.height, [&](int x, int y) {
    const Rgba p = picture(x, y);
    if (is_transparent(p) || !in(p.r, r) || !in(p.g, g) || !in(p.b, b)) return;
    ++members;
    ++counts[0][p.r], ++counts[1][p.g], ++counts[2][p.b];
  });
  const auto median = [&](const std::array<int, 256>& count) {
    int value = 0;
    for (int below = 0; 2 * (below + count[value]) < members; ++value) below += count[value];
    return static_cast<std::uint8_t>(value);
  };
  return {median(counts[0]), median(counts[1]), median(counts[2]), 255};
}

Mask transparency(const Picture& picture) {
  Mask paper(picture.width, picture.height);
  std::transform(picture.pixels.begin(), picture.pixels.end(), paper.pixels.begin(), is_transparent);
  return paper;
}

// Object, paper (as `enclosed`), and `faint` up to kFaint times the tolerance.
Mask places_by_colour(const Picture& picture, Rgba colour, double tolerance) {
  const int paper = static_cast<int>(tolerance * tolerance), weak = kFaint * kFaint * paper;
  const auto place_of = [=](Rgba p) {
    if (is_transparent(p)) return enclosed;
    const int distance = distance2(over(p, colour), colour);
    return distance <= paper ? enclosed : distance <= weak ? faint : object;
  };
  Mask places(picture.width, picture.height);
  Rgba last = picture.pixels[0];
  Place place = place_of(last);
  for (std::size_t i = 0; i < places.pixels.size(); ++i) {
    if (!same(picture.pixels[i], last))
      place = place_of(last = picture.pixels[i]);  // drawings have long runs of a colour
    places.pixels[i] = place;
  }
  return places;
}

// Strokes on a transparent sheet, nothing filled in: what they enclose is as transparent as the background, yet means
// the object. Black silhouettes with holes are told from that by being wider than strokes.
bool is_transparent_line_art(const Picture& picture, Mask& places, double max_stroke) {
  std::size_t opaque = 0, dark = 0;
  for (const Rgba p : picture.pixels) {
    opaque += !is_transparent(p);
    dark += !is_transparent(p) && std::max({p.r, p.g, p.b}) <= 64;
  }
  if (10 * dark <= 8 * opaque) return false;
  flood_from_border(places);
  return share_of_enclosed_paper(picture, places, kWhite, max_stroke + 1) > 0.8;
}

Ground ground_of(Background rule, Rgba colour, Mask places, bool lossy = false) {
  const int lowest = rule == Background::flood ? outside : enclosed;
  for (std::uint8_t& place : places.pixels) place = place >= lowest;
  return {rule, colour, std::move(places), lossy};
}

}  // namespace

Ground find_ground(const Picture& picture, const DrawingOptions& options, double max_stroke) {
  Background rule = options.background;
  const bool automatic = rule == Background::automatic;
  if (rule == Background::alpha || (automatic && is_cut_out(picture))) {
    Mask places = transparency(picture);
    const bool line_art = automatic && is_transparent_line_art(picture, places, max_stroke);
    return ground_of(line_art ? Background::flood : Background::alpha, {0, 0, 0, 0}, std::move(places));
  }
  const Rgba colour = border_colour(picture);
  Mask places = places_by_colour(picture, colour, options.tolerance);
  const bool lossy = has_ripples(picture, places);
  if (lossy) {
    clear_noise(places);
  } else {
    replace(places, faint, object);
    flood_from_border(places);
  }
  if (automatic) {
    // White-filled line art comes to about 1, coloured objects with strokes to 0, holes or not; in between are drawings
    // with some white parts, which the border rule would cut away.
    const bool line_art = share_of_enclosed_paper(picture, places, colour, max_stroke + 4) > 0.25;
    rule = line_art ? Background::flood : Background::border;
  }
  return ground_of(rule, colour, std::move(places), lossy);
}

}  // namespace carve::labelling
