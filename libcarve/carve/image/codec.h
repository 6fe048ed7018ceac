#pragma once
// Internal to carve/image: one decoder a format, each given the file's bytes and the name that errors call it by.
// The decoders print nothing, check the declared size before they allocate, and refuse whatever is not complete.
#include <cstdint>
#include <string>
#include <string_view>

#include "carve/core/error.h"
#include "carve/core/raster.h"

namespace carve::codec {

Picture decode_png(std::string_view bytes, const std::string& name);
Picture decode_jpeg(std::string_view bytes, const std::string& name);
Picture decode_tiff(std::string_view bytes, const std::string& name);
Picture decode_webp(std::string_view bytes, const std::string& name);

/// \throws IoError "a.png: width must be in [1, 16384], got 100000"
void check_size(const std::string& name, std::uint64_t width, std::uint64_t height);

/// The orientation (1 to 8) in the first directory of a TIFF structure, which is what an EXIF block is; 1 if it has
/// none or cannot be read.
int exif_orientation(std::string_view tiff);

/// The picture as it is to be looked at: `orientation` is TIFF's and EXIF's number. Only 5 to 8, which swap width and
/// height, take a second picture's memory.
Picture oriented(Picture picture, int orientation);

inline IoError truncated(const std::string& name, const char* format) {
  return IoError(name, std::string("truncated ") + format + " image");
}
inline IoError damaged(const std::string& name, const char* format, const std::string& why) {
  return IoError(name, std::string("damaged or unsupported ") + format + " image: " + why);
}

}  // namespace carve::codec
