#pragma once
#include <string_view>

#include "carve/core/raster.h"

namespace carve {

enum class Align { left, centre, right };

/// Draws a line of text (UTF-8, DejaVu Sans, anti-aliased) over a picture; the font is part of the program. `size` is
/// the height of a line in pixels, (x, y) the left end, middle or right end of the baseline.
void draw_text(Picture& picture, double x, double y, double size, std::string_view text, Align align = Align::left,
               Rgba colour = {0, 0, 0, 255});
double text_width(double size, std::string_view text);

}  // namespace carve
