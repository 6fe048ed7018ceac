// Car and wagon.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "models/primitives.h"
#include "models/procedural.h"

namespace carve {
namespace {

constexpr Rgba kBlue{62, 112, 178}, kGlass{168, 206, 220}, kTyre{84, 84, 92}, kSteel{196, 202, 208},
    kLamp{250, 226, 130}, kRed{200, 60, 52}, kGrey{132, 136, 142}, kPlank{188, 138, 86}, kBoard{150, 100, 62},
    kIron{112, 116, 124};

void add_pair(Model& model, const char* material, Rgba colour, const Mesh& part) {
  add(model, material, colour, part);
  add(model, material, colour, mirrored(part, 0));
}

}  // namespace

// A hatchback: the body is the side profile, the glass a frustum between body and roof.
Model car() {
  Model model;
  const Vec2 profile[] = {// (y, z)
                          {0.20, -0.98}, {0.20, 0.98},  {0.30, 1.02},  {0.48, 1.00}, {0.56, 0.92},
                          {0.66, 0.42},  {0.68, -0.80}, {0.62, -0.99}, {0.40, -1.02}};
  add(model, "body", kBlue, prism(profile, 0, -0.42, 0.42));
  const Section cabin[] = {
      {{0, 0.64, -0.14}, 0.68, 0.40, 7}, {{0, 0.80, -0.20}, 0.54, 0.36, 7}, {{0, 0.93, -0.24}, 0.43, 0.33, 7}};
  add(model, "glass", kGlass, body(cabin, 1, 96));
  const Section roof[] = {
      {{0, 0.915, -0.236}, 0.446, 0.338, 7}, {{0, 0.95, -0.24}, 0.42, 0.325, 7}, {{0, 0.972, -0.24}, 0.32, 0.25, 6}};
  add(model, "body", kBlue, body(roof, 1, 96));
  const Vec3 pillar[] = {{0.392, 0.64, -0.22}, {0.332, 0.93, -0.26}};
  const double thin[] = {0.022, 0.022};
  add_pair(model, "body", kBlue, tube(pillar, thin, 16));
  for (const double z : {0.60, -0.62}) {
    add_pair(model, "arch", kGrey, cylinder({0.30, 0.21, z}, {0.427, 0.21, z}, 0.225));
    add_pair(model, "tyre", kTyre, cylinder({0.32, 0.18, z}, {0.445, 0.18, z}, 0.18));
    add_pair(model, "steel", kSteel, cylinder({0.33, 0.18, z}, {0.452, 0.18, z}, 0.105));
  }
  add(model, "bumper", kGrey, rounded_box({-0.435, 0.205, 0.93}, {0.435, 0.33, 1.05}, 0.03));
  add(model, "bumper", kGrey, rounded_box({-0.435, 0.205, -1.05}, {0.435, 0.33, -0.93}, 0.03));
  add_pair(model, "lamp", kLamp, rounded_box({0.26, 0.39, 0.90}, {0.405, 0.49, 1.015}, 0.03));
  add_pair(model, "tail lamp", kRed, rounded_box({0.28, 0.42, -1.025}, {0.41, 0.54, -0.9}, 0.02));
  add(model, "grille", kTyre, rounded_box({-0.2, 0.37, 0.9}, {0.2, 0.46, 1.02}, 0.015));
  return placed(std::move(model));
}

// A tray on four wheels, open at the front, so that its floor's edge is a stroke in the front view; the sides hide the
// floor from the side. No view shows behind the wheels and below the floor: it is solid there, as far as they hide it.
Model wagon() {
  Model model;
  add(model, "board", kBoard, box({-0.40, 0.30, -0.70}, {0.40, 0.38, 0.70}));
  add_pair(model, "plank", kPlank, box({0.345, 0.302, -0.698}, {0.42, 0.72, 0.702}));
  add(model, "back", Rgba{206, 164, 110}, box({-0.36, 0.303, -0.704}, {0.36, 0.74, -0.61}));
  for (const double z : {-0.44, 0.44}) {
    add(model, "iron", kIron, cylinder({-0.50, 0.20, z}, {0.50, 0.20, z}, 0.035, 32));
    std::vector<Vec2> behind_wheel;  // (y, z)
    const double down = std::asin(0.035 / 0.2);
    for (int i = 0; i <= 40; ++i) {
      const double angle = -down + (std::numbers::pi + 2 * down) * i / 40;
      behind_wheel.push_back({std::min(0.31, 0.20 + 0.2 * std::sin(angle)), z + 0.2 * std::cos(angle)});
    }
    add(model, "iron", kIron, prism(behind_wheel, 0, -0.43, 0.43));
    add_pair(model, "wheel", kRed, cylinder({0.43, 0.20, z}, {0.52, 0.20, z}, 0.20));
    add_pair(model, "hub", kSteel, cylinder({0.44, 0.20, z}, {0.535, 0.20, z}, 0.07, 40));
  }
  add(model, "iron", kIron, cylinder({0, 0.20, 0.40}, {0, 0.20, 0.98}, 0.025, 32));
  add(model, "iron", kIron, cylinder({-0.12, 0.20, 0.96}, {0.12, 0.20, 0.96}, 0.025, 32));
  return placed(std::move(model));
}

}  // namespace carve
