#include "carve/image/write_jpeg.h"

// jpeglib.h needs size_t and FILE.
#include <cstdio>
// clang-format off
#include <jpeglib.h>
// clang-format on
#include <cstdlib>
#include <memory>
#include <stdexcept>

namespace carve {
namespace {

constexpr int kFullColour = 95;  // from this quality on

std::uint8_t over_white(std::uint8_t value, std::uint8_t alpha) {
  return static_cast<std::uint8_t>((value * alpha + 255 * (255 - alpha) + 127) / 255);
}

}  // namespace

std::string encode_jpeg(const Picture& picture, int quality) {
  if (quality < 1 || quality > 100)
    throw std::invalid_argument("JPEG quality must be in [1, 100], got " + std::to_string(quality));
  if (picture.empty()) throw std::invalid_argument("a JPEG needs a picture with pixels");
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  errors.error_exit = [](j_common_ptr common) {
    char message[JMSG_LENGTH_MAX];
    common->err->format_message(common, message);
    throw std::runtime_error(std::string("JPEG: ") + message);
  };
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_create_compress(&info);
  const std::unique_ptr<jpeg_compress_struct, void (*)(jpeg_compress_struct*)> guard(&info, jpeg_destroy_compress);
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<unsigned>(picture.width);
  info.image_height = static_cast<unsigned>(picture.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  if (quality >= kFullColour) info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&info, TRUE);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(picture.width) * 3);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Rgba p = picture(x, y);
      row[3 * x] = over_white(p.r, p.a), row[3 * x + 1] = over_white(p.g, p.a), row[3 * x + 2] = over_white(p.b, p.a);
    }
    JSAMPROW line = row.data();
    jpeg_write_scanlines(&info, &line, 1);
  }
  jpeg_finish_compress(&info);
  const std::unique_ptr<unsigned char, void (*)(void*)> owned(bytes, std::free);
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace carve
