#include <algorithm>
#include <cmath>

#include "models/primitives.h"
#include "models/procedural.h"
#include "models/sdf.h"

namespace carve {
namespace {

constexpr Rgba kSkin{226, 176, 142}, kLips{190, 98, 94}, kHair{104, 72, 64}, kWhite{240, 240, 236}, kIris{84, 120, 160};

// Left-right symmetric: the field is asked at |x|.
double face(const Vec3& q) {
  const Vec3 p(std::abs(q.x()), q.y(), q.z());
  double d = sdf::ellipsoid(p, {0, 0.64, -0.05}, {0.275, 0.34, 0.35});                           // skull
  d = sdf::join(d, sdf::ellipsoid(p, {0, 0.42, 0.04}, {0.225, 0.27, 0.25}), 0.06);               // jaw
  d = sdf::join(d, sdf::ellipsoid(p, {0, 0.215, 0.205}, {0.095, 0.075, 0.075}), 0.09);           // chin
  d = sdf::join(d, sdf::capsule(p, {0.15, 0.33, -0.02}, {0.07, 0.21, 0.17}, 0.06, 0.05), 0.06);  // jaw line
  d = sdf::join(d, sdf::capsule(p, {0, 0.40, -0.10}, {0, -0.10, -0.13}, 0.155, 0.165), 0.04);    // neck
  d = sdf::join(d, sdf::capsule(p, {0, 0.66, 0.315}, {0.16, 0.65, 0.25}, 0.050, 0.042), 0.03);   // brow
  d = sdf::join(d, sdf::ellipsoid(p, {0, 0.78, 0.15}, {0.21, 0.16, 0.20}), 0.06);                // forehead
  d = sdf::cut(d, sdf::ellipsoid(p, {0.105, 0.575, 0.335}, {0.072, 0.045, 0.075}), 0.03);        // eye socket
  d = sdf::join(d, sdf::ellipsoid(p, {0.135, 0.47, 0.185}, {0.07, 0.055, 0.07}), 0.05);          // cheekbone
  d = sdf::join(d, sdf::capsule(p, {0, 0.61, 0.285}, {0, 0.465, 0.325}, 0.026, 0.038), 0.012);   // nose
  d = sdf::join(d, sdf::ellipsoid(p, {0.036, 0.452, 0.295}, {0.030, 0.024, 0.034}), 0.012);      // its wing
  return sdf::join(d, sdf::ellipsoid(p, {0.285, 0.53, -0.05}, {0.036, 0.095, 0.060}), 0.012);    // ear
}

// A cap that ends above the forehead, before the ears and in the neck.
double hair(const Vec3& q) {
  const Vec3 p(std::abs(q.x()), q.y(), q.z());
  const double cap = sdf::ellipsoid(p, {0, 0.65, -0.07}, {0.318, 0.385, 0.375});
  const double fringe = 0.84 - p.y();
  const double temple = 0.62 - p.y() + 2.2 * (p.z() + 0.02);
  const double neck = 0.40 - p.y();
  return std::max({cap, std::min(fringe, std::max(temple, neck))});
}

}  // namespace

// The brow reaches further forward than the nose, so the nose is hidden from above.
Model head() {
  Model model;
  const Vec3 low(-0.42, -0.001, -0.52), high(0.42, 1.1, 0.46);
  const auto skin = [](const Vec3& p) { return std::max(face(p), -p.y() + 0.01); };
  add(model, "skin", kSkin, polygonise(skin, low, high, 1.0 / 60));
  add(model, "hair", kHair, polygonise(hair, low, high, 1.0 / 60));
  for (const double side : {-1.0, 1.0}) {
    add(model, "eye", kWhite, ellipsoid({side * 0.105, 0.572, 0.245}, {0.050, 0.028, 0.038}, 32));
    add(model, "iris", kIris, ellipsoid({side * 0.103, 0.572, 0.268}, {0.020, 0.021, 0.020}, 32));
    const Vec3 arch[] = {{side * 0.04, 0.662, 0.352}, {side * 0.10, 0.678, 0.336}, {side * 0.165, 0.662, 0.285}};
    const std::vector<Vec3> path = curve(arch, 6);
    add(model, "hair", kHair, tube(path, std::vector<double>(path.size(), 0.017), 16));
  }
  const Vec3 mouth[] = {
      {-0.08, 0.345, 0.25}, {-0.03, 0.350, 0.282}, {0, 0.346, 0.286}, {0.03, 0.350, 0.282}, {0.08, 0.345, 0.25}};
  const std::vector<Vec3> path = curve(mouth, 6);
  std::vector<double> radii;
  for (std::size_t i = 0; i < path.size(); ++i)
    radii.push_back(0.010 +
                    0.014 * std::sin(std::acos(-1.0) * static_cast<double>(i) / static_cast<double>(path.size() - 1)));
  add(model, "lips", kLips, tube(path, radii, 20));
  return placed(std::move(model));
}

}  // namespace carve
