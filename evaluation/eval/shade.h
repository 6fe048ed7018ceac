#pragma once
#include <functional>
#include <string>

#include "eval/rasterise.h"

namespace carve {

/// "front", "side", "top", "back", "left", "bottom", "three_quarter" or "AZIMUTH:ELEVATION" in degrees.
/// \throws std::invalid_argument
CameraAxes named_camera(const std::string& text);

/// The smallest window that shows all points.
Window window_around(const CameraAxes& axes, const std::vector<Vec3>& points, double pixels_per_unit);

inline constexpr Rgba kClay{200, 200, 200, 255};  // a surface without a colour of its own

/// Colour of triangle `t` at a point of the picture plane, before light falls on it.
using Paint = std::function<Rgba(int t, double right, double up)>;

/// One mesh from one side on white, anti-aliased, shaded so that shape shows and colour still reads; both sides of a
/// triangle alike. Needs no display; the same picture on every machine and number of threads.
Picture shade(
    const Mesh& mesh, const CameraAxes& axes, const Window& window,
    const Paint& paint = [](int, double, double) { return kClay; });

/// Copies a picture over another, its upper left corner at (x0, y0); what is outside is left out.
void paste(Picture& onto, const Picture& picture, int x0, int y0);

}  // namespace carve
