#include <webp/decode.h>

#include "carve/image/codec.h"

namespace carve::codec {
namespace {

const std::uint8_t* data(std::string_view bytes) { return reinterpret_cast<const std::uint8_t*>(bytes.data()); }

// The RIFF header says how long the file is; libwebp does not insist on it.
bool is_complete(std::string_view bytes) {
  if (bytes.size() < 12) return false;
  std::uint64_t size = 0;
  for (int i = 0; i < 4; ++i) size |= std::uint64_t{static_cast<unsigned char>(bytes[4 + i])} << (8 * i);
  return bytes.size() >= size + 8;
}

void require(VP8StatusCode status, const std::string& name) {
  switch (status) {
    case VP8_STATUS_OK:
      return;
    case VP8_STATUS_OUT_OF_MEMORY:
      throw std::bad_alloc();
    case VP8_STATUS_NOT_ENOUGH_DATA:
    case VP8_STATUS_SUSPENDED:
      throw truncated(name, "WebP");
    case VP8_STATUS_UNSUPPORTED_FEATURE:
      throw damaged(name, "WebP", "unsupported feature");
    default:
      throw damaged(name, "WebP", "the data cannot be decoded");
  }
}

}  // namespace

Picture decode_webp(std::string_view bytes, const std::string& name) {
  if (!is_complete(bytes)) throw truncated(name, "WebP");
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config)) throw damaged(name, "WebP", "libwebp is of another version");
  require(WebPGetFeatures(data(bytes), bytes.size(), &config.input), name);
  check_size(name, config.input.width, config.input.height);
  if (config.input.has_animation) throw damaged(name, "WebP", "an animation is no drawing");

  Picture picture(config.input.width, config.input.height);
  config.output.colorspace = MODE_RGBA;
  config.output.is_external_memory = 1;
  config.output.u.RGBA.rgba = reinterpret_cast<std::uint8_t*>(picture.pixels.data());
  config.output.u.RGBA.stride = 4 * picture.width;
  config.output.u.RGBA.size = picture.pixels.size() * 4;
  require(WebPDecode(data(bytes), bytes.size(), &config), name);
  return picture;
}

}  // namespace carve::codec
