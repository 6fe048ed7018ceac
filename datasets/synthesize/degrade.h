#pragma once
#include <cstdint>
#include <optional>

#include "carve/core/raster.h"
#include "carve/views/frame.h"

namespace carve {

/// What real drawings do wrong. Everything is 0 = off; the same seed gives the same flaws.
struct DegradeOptions {
  int seed = 1;
  double shift = 0;    // pixels
  double rescale = 0;  // %
  double jitter = 0;   // pixels
  double broken = 0;   // share
  double gap = 12;     // pixels
  double noise = 0;    // of 255
  std::optional<int> jpeg = {};
};
template <class Visitor>
void visit_fields(DegradeOptions& o, Visitor&& field) {
  field("seed", o.seed, 0, 2147483647, "which flaws");
  field("shift", o.shift, 0.0, 1024.0, "each drawing moves by so many pixels to the left or right, and up or down");
  field("rescale", o.rescale, 0.0, 50.0, "drawings grow and shrink in turn by so many %");
  field("jitter", o.jitter, 0.0, 64.0, "inner strokes waver by up to so many pixels along each axis");
  field("broken", o.broken, 0.0, 1.0, "share of the strokes that is rubbed out");
  field("gap", o.gap, 1.0, 1024.0, "length in pixels of what is rubbed out at a time");
  field("noise", o.noise, 0.0, 128.0, "standard deviation of the colours' noise, of 255");
  field("jpeg", o.jpeg, 1, 100,
        "quality of a JPEG round trip, which paints a transparent background white; auto: none");
}

/// Where a view's drawing goes wrong as a whole.
struct Misplacement {
  double scale = 1;
  double right = 0, down = 0;  // pixels
};
Misplacement misplacement(View view, const DegradeOptions& options);

/// How far an inner stroke at pixel coordinates (x, y) wavers; continuous, waves about 24 pixels long.
std::pair<double, double> waver(double x, double y, View view, const DegradeOptions& options);

/// Rubs out discs at random places of the strokes until `broken` of the ink is gone. 255 = all ink.
void rub_out(Raster<std::uint8_t>& ink, double stroke, View view, const DegradeOptions& options);

/// Noise, then the JPEG round trip.
Picture reproduce(Picture picture, View view, const DegradeOptions& options);

}  // namespace carve
