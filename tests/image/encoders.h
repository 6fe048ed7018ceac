#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "carve/core/raster.h"

namespace carve {

/// Image files made by the formats' own libraries, in the variants that drawing programs write.

struct Samples {
  int width = 0, height = 0, channels = 1, bits = 8;
  std::vector<std::uint16_t> values;  // row by row, channels interleaved

  int operator()(int x, int y, int channel) const { return values[(std::size_t(y) * width + x) * channels + channel]; }
};
Samples random_samples(int width, int height, int channels, int bits, unsigned seed);
Samples samples_of(const Picture& picture, int channels);  // 8 bits; grey is the red channel, 2 and 4 have alpha
/// What the samples mean: 1 = grey, 2 = grey and alpha, 3 = RGB, 4 = RGBA, each rounded to 8 bits.
Picture picture_of(const Samples& samples);

struct PngLook {
  bool interlaced = false;
  std::vector<Rgba> palette = {};                    // for one channel: the samples are indices
  std::optional<std::vector<int>> transparent = {};  // the one sample value, or RGB, that is see-through
};
std::string png_file(const Samples& samples, const PngLook& look = {});

struct JpegLook {
  int quality = 95;
  bool progressive = false;
  int orientation = 0;      // EXIF, 0 = no EXIF block
  bool adobe = true;        // CMYK: with Adobe's marker, inverted
  bool full_colour = true;  // no chroma subsampling
};
std::string jpeg_file(const Samples& samples, const JpegLook& look = {});  // 1, 3 or 4 (CMYK) channels

struct TiffLook {
  enum class Alpha { none, straight, associated };
  Alpha alpha = Alpha::none;  // of the last channel
  int compression = 1;        // COMPRESSION_NONE
  bool white_is_zero = false;
  bool tiled = false;
  bool planes = false;  // channels one after the other
  bool big_endian = false;
  bool big_tiff = false;
  int orientation = 0;             // 0 = not said
  std::vector<Rgba> palette = {};  // for one channel
};
std::string tiff_file(const Samples& samples, const TiffLook& look = {});

std::string webp_file(const Picture& picture, bool lossless, float quality = 90);

}  // namespace carve
