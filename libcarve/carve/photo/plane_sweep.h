#pragma once
// What Space Carving's plane sweeps are made of; not part of the interface.
#include <algorithm>
#include <cmath>
#include <vector>

#include "carve/photo/camera.h"

namespace carve {

// A pixel whose ray passes through a voxel of the slice.
struct Hit {
  int voxel, pixel;
};

// One photo, as the sweeps need it: the ray of pixel (i, j) is base + i * right + j * down.
struct Eye {
  const Photo* photo;
  Vec3 centre, base, right, down;
  Picture low, high;  // least and largest channels around each pixel
  Mask taken;         // pixels that this sweep has given to a voxel, or that do not show the object
  // Of the slice at hand: its pixels, and for each of them the voxel that its ray enters first.
  std::vector<Hit> hits;
  Raster<float> near;
  Raster<int> owner;
};

// \param margin  how far the surface may be off, in world units, near `middle`
Eye eye_of(const Photo& photo, const Vec3& middle, double margin);

// The direction that a sweep goes in.
struct Way {
  int axis, sign;
  // Each ray belongs to one sweep, the one along its largest component: it crosses the slices steeply there.
  bool leads(const Vec3& d) const {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double along = sign * d[axis];
    return along > 0 && (along > std::abs(d[a]) || (along == std::abs(d[a]) && axis < a)) &&
           (along > std::abs(d[b]) || (along == std::abs(d[b]) && axis < b));
  }
  bool may_lead(const Vec3& d, double margin) const {
    const double along = sign * d[axis] + margin;
    return along > std::abs(d[(axis + 1) % 3]) && along > std::abs(d[(axis + 2) % 3]);
  }
};

// Where the ray from the origin enters the cube of half side h about c, as a multiple of its direction; negative if it
// passes by.
double entry(const Vec3& c, double h, const Vec3& direction);

// Calls visit(i, j, depth) for the pixels whose rays pass through the voxel and belong to the sweep; for the pixel of
// its centre if the voxel lies between the rays.
template <class Visit>
void for_footprint(const Eye& eye, const Way& way, const Vec3& centre, double spacing, Visit&& visit) {
  const Vec3 from_eye = centre - eye.centre;
  if (!way.may_lead(from_eye, 2 * spacing)) return;
  const Camera& camera = eye.photo->camera;
  const Vec3 p = camera.rotation * from_eye;
  if (p.z() <= spacing) return;
  const double x = p.x() / p.z(), y = p.y() / p.z();
  double wide = 0, high = 0;
  for (int k = 0; k < 3; ++k) {
    wide += std::abs(camera.rotation(0, k) - x * camera.rotation(2, k));
    high += std::abs(camera.rotation(1, k) - y * camera.rotation(2, k));
  }
  // A little more than the first-order extent: the cube's near corners look larger.
  const double half = camera.focal / p.z() * spacing / 2 * (1 + spacing / p.z());
  const double u = camera.focal * x + camera.principal.x(), v = camera.focal * y + camera.principal.y();
  const auto first = [](double at, int n) { return static_cast<int>(std::ceil(std::clamp(at - 0.5, 0.0, 1.0 * n))); };
  const int i1 = first(u + half * wide + 1e-9, camera.width), j1 = first(v + half * high + 1e-9, camera.height);
  bool any = false;
  for (int j = first(v - half * high, camera.height); j < j1; ++j)
    for (int i = first(u - half * wide, camera.width); i < i1; ++i) {
      const Vec3 direction = eye.base + i * eye.right + j * eye.down;
      const double depth = entry(from_eye, spacing / 2, direction);
      if (depth < 0) continue;
      any = true;
      if (way.leads(direction)) visit(i, j, static_cast<float>(depth));
    }
  if (any || !(u >= 0 && v >= 0 && u < camera.width && v < camera.height)) return;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  if (way.leads(eye.base + i * eye.right + j * eye.down)) visit(i, j, static_cast<float>(p.z()));
}

}  // namespace carve
