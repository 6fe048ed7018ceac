#include "models/primitives.h"
#include "models/procedural.h"

namespace carve {
namespace {

constexpr Rgba kRed{176, 58, 62}, kRose{214, 120, 112}, kWood{150, 104, 66};
constexpr Rgba kTeal{70, 128, 132}, kMint{148, 192, 182};
constexpr Rgba kStone{196, 186, 170}, kBrick{170, 96, 76};

void add_mirrored(Model& model, const char* material, Rgba colour, const Mesh& part) {
  add(model, material, colour, part);
  add(model, material, colour, mirrored(part, 0));
}

}  // namespace

// Two seats between arms that stand as far forward as the seat: from the side the arm hides it. Parts reach into each
// other by 1 cm and stand 2 mm back where their faces would share a plane.
Model couch() {
  Model model;
  add_mirrored(model, "fabric", kRed, box({0.78, 0.10, -0.45}, {1.00, 0.60, 0.45}));
  add(model, "back", Rgba{196, 78, 76}, box({-0.79, 0.11, -0.448}, {0.79, 0.88, -0.20}));
  add(model, "frame", kWood, box({-0.79, 0.102, -0.30}, {0.79, 0.24, 0.446}));
  add_mirrored(model, "cushion", kRose, box({0.004, 0.23, -0.25}, {0.79, 0.42, 0.448}));
  add(model, "seam", kRed, box({-0.006, 0.235, -0.24}, {0.006, 0.419, 0.447}));
  for (const double z : {-0.38, 0.38})
    add_mirrored(model, "foot", kWood, box({0.82, 0, z - 0.05}, {0.94, 0.12, z + 0.05}));
  return placed(std::move(model));
}

// One seat; the arms' rounded tops show in the front silhouette.
Model armchair() {
  Model model;
  const double arm_top = 0.62, radius = 0.12, middle = 0.44;
  std::vector<Vec2> profile{{middle - radius, 0.12}, {middle + radius, 0.12}};
  for (int i = 0; i <= 24; ++i) {
    const double angle = std::acos(-1.0) * i / 24;
    profile.emplace_back(middle + radius * std::cos(angle), arm_top - radius + radius * std::sin(angle));
  }
  add_mirrored(model, "arm", kTeal, prism(profile, 2, -0.42, 0.42));
  std::vector<Vec2> back{{-0.36, 0.13}, {0.36, 0.13}, {0.36, 0.92}};
  for (int i = 1; i < 24; ++i) {
    const double t = static_cast<double>(i) / 24;
    back.emplace_back(0.36 - 0.72 * t, 0.92 + 0.10 * std::sin(std::acos(-1.0) * t));
  }
  back.emplace_back(-0.36, 0.92);
  add(model, "back", Rgba{86, 150, 150}, prism(back, 2, -0.418, -0.20));
  add(model, "frame", kWood, box({-0.34, 0.122, -0.30}, {0.34, 0.25, 0.416}));
  add(model, "cushion", kMint, box({-0.34, 0.24, -0.25}, {0.34, 0.44, 0.418}));
  for (const double z : {-0.34, 0.34})
    add_mirrored(model, "foot", kWood, cylinder({0.44, 0, z}, {0.44, 0.14, z}, 0.05));
  return placed(std::move(model));
}

// Rising away from the viewer; with walls, neither the front nor the side silhouette shows a single step.
Model stairs(int steps, bool walled) {
  const double run = 1.0 / steps, rise = 0.8 / steps;
  std::vector<Vec2> profile;  // (y, z): the axes after x
  profile.emplace_back(0.002, -0.5);
  profile.emplace_back(0.002, 0.5);
  for (int i = 0; i < steps; ++i) {
    profile.emplace_back(rise * (i + 1), 0.5 - run * i);
    profile.emplace_back(rise * (i + 1), 0.5 - run * (i + 1));
  }
  Model model;
  if (!walled) {
    for (Vec2& p : profile) p.x() = p.x() < 0.01 ? 0 : p.x();
    add(model, "stone", kStone, prism(profile, 0, -0.4, 0.4));
    return placed(std::move(model));
  }
  for (Vec2& p : profile) p.y() *= 0.998;
  add(model, "stone", kStone, prism(profile, 0, -0.41, 0.41));
  add_mirrored(model, "wall", kBrick, box({0.4, 0, -0.5}, {0.5, 1.0, 0.5}));
  return placed(std::move(model));
}

}  // namespace carve
