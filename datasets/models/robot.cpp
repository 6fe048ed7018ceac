#include "models/primitives.h"
#include "models/procedural.h"

namespace carve {
namespace {

constexpr Rgba kTin{164, 178, 190}, kJoint{104, 110, 122}, kOrange{226, 128, 56}, kEye{250, 224, 96},
    kPanel{96, 140, 150}, kRed{206, 72, 62}, kDark{90, 96, 108};

void add_pair(Model& model, const char* material, Rgba colour, const Mesh& part) {
  add(model, material, colour, part);
  add(model, material, colour, mirrored(part, 0));
}

}  // namespace

// A tin robot: square head, chest panel, tube limbs with ball joints.
Model robot() {
  Model model;
  add(model, "tin", kTin, rounded_box({-0.17, 1.20, -0.14}, {0.17, 1.48, 0.14}, 0.03));
  add(model, "visor", kDark, rounded_box({-0.13, 1.32, 0.10}, {0.13, 1.42, 0.155}, 0.02));
  add_pair(model, "eye", kEye, cylinder({0.065, 1.37, 0.14}, {0.065, 1.37, 0.165}, 0.034, 32));
  add(model, "mouth", kDark, box({-0.09, 1.245, 0.12}, {0.09, 1.275, 0.146}));
  add_pair(model, "ear", kOrange, cylinder({0.15, 1.35, 0}, {0.205, 1.35, 0}, 0.055, 40));
  add(model, "antenna", kJoint, cylinder({0, 1.46, 0}, {0, 1.60, 0}, 0.014, 24));
  add(model, "bulb", kRed, ellipsoid({0, 1.62, 0}, {0.032, 0.032, 0.032}, 32));
  add(model, "joint", kJoint, cylinder({0, 1.10, 0}, {0, 1.22, 0}, 0.07, 40));
  const Section chest[] = {{{0, 0.70, 0}, 0.13, 0.20, 5},
                           {{0, 0.80, 0}, 0.16, 0.235, 5},
                           {{0, 1.08, 0}, 0.19, 0.29, 5},
                           {{0, 1.14, 0}, 0.15, 0.22, 5}};
  add(model, "chest", kOrange, body(chest, 1, 80));
  add(model, "panel", kPanel, rounded_box({-0.15, 0.86, 0.1}, {0.15, 1.05, 0.205}, 0.015));
  add(model, "bulb", kRed, cylinder({-0.08, 0.95, 0.19}, {-0.08, 0.95, 0.222}, 0.035, 32));
  add(model, "eye", kEye, box({0.0, 0.92, 0.19}, {0.11, 0.98, 0.214}));
  add(model, "pack", kJoint, rounded_box({-0.17, 0.80, -0.27}, {0.17, 1.08, -0.12}, 0.03));
  add(model, "hip", kJoint, rounded_box({-0.18, 0.60, -0.11}, {0.18, 0.72, 0.11}, 0.03));
  add_pair(model, "joint", kJoint, ellipsoid({0.33, 1.05, 0}, {0.085, 0.085, 0.085}, 40));
  add_pair(model, "tin", kTin, cone({0.36, 1.02, 0}, {0.41, 0.80, 0.0}, 0.058, 0.052, 40));
  add_pair(model, "joint", kJoint, ellipsoid({0.415, 0.78, 0}, {0.062, 0.062, 0.062}, 40));
  add_pair(model, "tin", kTin, cone({0.415, 0.77, 0.0}, {0.43, 0.55, 0.07}, 0.052, 0.068, 40));
  add_pair(model, "hand", kOrange, rounded_box({0.36, 0.42, 0.02}, {0.50, 0.55, 0.14}, 0.03));
  add_pair(model, "joint", kJoint, rounded_box({0.365, 0.34, 0.07}, {0.40, 0.44, 0.125}, 0.012));
  add_pair(model, "joint", kJoint, rounded_box({0.46, 0.34, 0.07}, {0.495, 0.44, 0.125}, 0.012));
  add_pair(model, "tin", kTin, cylinder({0.11, 0.64, 0}, {0.13, 0.36, 0}, 0.068, 40));
  add_pair(model, "joint", kJoint, ellipsoid({0.13, 0.35, 0.01}, {0.078, 0.075, 0.078}, 40));
  add_pair(model, "tin", kTin, cone({0.13, 0.34, 0}, {0.14, 0.08, 0}, 0.066, 0.088, 40));
  const Section foot[] = {{{0.145, 0.0, 0.04}, 0.20, 0.11, 5},
                          {{0.145, 0.06, 0.04}, 0.195, 0.105, 5},
                          {{0.145, 0.13, 0.01}, 0.13, 0.08, 4}};
  add_pair(model, "foot", kOrange, body(foot, 1, 64));
  return placed(std::move(model));
}

}  // namespace carve
