#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "carve/image/codec.h"
#include "carve/image/read_image.h"

// libpng reports errors with longjmp, which must not jump over destructors: whatever has one lives in Reader and
// Writer, outside the functions that call setjmp.

namespace carve {
namespace {

static_assert(sizeof(Rgba) == 4);

void ignore_warning(png_structp, png_const_charp) {}

// ---- reading -------------------------------------------------------------------------------------------------------

struct Reader {
  std::string_view rest;  // bytes not yet read
  bool ended = false;     // libpng asked for more than there is
  std::array<char, 200> error{};
  png_structp png = nullptr;
  png_infop info = nullptr;
  Picture picture;
  std::vector<png_bytep> rows;

  explicit Reader(std::string_view bytes) : rest(bytes) {}
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_read_error(png_structp png, png_const_charp message) {
  auto* reader = static_cast<Reader*>(png_get_error_ptr(png));
  std::snprintf(reader->error.data(), reader->error.size(), "%s", message);
  png_longjmp(png, 1);
}

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader->rest.size()) {
    reader->ended = true;
    png_error(png, "unexpected end");
  }
  std::memcpy(to, reader->rest.data(), count);
  reader->rest.remove_prefix(count);
}

// Everything becomes 8-bit RGBA; 16-bit channels are rounded. False after a libpng error.
bool start(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_read_fn(reader.png, &reader, read_bytes);
  png_read_info(reader.png, reader.info);
  png_set_expand(reader.png);
  png_set_scale_16(reader.png);
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

// Memory grows with the rows that really come, so that a header alone costs nothing.
bool read_rows(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  Picture& picture = reader.picture;
  for (int y = 0; y < picture.height; ++y) {
    picture.pixels.resize(picture.pixels.size() + picture.width);
    png_read_row(reader.png, reinterpret_cast<png_bytep>(&picture(0, y)), nullptr);
  }
  png_read_end(reader.png, nullptr);
  return true;
}

bool read_interlaced(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_image(reader.png, reader.rows.data());
  png_read_end(reader.png, nullptr);
  return true;
}

std::uint32_t big_endian(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[offset + i]);
  return value;
}

struct Header {
  std::uint32_t width, height;
  std::uint64_t bytes;  // of the picture before compression
};

// The IHDR chunk, which the format puts first; the rest of it libpng checks.
Header read_header(std::string_view bytes, const std::string& name) {
  if (bytes.size() < 33) throw codec::truncated(name, "PNG");
  if (bytes.substr(12, 4) != "IHDR") throw codec::damaged(name, "PNG", "no header");
  const std::uint32_t width = big_endian(bytes, 16), height = big_endian(bytes, 20);
  codec::check_size(name, width, height);
  static constexpr std::array<int, 7> kChannels{1, 0, 3, 1, 2, 0, 4};
  const unsigned depth = static_cast<unsigned char>(bytes[24]), type = static_cast<unsigned char>(bytes[25]);
  const std::uint64_t bits = type < kChannels.size() ? std::uint64_t{depth} * kChannels[type] : 0;
  return {width, height, (width * bits + 7) / 8 * height};
}

// ---- writing -------------------------------------------------------------------------------------------------------

struct Writer {
  std::string bytes;
  bool out_of_memory = false;
  png_structp png = nullptr;
  png_infop info = nullptr;

  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

void on_write_error(png_structp png, png_const_charp) { png_longjmp(png, 1); }

bool append(std::string& to, const char* from, std::size_t count) noexcept try {
  to.append(from, count);
  return true;
} catch (const std::exception&) {
  return false;
}

void write_bytes(png_structp png, png_bytep from, std::size_t count) {
  auto* writer = static_cast<Writer*>(png_get_io_ptr(png));
  if (!append(writer->bytes, reinterpret_cast<const char*>(from), count)) png_error(png, "out of memory");
}

void flush_nothing(png_structp) {}

bool write_rows(Writer& writer, const Picture& picture, bool opaque) {
  if (setjmp(png_jmpbuf(writer.png))) return false;
  png_set_write_fn(writer.png, &writer, write_bytes, flush_nothing);
  png_set_user_limits(writer.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_IHDR(writer.png, writer.info, picture.width, picture.height, 8,
               opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  // Unfiltered rows at level 3: for flat colours and atlases of them five times as fast as filters chosen row by row,
  // and no larger; photographs come out some percent larger.
  png_set_compression_level(writer.png, 3);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
  png_write_info(writer.png, writer.info);
  if (opaque) png_set_filler(writer.png, 0, PNG_FILLER_AFTER);
  for (int y = 0; y < picture.height; ++y) png_write_row(writer.png, reinterpret_cast<png_const_bytep>(&picture(0, y)));
  png_write_end(writer.png, nullptr);
  return true;
}

}  // namespace

Picture codec::decode_png(std::string_view bytes, const std::string& name) {
  const Header header = read_header(bytes, name);
  if (header.bytes / 1040 > bytes.size()) throw truncated(name, "PNG");  // deflate packs at most 1032 : 1

  Reader reader(bytes);
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_read_error, ignore_warning);
  reader.info = reader.png ? png_create_info_struct(reader.png) : nullptr;
  if (!reader.info) throw std::bad_alloc();
  const auto require = [&](bool done) {
    if (!done) throw reader.ended ? truncated(name, "PNG") : damaged(name, "PNG", reader.error.data());
  };
  require(start(reader));
  Picture& picture = reader.picture;
  if (png_get_interlace_type(reader.png, reader.info) == PNG_INTERLACE_NONE) {
    picture.width = static_cast<int>(header.width);
    picture.height = static_cast<int>(header.height);
    picture.pixels.reserve(std::size_t{header.width} * header.height);
    require(read_rows(reader));
  } else {
    picture = Picture(static_cast<int>(header.width), static_cast<int>(header.height));
    for (int y = 0; y < picture.height; ++y) reader.rows.push_back(reinterpret_cast<png_bytep>(&picture(0, y)));
    require(read_interlaced(reader));
  }
  return std::move(picture);
}

std::string encode_png(const Picture& picture) {
  if (picture.empty()) throw std::invalid_argument("a PNG needs at least one pixel");
  const bool opaque = std::all_of(picture.pixels.begin(), picture.pixels.end(), [](Rgba p) { return p.a == 255; });
  Writer writer;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, on_write_error, ignore_warning);
  writer.info = writer.png ? png_create_info_struct(writer.png) : nullptr;
  if (!writer.info || !write_rows(writer, picture, opaque)) throw std::bad_alloc();
  return std::move(writer.bytes);
}

}  // namespace carve
