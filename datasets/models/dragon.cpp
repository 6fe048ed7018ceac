#include <cmath>

#include "models/primitives.h"
#include "models/procedural.h"
#include "models/sdf.h"

namespace carve {
namespace {

constexpr Rgba kScale{84, 150, 96}, kBelly{222, 206, 128}, kWing{178, 72, 66}, kBone{112, 128, 84},
    kHorn{236, 226, 196}, kEye{250, 196, 60};

// Left-right symmetric: the field is asked at |x|.
double scales(const Vec3& q) {
  const Vec3 p(std::abs(q.x()), q.y(), q.z());
  const auto chain = [&](double d, std::initializer_list<std::array<double, 3>> points, double k) {  // (y, z, radius)
    for (auto a = points.begin(); a + 1 != points.end(); ++a) {
      const auto& b = *(a + 1);
      d = sdf::join(d, sdf::capsule(p, {0, (*a)[0], (*a)[1]}, {0, b[0], b[1]}, (*a)[2], b[2]), k);
    }
    return d;
  };
  double d = sdf::ellipsoid(p, {0, 0.46, 0.0}, {0.17, 0.19, 0.30});
  d = chain(d, {{0.54, 0.20, 0.13}, {0.72, 0.34, 0.10}, {0.92, 0.36, 0.085}, {1.06, 0.44, 0.085}}, 0.07);  // neck
  d = chain(
      d, {{0.44, -0.22, 0.13}, {0.30, -0.48, 0.095}, {0.18, -0.72, 0.065}, {0.16, -0.94, 0.045}, {0.24, -1.10, 0.022}},
      0.06);
  d = sdf::join(d, sdf::ellipsoid(p, {0, 1.09, 0.48}, {0.105, 0.095, 0.14}), 0.05);               // skull
  d = sdf::join(d, sdf::capsule(p, {0, 1.09, 0.56}, {0, 1.06, 0.78}, 0.070, 0.052), 0.04);        // snout
  d = sdf::join(d, sdf::capsule(p, {0, 1.02, 0.54}, {0, 0.985, 0.72}, 0.048, 0.034), 0.02);       // jaw
  d = sdf::join(d, sdf::ellipsoid(p, {0.038, 1.105, 0.80}, {0.026, 0.024, 0.03}), 0.02);          // nostril
  d = sdf::join(d, sdf::capsule(p, {0.13, 0.40, 0.18}, {0.17, 0.20, 0.20}, 0.078, 0.062), 0.05);  // legs
  d = sdf::join(d, sdf::capsule(p, {0.17, 0.20, 0.20}, {0.17, 0.05, 0.22}, 0.058, 0.05), 0.03);
  d = sdf::join(d, sdf::ellipsoid(p, {0.17, 0.035, 0.27}, {0.066, 0.045, 0.10}), 0.03);
  d = sdf::join(d, sdf::capsule(p, {0.13, 0.42, -0.18}, {0.19, 0.24, -0.10}, 0.12, 0.085), 0.05);
  d = sdf::join(d, sdf::capsule(p, {0.19, 0.24, -0.10}, {0.18, 0.06, -0.20}, 0.07, 0.052), 0.04);
  return sdf::join(d, sdf::ellipsoid(p, {0.18, 0.035, -0.13}, {0.07, 0.045, 0.11}), 0.03);
}

// A membrane with a scalloped rear edge, spread in the plane of x and z and then raised.
Mesh membrane() {
  const Vec2 outline[] = {{0.10, 0.10},  {0.14, 0.46},  {0.10, 0.86},  {0.00, 1.12},  {-0.14, 0.98}, {-0.14, 0.84},
                          {-0.34, 0.74}, {-0.28, 0.56}, {-0.42, 0.40}, {-0.30, 0.26}, {-0.34, 0.10}};
  return turned(prism(outline, 1, -0.012, 0.012), 2, 24, {0.10, 0, 0});
}

}  // namespace

// A winged dragon on four legs.
Model dragon() {
  Model model;
  add(model, "scales", kScale,
      polygonise([](const Vec3& p) { return std::max(scales(p), -p.y()); }, {-0.36, -0.013, -1.20}, {0.36, 1.30, 0.92},
                 1.0 / 50));
  add(model, "belly", kBelly, ellipsoid({0, 0.42, 0.05}, {0.135, 0.17, 0.28}, 64));
  const Vec3 breast[] = {{0, 0.50, 0.245}, {0, 0.70, 0.385}, {0, 0.88, 0.395}};
  const double wide[] = {0.105, 0.072, 0.05};
  add(model, "belly", kBelly, tube(breast, wide, 40));
  const Vec3 arm[] = {{0.08, 0.60, 0.10}, {0.46, 0.765, 0.14}, {0.88, 0.945, 0.10}, {1.12, 1.055, 0.00}};
  const std::vector<Vec3> bone = curve(arm, 8);
  std::vector<double> thick;
  for (std::size_t i = 0; i < bone.size(); ++i)
    thick.push_back(0.042 - 0.026 * static_cast<double>(i) / static_cast<double>(bone.size()));
  const Vec3 horn[] = {{0.055, 1.15, 0.44}, {0.085, 1.25, 0.34}, {0.09, 1.29, 0.22}};
  const double pointed[] = {0.034, 0.024, 0.006};
  for (const double side : {1.0, -1.0}) {
    const auto place = [&](const Mesh& mesh) { return side > 0 ? mesh : mirrored(mesh, 0); };
    add(model, "wing", kWing, place(moved(membrane(), {0, 0.60, 0})));
    add(model, "bone", kBone, place(tube(bone, thick, 20)));
    add(model, "horn", kHorn, place(tube(horn, pointed, 20)));
    add(model, "eye", kEye, place(ellipsoid({0.082, 1.125, 0.56}, {0.024, 0.022, 0.030}, 32)));
  }
  // Spikes down the back, from the neck to the tail.
  const Vec3 spikes[] = {{0, 1.10, 0.32},  {0, 0.93, 0.26},  {0, 0.76, 0.22},  {0, 0.64, 0.06}, {0, 0.64, -0.10},
                         {0, 0.55, -0.28}, {0, 0.41, -0.46}, {0, 0.29, -0.64}, {0, 0.21, -0.82}};
  const Vec3 outward[] = {{0, 0.55, -0.85}, {0, 0.2, -1},   {0, 0.4, -0.9}, {0, 1, -0.2}, {0, 1, -0.3},
                          {0, 0.9, -0.5},   {0, 0.9, -0.5}, {0, 0.9, -0.4}, {0, 1, -0.1}};
  for (int i = 0; i < 9; ++i) {
    const double size = 1 - 0.07 * i;
    add(model, "horn", kHorn,
        cone(spikes[i] - 0.05 * outward[i], spikes[i] + 0.11 * size * outward[i], 0.05 * size, 0, 24));
  }
  add(model, "horn", kHorn, cone({0, 0.22, -1.08}, {0, 0.33, -1.22}, 0.05, 0, 24));
  return placed(std::move(model));
}

}  // namespace carve
