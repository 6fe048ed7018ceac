#include "carving/box_world.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace carve {
namespace {

constexpr int kFar = -1000000;

struct Hit {
  int depth = kFar;  // units towards the viewer
  Rgba colour;
};

Raster<Hit> look(const BoxWorld& world, View view) {
  const Frame f = frame(view);
  Raster<Hit> hits(world.size[f.right.axis], world.size[f.up.axis]);
  for (int j = 0; j < hits.height; ++j)
    for (int i = 0; i < hits.width; ++i) {
      Vec3i at = Vec3i::Zero();
      at[f.right.axis] = f.right.sign > 0 ? i : hits.width - 1 - i;
      at[f.up.axis] = f.up.sign > 0 ? hits.height - 1 - j : j;
      for (int d = 0; d < world.size[f.toward.axis] && hits(i, j).depth == kFar; ++d) {
        at[f.toward.axis] = f.toward.sign > 0 ? world.size[f.toward.axis] - 1 - d : d;
        for (const BoxWorld::Part& part : world.parts)
          if ((at.array() >= part.low.array()).all() && (at.array() < part.high.array()).all())
            hits(i, j) = {-d, part.colour};
      }
    }
  return hits;
}

}  // namespace

bool BoxWorld::inside(const Vec3& p) const {
  return std::ranges::any_of(parts, [&](const Part& part) {
    return (p.array() >= part.low.cast<double>().array()).all() && (p.array() < part.high.cast<double>().array()).all();
  });
}

Drawing draw(const BoxWorld& world, View view, const BoxDrawing& options) {
  const Raster<Hit> hits = look(world, view);
  const int s = options.scale, margin = 4;
  Drawing drawing;
  const int width = hits.width * s + 2 * margin, height = hits.height * s + 2 * margin;
  drawing.picture = Picture(width, height, Rgba{255, 255, 255, 255});
  drawing.labels = Raster<Label>(width, height);
  drawing.coverage = Mask(width, height);
  drawing.bounds = {width, height, 0, 0};
  const auto hit = [&](int x, int y) {
    const int i = (x - margin + s) / s - 1, j = (y - margin + s) / s - 1;
    return hits.contains(i, j) ? hits(i, j) : Hit{};
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Hit here = hit(x, y);
      if (here.depth == kFar) continue;
      bool ink = false;
      const int r = options.stroke;
      for (int dy = -r; dy <= r && !ink; ++dy)
        for (int dx = -r; dx <= r && !ink; ++dx) {
          if (std::hypot(dx, dy) > r || !hits.contains((x + dx - margin + s) / s - 1, (y + dy - margin + s) / s - 1)) {
            ink = std::hypot(dx, dy) <= r;
            continue;
          }
          const int depth = hit(x + dx, y + dy).depth;
          if (depth == kFar) ink = true;
          if (depth != here.depth && 2 * std::max(std::abs(dx), std::abs(dy)) <= r + (dx > 0 || dy > 0))
            ink = (x + y) % 24 >= options.broken;
        }
      drawing.labels(x, y) = ink ? Label::edge : Label::surface;
      drawing.picture(x, y) = ink ? Rgba{0, 0, 0, 255} : here.colour;
      drawing.coverage(x, y) = 255;
      Box& b = drawing.bounds;
      b = {std::min(b.x0, x), std::min(b.y0, y), std::max(b.x1, x + 1), std::max(b.y1, y + 1)};
    }
  drawing.border = {255, 255, 255, 255};
  drawing.background = Background::border;
  drawing.max_stroke = 2 * options.stroke;
  return drawing;
}

ViewSet views_of(const BoxWorld& world, std::span<const View> views, const BoxDrawing& options) {
  std::map<View, Drawing> drawings;
  for (const View view : views) drawings.emplace(view, draw(world, view, options));
  return align(std::move(drawings));
}

BoxWorld couch() {
  const Rgba seat{170, 60, 60, 255}, back{60, 130, 70, 255}, arm{70, 90, 180, 255};
  return {{40, 18, 20},
          {{{0, 0, 0}, {40, 8, 20}, seat},
           {{0, 0, 0}, {40, 18, 6}, back},
           {{0, 0, 0}, {6, 13, 20}, arm},
           {{34, 0, 0}, {40, 13, 20}, arm}}};
}

BoxWorld walled_stairs_world(int steps) {
  const int n = 5 * steps;
  BoxWorld world{{n + 10, n, n}, {{{0, 0, 0}, {5, n, n}}, {{n + 5, 0, 0}, {n + 10, n, n}}}};
  for (int k = 0; k < steps; ++k) world.parts.push_back({{5, 0, 0}, {n + 5, 5 * (k + 1), n - 5 * k}});
  return world;
}

BoxWorld random_pockets(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](int low, int high) { return low + static_cast<int>(random() % (high - low + 1)); };
  BoxWorld world{{36, 24, 24}, {{{0, 0, 0}, {36, uniform(3, 8), 24}}, {{0, 0, 0}, {36, 24, 3}}}};
  for (const int x : {0, 33}) world.parts.push_back({{x, 0, 0}, {x + 3, 24, 24}});
  const int ribs = uniform(0, 2);
  for (int k = 0; k < ribs; ++k) {
    const int x = 10 + 11 * k + uniform(-2, 2);
    world.parts.push_back({{x, 0, 0}, {x + 3, uniform(12, 20), 24}});
  }
  return world;
}

}  // namespace carve
