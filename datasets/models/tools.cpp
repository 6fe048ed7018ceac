// Things that are held in a hand.
#include <cmath>

#include "models/primitives.h"
#include "models/procedural.h"

namespace carve {
namespace {

constexpr Rgba kSteel{178, 188, 198}, kIron{120, 128, 140}, kAsh{168, 116, 70}, kLeather{110, 74, 66};

}  // namespace

// A bearded axe standing on its handle, its broad side to the front; the edge is thin, the eye thick.
Model axe() {
  Model model;
  // The cheek, cut into slices along x that get thinner towards the edge.
  const double x[] = {-0.16, -0.08, 0.06, 0.16, 0.28, 0.36, 0.40};
  const double top[] = {0.93, 0.95, 0.95, 0.955, 0.99, 1.03, 1.05};
  const double bottom[] = {0.80, 0.78, 0.78, 0.75, 0.66, 0.58, 0.55};
  const double thick[] = {0.055, 0.07, 0.07, 0.045, 0.028, 0.014, 0.003};
  std::vector<Section> sections;
  for (int i = 0; i < 7; ++i)
    sections.push_back({{x[i], (top[i] + bottom[i]) / 2, 0}, (top[i] - bottom[i]) / 2, thick[i], 6});
  std::vector<Section> cheek(sections.begin(), sections.begin() + 6), edge(sections.begin() + 5, sections.end());
  add(model, "iron", kIron, body(cheek, 0, 64));
  edge.front().centre.x() -= 0.012;
  edge.front().a -= 0.002;
  edge.front().b += 0.0035;
  add(model, "steel", kSteel, body(edge, 0, 64));
  // The handle: an oval, swept along a slightly swung line, with a grip and a knob.
  const auto handle = [](double from, double to, double grow) {
    std::vector<Section> line;
    for (int i = 0; i <= 24; ++i) {
      const double y = from + (to - from) * i / 24;
      const double swing = -0.03 * std::sin(3.1 * y), knob = y < 0.06 ? 0.012 * (1 - y / 0.06) : 0;
      line.push_back({{swing - 0.005, y, 0}, 0.030 + knob + grow, 0.040 + knob + grow, 2});
    }
    return body(line, 1, 40);
  };
  add(model, "wood", kAsh, handle(0, 1.0, 0));
  add(model, "leather", kLeather, handle(0.10, 0.30, 0.006));
  return placed(std::move(model));
}

}  // namespace carve
