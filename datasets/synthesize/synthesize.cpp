#include "synthesize/synthesize.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "synthesize/view_samples.h"

namespace carve {
namespace {

// A drawing before its strokes are put on: the flat colours with the share of the pixel that is covered, and the share
// of that which is ink.
struct Layers {
  Picture surface;
  Raster<std::uint8_t> ink;
};

std::vector<View> views_of(const std::vector<std::string>& wanted) {
  std::vector<View> views;
  for (const std::string& text : wanted) {
    const auto found = std::find_if(kViews.begin(), kViews.end(), [&](View view) { return text == name(view); });
    if (found == kViews.end())
      throw std::invalid_argument("views must be of front|side|top|back|left|bottom, got " + text);
    views.push_back(*found);
  }
  if (views.empty()) throw std::invalid_argument("views must be of front|side|top|back|left|bottom, got nothing");
  return views;
}

// Alpha 0: transparent.
Rgba background_of(const std::string& text) {
  if (text == "transparent") return {255, 255, 255, 0};
  if (text == "white") return {255, 255, 255, 255};
  unsigned value = 0;
  const char* end = text.data() + text.size();
  if (text.size() != 7 || text[0] != '#' || std::from_chars(text.data() + 1, end, value, 16).ptr != end)
    throw std::invalid_argument("background must be transparent, white or #rrggbb, got " + text);
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255),
          static_cast<std::uint8_t>(value & 255), 255};
}

// Where object coordinates lie in a view's picture, in pixels.
Placement placement(const Vec3& size, View view, const SynthesizeOptions& options, const DegradeOptions& degrade) {
  const Misplacement wrong = misplacement(view, degrade);
  // An even number of pixels, so that the box's longest side ends between two of them.
  const double longest = 2 * std::floor(options.size * (1 - 2 * options.margin / 100) / 2);
  const double scale = longest * wrong.scale;
  const Frame f = frame(view);
  const double width = size[f.right.axis] * scale, height = size[f.up.axis] * scale;
  if (width + 2 * std::abs(wrong.right) > options.size || height + 2 * std::abs(wrong.down) > options.size)
    throw std::invalid_argument("degrade.shift and degrade.rescale must leave the object inside the picture: margin " +
                                std::to_string(options.margin) + " % is too small for the " + name(view) + " view");
  return {scale, options.size / 2.0 + wrong.right, options.size / 2.0 + wrong.down};
}

std::uint8_t share(double part, double whole) { return static_cast<std::uint8_t>(std::lround(255 * part / whole)); }

// The rows [first, last) of the picture, from samples that reach `halo` rows beyond.
void draw_rows(const ViewSampler& sampler, const StrokeRule& rule, int darkest, int first, int last, Layers& layers) {
  const int s = rule.samples, width = layers.surface.width;
  const int halo = static_cast<int>(std::ceil(rule.reach())) + 1;
  const SampleBlock block = sampler.sample((first - halo) * s, (last + halo) * s, width * s);
  const Mask ink = strokes(sampler, block, rule);
  for (int y = first; y < last; ++y)
    for (int x = 0; x < width; ++x) {
      double r = 0, g = 0, b = 0;
      int covered = 0, black = 0;
      for (int j = (y - first + halo) * s; j < (y - first + halo + 1) * s; ++j)
        for (int i = x * s; i < (x + 1) * s; ++i) {
          if (!block.hit(i, j)) continue;
          const Rgba& c = block.colour(i, j);
          r += c.r, g += c.g, b += c.b;
          ++covered;
          black += ink(i, j);
        }
      if (!covered) continue;
      // The lightest channel comes up to `darkest`, the others by as much.
      const double lift = std::max(0.0, darkest - std::max({r, g, b}) / covered);
      const auto mean = [&](double sum) { return static_cast<std::uint8_t>(std::lround(sum / covered + lift)); };
      layers.surface(x, y) = {mean(r), mean(g), mean(b), share(covered, s * s)};
      layers.ink(x, y) = share(black, covered);
    }
}

Picture composed(const Layers& layers, const Rgba& background) {
  Picture picture(layers.surface.width, layers.surface.height, background);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const Rgba& c = layers.surface.pixels[i];
    if (c.a == 0) continue;
    const double light = 1 - layers.ink.pixels[i] / 255.0, over = background.a == 0 ? 1 : c.a / 255.0;
    const auto channel = [&](int surface, int behind) {
      return static_cast<std::uint8_t>(std::lround(surface * light * over + behind * (1 - over)));
    };
    picture.pixels[i] = {channel(c.r, background.r), channel(c.g, background.g), channel(c.b, background.b),
                         background.a == 0 ? c.a : std::uint8_t{255}};
  }
  return picture;
}

}  // namespace

std::map<View, Picture> synthesize(const Model& model, const SynthesizeOptions& options,
                                   const DegradeOptions& degrade) {
  check("", options);
  check("degrade", degrade);
  const std::vector<View> views = views_of(options.views);
  const Rgba background = background_of(options.background);
  if (model.mesh.triangles.empty()) throw std::invalid_argument("a model must have triangles, got none");
  const Model object = placed(model);
  const auto [low, high] = bounds(object.mesh);
  const Vec3 size = high - low;
  const RayScene scene(object.mesh);

  std::map<View, Picture> drawings;
  for (const View view : views) {
    const Placement place = placement(size, view, options, degrade);
    const ViewSampler sampler(object, scene, view, place, options.samples);
    StrokeRule rule{options.samples, options.stroke, options.jump / 100 * size.norm(), options.crease};
    rule.waver = [&](double x, double y) { return waver(x, y, view, degrade); };
    rule.largest_waver = degrade.jitter * std::sqrt(2.0);
    Layers layers{Picture(options.size, options.size, {0, 0, 0, 0}), Raster<std::uint8_t>(options.size, options.size)};
    // Bands of about a million samples bound the memory; they do not depend on the threads.
    const int rows = std::clamp((1 << 20) / (options.size * options.samples * options.samples), 16, 32);
    parallel_ranges(0, (options.size + rows - 1) / rows, 1, [&](int first, int last) {
      for (int band = first; band < last; ++band)
        draw_rows(sampler, rule, options.darkest, band * rows, std::min((band + 1) * rows, options.size), layers);
    });
    rub_out(layers.ink, options.stroke, view, degrade);
    drawings[view] = reproduce(composed(layers, background), view, degrade);
  }
  return drawings;
}

}  // namespace carve
