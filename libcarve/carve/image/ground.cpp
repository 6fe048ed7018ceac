#include <algorithm>
#include <array>

#include "carve/image/labelling.h"

namespace carve::labelling {
namespace {

// What a pixel is while the ground is looked for.
enum Place : std::uint8_t { object = 0, enclosed = 1, outside = 2 };  // the last two: paper

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

bool is_transparent(Rgba pixel) { return pixel.a < 128; }

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
  if (*fullest == 0) return {255, 255, 255, 255};
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

Mask paper_of_colour(const Picture& picture, Rgba colour, double tolerance) {
  Mask paper(picture.width, picture.height);
  const int limit = static_cast<int>(tolerance * tolerance);
  std::transform(picture.pixels.begin(), picture.pixels.end(), paper.pixels.begin(),
                 [=](Rgba p) { return is_transparent(p) || distance2(over(p, colour), colour) <= limit; });
  return paper;
}

Mask transparency(const Picture& picture) {
  Mask paper(picture.width, picture.height);
  std::transform(picture.pixels.begin(), picture.pixels.end(), paper.pixels.begin(), is_transparent);
  return paper;
}

// Turns `enclosed` into `outside` wherever a 4-connected path of paper leads to the border: a span at a time, with a
// stack of its own, so that neither a large sheet nor a spiral needs recursion.
void flood_from_border(Mask& places) {
  const int width = places.width, height = places.height;
  std::vector<std::pair<int, int>> seeds;
  const auto fill = [&] {
    while (!seeds.empty()) {
      const auto [x, y] = seeds.back();
      seeds.pop_back();
      std::uint8_t* row = &places(0, y);
      if (row[x] != enclosed) continue;
      int first = x, last = x;
      while (first > 0 && row[first - 1] == enclosed) --first;
      while (last + 1 < width && row[last + 1] == enclosed) ++last;
      std::fill(row + first, row + last + 1, outside);
      for (const int next : {y - 1, y + 1}) {
        if (next < 0 || next >= height) continue;
        const std::uint8_t* beside = &places(0, next);
        for (int i = first; i <= last; ++i)
          if (beside[i] == enclosed && (i == first || beside[i - 1] != enclosed)) seeds.emplace_back(i, next);
      }
    }
  };
  for_each_border_pixel(width, height, [&](int x, int y) {
    if (places(x, y) != enclosed) return;
    seeds.emplace_back(x, y);
    fill();
  });
}

// Tells white-filled line art from a coloured object with holes: walking in from outside along rows and columns, what
// comes first behind the outer stroke, enclosed paper or the object's own colour?
class OuterStrokes {
 public:
  OuterStrokes(const Picture& picture, const Mask& places, Rgba paper, double max_stroke)
      : picture_(picture), places_(places), paper_(paper), widest_(static_cast<int>(max_stroke) + 4) {}

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
    const bool solid = run.length > widest_ || 3 * run.coloured > run.length;
    if (solid)
      solid_ += (run.before == outside) + (after == outside);
    else
      behind_stroke_ += (run.before == outside && after == enclosed) || (run.before == enclosed && after == outside);
  }

  const Picture& picture_;
  const Mask& places_;
  const Rgba paper_;
  const int widest_;
  std::size_t behind_stroke_ = 0, solid_ = 0;
};

}  // namespace

Ground find_ground(const Picture& picture, const DrawingOptions& options, double max_stroke) {
  Background rule = options.background;
  if (rule == Background::alpha || (rule == Background::automatic && is_cut_out(picture)))
    return {Background::alpha, {0, 0, 0, 0}, transparency(picture)};

  const Rgba colour = border_colour(picture);
  Mask places = paper_of_colour(picture, colour, options.tolerance);
  if (rule == Background::border) return {rule, colour, std::move(places)};
  flood_from_border(places);
  if (rule == Background::automatic) {
    const bool has_enclosed = std::find(places.pixels.begin(), places.pixels.end(), enclosed) != places.pixels.end();
    const bool line_art = has_enclosed && OuterStrokes(picture, places, colour, max_stroke).share_of_paper() > 0.25;
    rule = line_art ? Background::flood : Background::border;
  }
  const int lowest = rule == Background::flood ? outside : enclosed;
  for (std::uint8_t& place : places.pixels) place = place >= lowest;
  return {rule, colour, std::move(places)};
}

}  // namespace carve::labelling
