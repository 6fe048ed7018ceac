#include <algorithm>
#include <cmath>

#include "models/primitives.h"
#include "models/procedural.h"
#include "models/sdf.h"

namespace carve {
namespace {

constexpr Rgba kSkin{226, 176, 142}, kLips{190, 98, 94}, kHair{104, 72, 64}, kWhite{240, 240, 236}, kIris{84, 120, 160};

double skull(const Vec3& p) {
  double d = sdf::ellipsoid(p, {0, 0.62, -0.04}, {0.30, 0.36, 0.36});
  return d;
}

// Left-right symmetric: the field is asked at |x|.
double face(const Vec3& q) {
  const Vec3 p(std::abs(q.x()), q.y(), q.z());
  double d = skull(p);
  d = sdf::join(d, sdf::ellipsoid(p, {0, 0.40, 0.06}, {0.215, 0.30, 0.24}), 0.08);                 // jaw
  d = sdf::join(d, sdf::ellipsoid(p, {0, 0.16, 0.20}, {0.085, 0.07, 0.08}), 0.06);                 // chin
  d = sdf::join(d, sdf::capsule(p, {0, 0.33, -0.06}, {0, -0.10, -0.10}, 0.15, 0.17), 0.05);        // neck
  d = sdf::join(d, sdf::capsule(p, {0, 0.655, 0.315}, {0.17, 0.645, 0.255}, 0.055, 0.045), 0.03);  // brow
  d = sdf::join(d, sdf::ellipsoid(p, {0, 0.78, 0.17}, {0.22, 0.16, 0.20}), 0.06);                  // forehead
  d = sdf::cut(d, sdf::ellipsoid(p, {0.105, 0.565, 0.335}, {0.075, 0.045, 0.07}), 0.03);           // eye socket
  d = sdf::join(d, sdf::ellipsoid(p, {0.135, 0.44, 0.20}, {0.07, 0.055, 0.07}), 0.05);             // cheekbone
  d = sdf::join(d, sdf::capsule(p, {0, 0.60, 0.285}, {0, 0.455, 0.335}, 0.026, 0.036),
                0.012);  // bridge and tip of the nose
  d = sdf::join(d, sdf::ellipsoid(p, {0.032, 0.442, 0.30}, {0.026, 0.022, 0.032}), 0.012);  // nostril's wing
  d = sdf::join(d, sdf::ellipsoid(p, {0.312, 0.51, -0.05}, {0.03, 0.085, 0.055}), 0.012);   // ear
  return d;
}

double hair(const Vec3& q) {
  const Vec3 p(std::abs(q.x()), q.y(), q.z());
  const double cap = sdf::ellipsoid(p, {0, 0.63, -0.06}, {0.322, 0.385, 0.385});
  // Cut off below a line that falls from the forehead to the neck.
  const double below = 0.80 - p.y() + 0.55 * std::min(p.z() - 0.05, 0.30) - (p.z() < 0.05 ? 0.30 * (0.05 - p.z()) : 0);
  return std::max(cap, below);
}

}  // namespace

// The brow reaches further forward than the nose, so the nose is hidden from above.
Model head() {
  Model model;
  const Vec3 low(-0.42, -0.001, -0.52), high(0.42, 1.1, 0.46);
  add(model, "skin", kSkin,
      polygonise([](const Vec3& p) { return std::max(face(p), -p.y() + 0.01); }, low, high, 1.0 / 72));
  add(model, "hair", kHair, polygonise(hair, low, high, 1.0 / 72));
  for (const double side : {-1.0, 1.0}) {
    add(model, "eye", kWhite, ellipsoid({side * 0.108, 0.562, 0.245}, {0.046, 0.028, 0.035}, 32));
    add(model, "iris", kIris, ellipsoid({side * 0.108, 0.562, 0.264}, {0.018, 0.019, 0.020}, 32));
  }
  const Vec3 mouth[] = {
      {-0.085, 0.318, 0.245}, {-0.03, 0.322, 0.283}, {0, 0.318, 0.287}, {0.03, 0.322, 0.283}, {0.085, 0.318, 0.245}};
  const std::vector<Vec3> path = curve(mouth, 6);
  std::vector<double> radii;
  for (std::size_t i = 0; i < path.size(); ++i)
    radii.push_back(0.012 +
                    0.012 * std::sin(std::acos(-1.0) * static_cast<double>(i) / static_cast<double>(path.size() - 1)));
  add(model, "lips", kLips, tube(path, radii, 20));
  return placed(std::move(model));
}

}  // namespace carve
