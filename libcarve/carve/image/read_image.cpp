#include "carve/image/read_image.h"

#include <new>
#include <ostream>

#include "carve/core/file.h"
#include "carve/image/codec.h"

namespace carve {
namespace codec {

void check_size(const std::string& name, std::uint64_t width, std::uint64_t height) {
  const auto check = [&](const char* side, std::uint64_t value) {
    if (value < 1 || value > kLargestSide)
      throw IoError(name, std::string(side) + " must be in [1, " + std::to_string(kLargestSide) + "], got " +
                              std::to_string(value));
  };
  check("width", width);
  check("height", height);
}

}  // namespace codec

Picture decode_image(std::string_view bytes, const std::string& name) {
  using namespace std::string_view_literals;
  if (bytes.empty()) throw IoError(name, "empty file");
  try {
    if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return codec::decode_png(bytes, name);
    if (bytes.starts_with("\xff\xd8\xff"sv)) return codec::decode_jpeg(bytes, name);
    for (const std::string_view magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
      if (bytes.starts_with(magic)) return codec::decode_tiff(bytes, name);
    if (bytes.starts_with("RIFF"sv) && bytes.substr(std::min<std::size_t>(8, bytes.size())).starts_with("WEBP"sv))
      return codec::decode_webp(bytes, name);
  } catch (const std::bad_alloc&) {
    throw IoError(name, "not enough memory for this picture");
  }
  throw IoError(name, "not a PNG, JPEG, TIFF or WebP image");
}

Picture read_image(const std::filesystem::path& path) { return decode_image(read_file(path), path.string()); }

void write_png(const std::filesystem::path& path, const Picture& picture) {
  const std::string bytes = encode_png(picture);
  write_file(path, [&](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
}

}  // namespace carve
