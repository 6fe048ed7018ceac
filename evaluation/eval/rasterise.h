#pragma once
#include <limits>

#include "carve/core/raster.h"
#include "carve/mesh/mesh.h"
#include "carve/views/frame.h"

namespace carve {

/// An orthographic camera's axes in the world: orthonormal, right x up = toward (the viewer).
struct CameraAxes {
  Vec3 right, up, toward;
};
CameraAxes camera(View view);
/// Turned from the front view by `azimuth` towards the side view, then lifted by `elevation`; degrees.
CameraAxes camera(double azimuth, double elevation);

/// The part of the picture plane that a raster shows: pixel (i, j)'s centre is at right coordinate
/// right0 + (i + 0.5) * right_per_pixel and up coordinate up0 + (j + 0.5) * up_per_pixel (negative: rows go down).
struct Window {
  int width = 0, height = 0;
  double right0 = 0, right_per_pixel = 1, up0 = 0, up_per_pixel = -1;
};

/// What every pixel's centre sees first.
struct Seen {
  static constexpr double kNothing = -std::numeric_limits<double>::infinity();
  Raster<double> depth;  // coordinate along `toward`; kNothing where no triangle is met
  Raster<int> triangle;  // its index, -1 where none; of equals the lowest
};

/// A z-buffer in software: no display, no graphics card, the same picture on every machine and number of threads.
/// Triangles are seen from both sides.
Seen rasterise(const Mesh& mesh, const CameraAxes& axes, const Window& window);

}  // namespace carve
