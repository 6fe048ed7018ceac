#pragma once
#include "carve/mesh/textured_mesh.h"
#include "eval/rasterise.h"

namespace carve {

/// Red, green, blue, 0 to 255, sRGB.
using Colour = Eigen::Vector3f;

/// Rounded, what lies beyond 0 and 255 cut off; opaque.
Rgba to_pixel(const Colour& colour);

/// The texture between its texels' centres (bilinear), its border repeated beyond it. \param uv  as in TexturedMesh
Colour texture_at(const Picture& texture, const Vec2& uv);

/// Where on the texture each pixel's centre falls; the same size as `seen`, NaN where nothing is seen.
Raster<Vec2> seen_uvs(const TexturedMesh& model, const CameraAxes& axes, const Window& window, const Seen& seen);

/// The model with its texture: the texture's colours as they are, or darkened where the surface turns away from a light
/// beside the camera. Transparent where nothing is seen.
Picture render(const TexturedMesh& model, const CameraAxes& axes, const Window& window, bool shaded = false);

}  // namespace carve
