#include <cmath>

#include "models/primitives.h"
#include "models/procedural.h"
#include "models/sdf.h"

namespace carve {
namespace {

constexpr Rgba kFur{198, 144, 88}, kEar{142, 94, 64}, kNose{84, 70, 72}, kCollar{190, 54, 54}, kTag{238, 202, 92},
    kEye{92, 72, 66}, kMuzzle{232, 200, 160};

// Left-right symmetric: the field is asked at |x|.
double fur(const Vec3& q) {
  const Vec3 p(std::abs(q.x()), q.y(), q.z());
  double d = sdf::capsule(p, {0, 0.60, 0.26}, {0, 0.59, -0.40}, 0.185, 0.155);                      // chest to belly
  d = sdf::join(d, sdf::ellipsoid(p, {0, 0.56, 0.28}, {0.17, 0.22, 0.20}), 0.08);                   // breast
  d = sdf::join(d, sdf::ellipsoid(p, {0, 0.58, -0.44}, {0.17, 0.18, 0.18}), 0.08);                  // rump
  d = sdf::join(d, sdf::capsule(p, {0, 0.66, 0.34}, {0, 0.92, 0.54}, 0.135, 0.115), 0.08);          // neck
  d = sdf::join(d, sdf::ellipsoid(p, {0, 1.00, 0.58}, {0.145, 0.14, 0.17}), 0.06);                  // skull
  d = sdf::join(d, sdf::capsule(p, {0, 0.955, 0.66}, {0, 0.93, 0.86}, 0.085, 0.062), 0.06);         // muzzle
  d = sdf::join(d, sdf::capsule(p, {0.105, 0.50, 0.30}, {0.115, 0.06, 0.32}, 0.082, 0.058), 0.06);  // foreleg
  d = sdf::join(d, sdf::ellipsoid(p, {0.115, 0.035, 0.36}, {0.066, 0.05, 0.10}), 0.03);
  d = sdf::join(d, sdf::capsule(p, {0.105, 0.52, -0.44}, {0.12, 0.32, -0.38}, 0.12, 0.085), 0.06);  // thigh
  d = sdf::join(d, sdf::capsule(p, {0.12, 0.32, -0.38}, {0.125, 0.20, -0.54}, 0.075, 0.055), 0.05);
  d = sdf::join(d, sdf::capsule(p, {0.125, 0.20, -0.54}, {0.125, 0.05, -0.50}, 0.055, 0.052), 0.04);
  d = sdf::join(d, sdf::ellipsoid(p, {0.125, 0.035, -0.45}, {0.064, 0.05, 0.10}), 0.03);
  d = sdf::join(d, sdf::capsule(p, {0, 0.68, -0.56}, {0, 0.84, -0.76}, 0.060, 0.045), 0.06);  // tail
  return sdf::join(d, sdf::capsule(p, {0, 0.84, -0.76}, {0, 1.04, -0.82}, 0.045, 0.028), 0.03);
}

}  // namespace

// A standing dog with hanging ears and a collar.
Model dog() {
  Model model;
  add(model, "fur", kFur,
      polygonise([](const Vec3& p) { return std::max(fur(p), -p.y()); }, {-0.36, -0.013, -0.90}, {0.36, 1.20, 0.98},
                 1.0 / 50));
  for (const double side : {1.0, -1.0}) {
    Mesh ear = ellipsoid({0, 0, 0}, {0.035, 0.14, 0.075}, 40);
    ear = moved(turned(turned(std::move(ear), 2, 14), 0, 8), {0.155, 0.97, 0.55});
    add(model, "ear", kEar, side > 0 ? ear : mirrored(ear, 0));
    add(model, "eye", kEye, ellipsoid({side * 0.066, 1.035, 0.724}, {0.024, 0.026, 0.024}, 32));
  }
  add(model, "muzzle", kMuzzle, ellipsoid({0, 0.905, 0.82}, {0.068, 0.052, 0.105}, 48));
  add(model, "nose", kNose, ellipsoid({0, 0.965, 0.912}, {0.040, 0.032, 0.030}, 32));
  add(model, "collar", kCollar, moved(turned(torus({0, 0, 0}, 1, 0.128, 0.030, 64), 0, 38), {0, 0.835, 0.475}));
  add(model, "tag", kTag, ellipsoid({0, 0.725, 0.615}, {0.035, 0.042, 0.018}, 32));
  return placed(std::move(model));
}

}  // namespace carve
