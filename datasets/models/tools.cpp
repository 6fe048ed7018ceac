// Things that are held in a hand.
#include <cmath>

#include "models/primitives.h"
#include "models/procedural.h"

namespace carve {
namespace {

constexpr Rgba kSteel{178, 188, 198}, kIron{120, 128, 140}, kAsh{168, 116, 70}, kLeather{110, 74, 66},
    kGun{92, 96, 106};

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

// A pistol that points at the viewer of the front drawing; its broad side is the side view.
Model handgun() {
  Model model;
  add(model, "slide", kSteel, rounded_box({-0.062, 0.62, -0.46}, {0.062, 0.80, 0.52}, 0.02));
  add(model, "frame", kGun, rounded_box({-0.056, 0.52, -0.43}, {0.056, 0.64, 0.44}, 0.015));
  add(model, "barrel", kIron, cylinder({0, 0.71, 0.5}, {0, 0.71, 0.545}, 0.042));
  add(model, "bore", kGun, cylinder({0, 0.71, 0.51}, {0, 0.71, 0.55}, 0.022));
  const Vec2 grip[] = {{0.56, -0.42}, {0.56, -0.12}, {0.40, -0.16}, {0.03, -0.27},
                       {0.0, -0.30},  {0.0, -0.55},  {0.05, -0.57}, {0.42, -0.44}};
  add(model, "frame", kGun, prism(grip, 0, -0.05, 0.05));
  const Vec2 panel[] = {{0.47, -0.395}, {0.47, -0.19}, {0.06, -0.295}, {0.06, -0.53}};
  add(model, "panel", kAsh, prism(panel, 0, -0.068, 0.068));
  const Vec3 guard[] = {{0, 0.53, 0.16}, {0, 0.42, 0.155}, {0, 0.36, 0.08}, {0, 0.355, -0.05}, {0, 0.38, -0.16}};
  const std::vector<Vec3> path = curve(guard, 8);
  add(model, "frame", kGun, tube(path, std::vector<double>(path.size(), 0.024), 24));
  const Vec3 trigger[] = {{0, 0.54, -0.02}, {0, 0.47, 0.0}, {0, 0.41, 0.035}};
  const std::vector<Vec3> pull = curve(trigger, 8);
  add(model, "trigger", kIron, tube(pull, std::vector<double>(pull.size(), 0.018), 24));
  add(model, "sight", kGun, box({-0.012, 0.79, 0.43}, {0.012, 0.83, 0.48}));
  add(model, "sight", kGun, box({-0.04, 0.79, -0.43}, {0.04, 0.825, -0.38}));
  add(model, "hammer", kGun, rounded_box({-0.02, 0.66, -0.52}, {0.02, 0.78, -0.44}, 0.015));
  // Grip grooves at the slide's rear.
  for (int i = 0; i < 5; ++i)
    add(model, "groove", kIron, box({-0.0645, 0.65, -0.40 + 0.035 * i}, {0.0645, 0.77, -0.385 + 0.035 * i}));
  return placed(std::move(model));
}

}  // namespace carve
