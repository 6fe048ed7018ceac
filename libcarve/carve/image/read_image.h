#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "carve/core/raster.h"

namespace carve {

/// Longest side of a picture that is read; a file that declares more is refused before anything is allocated.
inline constexpr int kLargestSide = 16384;

/// Reads PNG, JPEG, TIFF (first page) or WebP by content, not by name: 1 to 16 bits a channel (rounded to 8), grey,
/// RGB, CMYK, palette, with or without alpha (TIFF's associated alpha is divided out). Never resampled; a picture
/// without alpha gets 255. Turned as JPEG's EXIF or TIFF's orientation says; colour profiles are ignored. \throws
/// IoError: missing, not an image, a side not in [1, kLargestSide], damaged or not complete to the last byte
Picture read_image(const std::filesystem::path& path);

/// The same from a file's bytes; `name` is what errors call it.
Picture decode_image(std::string_view bytes, const std::string& name);

/// Writes a PNG (RGBA, or RGB if every pixel is opaque), whole or not at all. \throws IoError
void write_png(const std::filesystem::path& path, const Picture& picture);

/// A PNG's bytes, the same on every machine with the same libpng and zlib.
std::string encode_png(const Picture& picture);

}  // namespace carve
