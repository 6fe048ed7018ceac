// Airplane, jet and spaceship: fuselages of sections along z, wings of lens-shaped sections across their span.
#include <cmath>

#include "models/primitives.h"
#include "models/procedural.h"

namespace carve {
namespace {

constexpr Rgba kYellow{236, 190, 72}, kRed{192, 62, 56}, kGlass{140, 192, 214}, kTyre{84, 84, 92},
    kSteel{178, 186, 194}, kGrey{150, 158, 166}, kDark{104, 112, 124}, kWhite{232, 230, 222}, kBlue{78, 104, 150},
    kOrange{232, 132, 60};

// A wing from its root to its tip: chords' middles (x, y, z), half chords and half thicknesses.
struct Rib {
  Vec3 middle;
  double chord, thickness;
};
Mesh wing(std::initializer_list<Rib> ribs) {
  std::vector<Section> sections;
  for (const Rib& r : ribs) sections.push_back({r.middle, r.thickness, r.chord, 2});
  return body(sections, 0, 40);
}

// The same, standing: sections along y.
Mesh fin(std::initializer_list<Rib> ribs) {
  std::vector<Section> sections;
  for (const Rib& r : ribs) sections.push_back({r.middle, r.chord, r.thickness, 2});
  return body(sections, 1, 40);
}

void add_pair(Model& model, const char* material, Rgba colour, const Mesh& part) {
  add(model, material, colour, part);
  add(model, material, colour, mirrored(part, 0));
}

// Fuselage sections (z, y, half width, half height) with one exponent.
Mesh fuselage(std::initializer_list<std::array<double, 4>> stations, double exponent) {
  std::vector<Section> sections;
  for (const auto& [z, y, width, height] : stations) sections.push_back({{0, y, z}, width, height, exponent});
  return body(sections, 2, 64);
}

}  // namespace

// A light airplane: straight low wings, a propeller, wheels.
Model airplane() {
  Model model;
  add(model, "fuselage", kYellow,
      fuselage({{-1.00, 0.10, 0.015, 0.03},
                {-0.70, 0.06, 0.05, 0.075},
                {-0.30, 0.02, 0.10, 0.13},
                {0.05, 0.0, 0.13, 0.16},
                {0.40, 0.0, 0.13, 0.15},
                {0.62, 0.0, 0.12, 0.13}},
               2.6));
  add(model, "cowling", kRed,
      fuselage({{0.60, 0.0, 0.128, 0.138}, {0.72, 0.0, 0.125, 0.13}, {0.78, 0, 0.09, 0.095}}, 2.2));
  add(model, "steel", kSteel, cone({0, 0, 0.77}, {0, 0, 0.92}, 0.055, 0.004));
  for (const double side : {0.0, 180.0})
    add(model, "blade", kDark,
        turned(moved(ellipsoid({0, 0, 0}, {0.035, 0.15, 0.012}, 32), {0, 0.17, 0.83}), 2, 35 + side));
  add(model, "glass", kGlass, ellipsoid({0, 0.13, 0.10}, {0.095, 0.11, 0.26}));
  add_pair(model, "wing", kYellow,
           wing({{{0.05, -0.07, 0.14}, 0.21, 0.032},
                 {{0.55, -0.04, 0.13}, 0.19, 0.025},
                 {{1.02, -0.01, 0.11}, 0.15, 0.016}}));
  add_pair(model, "tip", kRed, wing({{{1.00, -0.011, 0.111}, 0.1545, 0.020}, {{1.12, -0.003, 0.10}, 0.10, 0.010}}));
  add_pair(model, "tailplane", kRed, wing({{{0.02, 0.11, -0.90}, 0.11, 0.014}, {{0.36, 0.12, -0.92}, 0.07, 0.008}}));
  add(model, "tailplane", kRed,
      fin({{{0, 0.08, -0.88}, 0.14, 0.016}, {{0, 0.30, -0.93}, 0.08, 0.012}, {{0, 0.37, -0.95}, 0.05, 0.008}}));
  const Vec3 leg[] = {{0.16, -0.08, 0.32}, {0.24, -0.27, 0.36}};
  const double thick[] = {0.022, 0.018};
  add_pair(model, "steel", kSteel, tube(leg, thick, 16));
  add_pair(model, "tyre", kTyre, cylinder({0.225, -0.29, 0.36}, {0.275, -0.29, 0.36}, 0.085));
  add_pair(model, "steel", kSteel, cylinder({0.215, -0.29, 0.36}, {0.285, -0.29, 0.36}, 0.035));
  add(model, "tyre", kTyre, cylinder({-0.02, 0.005, -0.86}, {0.02, 0.005, -0.86}, 0.045));
  return placed(std::move(model));
}

// A fighter: swept wings, twin fins, air intakes.
Model jet() {
  Model model;
  add(model, "fuselage", kGrey,
      fuselage({{-0.80, 0, 0.15, 0.075},
                {-0.45, 0, 0.17, 0.09},
                {0.0, 0.0, 0.15, 0.095},
                {0.30, 0.01, 0.09, 0.09},
                {0.62, 0.005, 0.06, 0.062},
                {0.84, -0.005, 0.03, 0.032}},
               2.6));
  add(model, "nose", kDark,
      fuselage({{0.82, -0.004, 0.034, 0.036}, {0.95, -0.01, 0.016, 0.018}, {1.02, -0.012, 0.002, 0.002}}, 2));
  add(model, "glass", kOrange, ellipsoid({0, 0.085, 0.42}, {0.05, 0.06, 0.17}));
  add_pair(model, "intake", kDark,
           fuselage({{-0.30, -0.02, 0.05, 0.06}, {0.20, -0.02, 0.055, 0.065}, {0.26, -0.015, 0.05, 0.06}}, 5));
  add_pair(model, "wing", kGrey,
           wing({{{0.12, 0.005, -0.22}, 0.36, 0.022},
                 {{0.34, 0.005, -0.34}, 0.22, 0.016},
                 {{0.62, 0.005, -0.50}, 0.09, 0.009}}));
  add_pair(model, "rail", kWhite, cylinder({0.62, 0.005, -0.66}, {0.62, 0.005, -0.30}, 0.016, 24));
  add_pair(model, "tail", kBlue, wing({{{0.14, 0, -0.80}, 0.13, 0.014}, {{0.36, 0, -0.92}, 0.07, 0.008}}));
  add_pair(model, "tail", kBlue, fin({{{0.13, 0.05, -0.66}, 0.17, 0.014}, {{0.18, 0.34, -0.82}, 0.08, 0.008}}));
  add_pair(model, "nozzle", kDark, cone({0.075, 0, -0.78}, {0.075, 0, -0.90}, 0.068, 0.055));
  return placed(std::move(model));
}

// Four wings in an X with an engine at each root and a cannon at each tip, a long tapered nose.
Model spaceship() {
  Model model;
  add(model, "hull", kWhite,
      fuselage({{-0.55, 0, 0.10, 0.10},
                {-0.45, 0, 0.12, 0.115},
                {0.05, 0, 0.115, 0.11},
                {0.35, -0.01, 0.085, 0.085},
                {0.95, -0.03, 0.035, 0.035}},
               5));
  add(model, "stripe", kRed, fuselage({{0.93, -0.0296, 0.0395, 0.0395}, {1.03, -0.033, 0.018, 0.020}}, 5));
  add(model, "glass", kBlue,
      fuselage({{-0.12, 0.08, 0.04, 0.04},
                {-0.05, 0.115, 0.055, 0.05},
                {0.12, 0.095, 0.05, 0.04},
                {0.24, 0.07, 0.02, 0.012}},
               4));
  add(model, "droid", kBlue, ellipsoid({0, 0.125, -0.24}, {0.045, 0.05, 0.045}, 40));
  const auto four = [&](const char* material, Rgba colour, const Mesh& flat) {
    const Mesh upper = turned(flat, 2, 16);
    add_pair(model, material, colour, upper);
    add_pair(model, material, colour, mirrored(upper, 1));
  };
  four("hull", kWhite,
       wing({{{0.08, 0, -0.28}, 0.17, 0.013}, {{0.60, 0, -0.33}, 0.12, 0.011}, {{0.66, 0, -0.33}, 0.12, 0.011}}));
  four("stripe", kRed, wing({{{0.36, 0, -0.306}, 0.1452, 0.0165}, {{0.46, 0, -0.316}, 0.1362, 0.0160}}));
  four("engine", kGrey, cylinder({0.17, 0.045, -0.56}, {0.17, 0.045, -0.08}, 0.058, 40));
  four("intake", kDark, cylinder({0.17, 0.045, -0.10}, {0.17, 0.045, -0.065}, 0.045, 40));
  four("intake", kDark, cone({0.17, 0.045, -0.54}, {0.17, 0.045, -0.62}, 0.045, 0.035, 40));
  four("cannon", kGrey, cylinder({0.67, 0, -0.46}, {0.67, 0, 0.02}, 0.026, 32));
  four("barrel", kDark, cylinder({0.67, 0, 0.0}, {0.67, 0, 0.42}, 0.013, 24));
  four("barrel", kDark, cylinder({0.67, 0, 0.40}, {0.67, 0, 0.45}, 0.022, 24));
  return placed(std::move(model));
}

}  // namespace carve
