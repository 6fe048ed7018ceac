#pragma once
#include <string>

#include "carve/core/raster.h"

namespace carve {

/// A JPEG's bytes, baseline, in full colour resolution from quality 95 on, else 4:2:0. Alpha is painted over white.
/// \throws std::invalid_argument if quality is not in [1, 100] or the picture has no pixels
std::string encode_jpeg(const Picture& picture, int quality);

}  // namespace carve
