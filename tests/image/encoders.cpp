#include "image/encoders.h"

// clang-format off
#include <cstdio>
#include <jpeglib.h>
// clang-format on
#include <png.h>
#include <tiffio.h>
#include <webp/encode.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <random>

namespace carve {
namespace {

int to_8_bits(int value, int bits) {
  const int largest = (1 << bits) - 1;
  return (2 * 255 * value + largest) / (2 * largest);
}

// Rows as the formats store them: the first sample in the highest bits of a byte; 16 bits big-endian or native.
std::vector<std::uint8_t> packed_row(const std::vector<std::uint16_t>& row, int bits, bool native) {
  std::vector<std::uint8_t> bytes;
  if (bits == 16) {
    bytes.resize(2 * row.size());
    if (native) std::memcpy(bytes.data(), row.data(), bytes.size());
    for (std::size_t i = 0; i < row.size() && !native; ++i) {
      bytes[2 * i] = static_cast<std::uint8_t>(row[i] >> 8);
      bytes[2 * i + 1] = static_cast<std::uint8_t>(row[i]);
    }
    return bytes;
  }
  bytes.assign((row.size() * bits + 7) / 8, 0);
  for (std::size_t i = 0; i < row.size(); ++i)
    bytes[i * bits / 8] |= static_cast<std::uint8_t>(row[i] << (8 - bits - i * bits % 8));
  return bytes;
}

std::vector<std::uint16_t> row_of(const Samples& samples, int y) {
  const auto begin = samples.values.begin() + std::ptrdiff_t(y) * samples.width * samples.channels;
  return {begin, begin + samples.width * samples.channels};
}

// libtiff's view of a growing string.
struct Memory {
  std::string bytes;
  std::size_t position = 0;
};
Memory& memory(thandle_t handle) { return *static_cast<Memory*>(handle); }
tmsize_t read_memory(thandle_t handle, void* to, tmsize_t count) {
  Memory& m = memory(handle);
  const std::size_t given = std::min<std::size_t>(count, m.bytes.size() - std::min(m.position, m.bytes.size()));
  std::memcpy(to, m.bytes.data() + m.position, given);
  m.position += given;
  return static_cast<tmsize_t>(given);
}
tmsize_t write_memory(thandle_t handle, void* from, tmsize_t count) {
  Memory& m = memory(handle);
  m.bytes.resize(std::max(m.bytes.size(), m.position + count));
  std::memcpy(m.bytes.data() + m.position, from, count);
  m.position += count;
  return count;
}
toff_t seek_memory(thandle_t handle, toff_t offset, int whence) {
  Memory& m = memory(handle);
  return m.position = offset + (whence == SEEK_SET ? 0 : whence == SEEK_CUR ? m.position : m.bytes.size());
}
int close_memory(thandle_t) { return 0; }
toff_t size_memory(thandle_t handle) { return memory(handle).bytes.size(); }

void set_tags(TIFF* tiff, const Samples& samples, const TiffLook& look) {
  const int colours = samples.channels - (look.alpha != TiffLook::Alpha::none);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, samples.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, samples.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, samples.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples.channels);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, look.compression);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, look.planes ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC,
               !look.palette.empty() ? PHOTOMETRIC_PALETTE
               : colours == 4        ? PHOTOMETRIC_SEPARATED
               : colours == 3        ? PHOTOMETRIC_RGB
               : look.white_is_zero  ? PHOTOMETRIC_MINISWHITE
                                     : PHOTOMETRIC_MINISBLACK);
  if (look.alpha != TiffLook::Alpha::none) {
    const std::uint16_t kind =
        look.alpha == TiffLook::Alpha::associated ? EXTRASAMPLE_ASSOCALPHA : EXTRASAMPLE_UNASSALPHA;
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind);
  }
  if (look.orientation) TIFFSetField(tiff, TIFFTAG_ORIENTATION, look.orientation);
  if (!look.palette.empty()) {
    std::vector<std::uint16_t> table[3];
    for (int i = 0; i < 1 << samples.bits; ++i) {
      const Rgba c = look.palette[i % look.palette.size()];
      table[0].push_back(c.r * 257), table[1].push_back(c.g * 257), table[2].push_back(c.b * 257);
    }
    TIFFSetField(tiff, TIFFTAG_COLORMAP, table[0].data(), table[1].data(), table[2].data());
  }
  if (look.tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 5);
  }
}

void write_tiles(TIFF* tiff, const Samples& samples) {
  std::vector<std::uint8_t> tile(TIFFTileSize(tiff));
  for (int y0 = 0; y0 < samples.height; y0 += 16)
    for (int x0 = 0; x0 < samples.width; x0 += 16) {
      for (int y = 0; y < 16; ++y) {
        std::vector<std::uint16_t> row;
        for (int x = 0; x < 16; ++x)
          for (int c = 0; c < samples.channels; ++c)
            row.push_back(samples.values[(std::size_t(std::min(y0 + y, samples.height - 1)) * samples.width +
                                          std::min(x0 + x, samples.width - 1)) *
                                             samples.channels +
                                         c]);
        const auto bytes = packed_row(row, samples.bits, true);
        std::copy(bytes.begin(), bytes.end(), tile.begin() + y * bytes.size());
      }
      TIFFWriteTile(tiff, tile.data(), x0, y0, 0, 0);
    }
}

std::string exif_block(int orientation) {
  const std::string head("Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 24);
  return head + std::string(1, static_cast<char>(orientation)) + std::string(7, '\0');
}

}  // namespace

Samples random_samples(int width, int height, int channels, int bits, unsigned seed) {
  Samples samples{width, height, channels, bits, {}};
  std::mt19937 random(seed);
  for (int i = 0; i < width * height * channels; ++i)
    samples.values.push_back(static_cast<std::uint16_t>(random() & ((1u << bits) - 1)));
  return samples;
}

Samples samples_of(const Picture& picture, int channels) {
  Samples samples{picture.width, picture.height, channels, 8, {}};
  for (const Rgba p : picture.pixels) {
    const std::uint8_t all[] = {p.r, p.g, p.b, p.a};
    for (int c = 0; c < channels; ++c) samples.values.push_back(channels == 2 && c == 1 ? p.a : all[c]);
  }
  return samples;
}

Picture picture_of(const Samples& samples) {
  Picture picture(samples.width, samples.height);
  for (int y = 0; y < samples.height; ++y)
    for (int x = 0; x < samples.width; ++x) {
      const auto value = [&](int c) { return static_cast<std::uint8_t>(to_8_bits(samples(x, y, c), samples.bits)); };
      const bool colour = samples.channels >= 3;
      const bool alpha = samples.channels % 2 == 0;
      picture(x, y) = {value(0), value(colour ? 1 : 0), value(colour ? 2 : 0),
                       alpha ? value(samples.channels - 1) : std::uint8_t{255}};
    }
  return picture;
}

std::string png_file(const Samples& samples, const PngLook& look) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  std::string bytes;
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep from, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(from), count);
      },
      nullptr);
  static constexpr int kTypes[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                   PNG_COLOR_TYPE_RGB_ALPHA};
  png_set_IHDR(png, info, samples.width, samples.height, samples.bits,
               look.palette.empty() ? kTypes[samples.channels] : PNG_COLOR_TYPE_PALETTE,
               look.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (!look.palette.empty()) {
    std::vector<png_color> colours;
    std::vector<png_byte> alpha;
    for (const Rgba c : look.palette) colours.push_back({c.r, c.g, c.b}), alpha.push_back(c.a);
    png_set_PLTE(png, info, colours.data(), static_cast<int>(colours.size()));
    png_set_tRNS(png, info, alpha.data(), static_cast<int>(alpha.size()), nullptr);
  }
  if (look.transparent) {
    png_color_16 colour{};
    const auto& t = *look.transparent;
    colour.gray = static_cast<png_uint_16>(t[0]);
    if (t.size() == 3)
      colour.red = static_cast<png_uint_16>(t[0]), colour.green = static_cast<png_uint_16>(t[1]),
      colour.blue = static_cast<png_uint_16>(t[2]);
    png_set_tRNS(png, info, nullptr, 0, &colour);
  }
  png_write_info(png, info);
  std::vector<std::vector<std::uint8_t>> rows;
  std::vector<png_bytep> pointers;
  for (int y = 0; y < samples.height; ++y) rows.push_back(packed_row(row_of(samples, y), samples.bits, false));
  for (auto& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::string jpeg_file(const Samples& samples, const JpegLook& look) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &buffer, &size);
  jpeg.image_width = samples.width;
  jpeg.image_height = samples.height;
  jpeg.input_components = samples.channels;
  jpeg.in_color_space = samples.channels == 1 ? JCS_GRAYSCALE : samples.channels == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, look.quality, TRUE);
  if (look.progressive) jpeg_simple_progression(&jpeg);
  if (look.full_colour) jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
  if (samples.channels == 4) jpeg.write_Adobe_marker = look.adobe;
  jpeg_start_compress(&jpeg, TRUE);
  if (look.orientation) {
    const std::string exif = exif_block(look.orientation);
    jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(exif.data()),
                      static_cast<unsigned>(exif.size()));
  }
  for (int y = 0; y < samples.height; ++y) {
    auto row = packed_row(row_of(samples, y), 8, false);
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  const std::string bytes(reinterpret_cast<char*>(buffer), size);
  jpeg_destroy_compress(&jpeg);
  std::free(buffer);
  return bytes;
}

std::string tiff_file(const Samples& samples, const TiffLook& look) {
  Memory out;
  const std::string mode = std::string("w") + (look.big_endian ? "b" : "l") + (look.big_tiff ? "8" : "");
  TIFF* tiff = TIFFClientOpen("memory", mode.c_str(), &out, read_memory, write_memory, seek_memory, close_memory,
                              size_memory, nullptr, nullptr);
  set_tags(tiff, samples, look);
  if (look.tiled) write_tiles(tiff, samples);
  for (int y = 0; y < samples.height && !look.tiled; ++y) {
    const auto row = row_of(samples, y);
    if (!look.planes) {
      auto bytes = packed_row(row, samples.bits, true);
      TIFFWriteScanline(tiff, bytes.data(), y, 0);
    }
  }
  for (int c = 0; c < samples.channels && look.planes; ++c)
    for (int y = 0; y < samples.height; ++y) {
      std::vector<std::uint16_t> row;
      for (int x = 0; x < samples.width; ++x) row.push_back(static_cast<std::uint16_t>(samples(x, y, c)));
      auto bytes = packed_row(row, samples.bits, true);
      TIFFWriteScanline(tiff, bytes.data(), y, static_cast<std::uint16_t>(c));
    }
  TIFFClose(tiff);
  return out.bytes;
}

std::string webp_file(const Picture& picture, bool lossless, float quality) {
  std::uint8_t* buffer = nullptr;
  const auto* pixels = reinterpret_cast<const std::uint8_t*>(picture.pixels.data());
  const int stride = 4 * picture.width;
  const std::size_t size = lossless ? WebPEncodeLosslessRGBA(pixels, picture.width, picture.height, stride, &buffer)
                                    : WebPEncodeRGBA(pixels, picture.width, picture.height, stride, quality, &buffer);
  const std::string bytes(reinterpret_cast<char*>(buffer), size);
  WebPFree(buffer);
  return bytes;
}

}  // namespace carve
