// clang-format off
#include <cstdio>  // jpeglib.h needs it
#include <jpeglib.h>
#include <jerror.h>  // needs jpeglib.h
// clang-format on

#include <array>
#include <csetjmp>

#include "carve/image/codec.h"

// libjpeg leaves its error handler by longjmp, which must not jump over destructors: whatever has one lives in Reader,
// outside the functions that call setjmp.

namespace carve::codec {
namespace {

// A file in more scans than this only costs time: progressive writers make about ten.
constexpr int kMostScans = 500;

struct Reader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump{};
  std::array<char, JMSG_LENGTH_MAX> error{};
  bool ended = false;  // the data stopped before the picture was complete
  Picture picture;
  std::vector<JSAMPLE> cmyk;  // one row

  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { jpeg_destroy_decompress(&jpeg); }
};

Reader& reader_of(j_common_ptr jpeg) { return *static_cast<Reader*>(jpeg->client_data); }

[[noreturn]] void stop(j_common_ptr jpeg) {
  Reader& reader = reader_of(jpeg);
  jpeg->err->format_message(jpeg, reader.error.data());
  std::longjmp(reader.jump, 1);
}

// libjpeg goes on after damage and fills up with grey; a picture with a hole is worse than none. What is left as a
// warning (stray bytes between segments, unusual markers) loses no pixel.
void on_message(j_common_ptr jpeg, int level) {
  if (level >= 0) return;  // a trace
  switch (jpeg->err->msg_code) {
    case JWRN_JPEG_EOF:
    case JWRN_HIT_MARKER:
      reader_of(jpeg).ended = true;
      stop(jpeg);
    case JWRN_HUFF_BAD_CODE:
    case JWRN_ARITH_BAD_CODE:
    case JWRN_MUST_RESYNC:
    case JWRN_BOGUS_PROGRESSION:
    case JWRN_NOT_SEQUENTIAL:
      stop(jpeg);
    default:
      return;
  }
}

void on_progress(j_common_ptr common) {
  auto* jpeg = reinterpret_cast<j_decompress_ptr>(common);
  if (jpeg->input_scan_number <= kMostScans) return;
  std::snprintf(reader_of(common).error.data(), JMSG_LENGTH_MAX, "more than %d scans", kMostScans);
  std::longjmp(reader_of(common).jump, 1);
}

bool open(Reader& reader, std::string_view bytes) {
  reader.jpeg.err = jpeg_std_error(&reader.errors);
  reader.errors.error_exit = stop;
  reader.errors.emit_message = on_message;
  reader.jpeg.client_data = &reader;
  if (setjmp(reader.jump)) return false;
  jpeg_create_decompress(&reader.jpeg);
  reader.progress.progress_monitor = on_progress;
  reader.jpeg.progress = &reader.progress;
  jpeg_mem_src(&reader.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_save_markers(&reader.jpeg, JPEG_APP0 + 1, 0xffff);  // EXIF
  jpeg_read_header(&reader.jpeg, TRUE);
  return true;
}

// Adobe's programs, nearly the only ones that write CMYK, store it inverted.
void to_rgba(const std::vector<JSAMPLE>& cmyk, bool inverted, Rgba* row) {
  for (std::size_t i = 0; i < cmyk.size(); i += 4, ++row) {
    const auto light = [&](std::size_t c) { return inverted ? cmyk[i + c] : 255 - cmyk[i + c]; };
    const auto channel = [&](std::size_t c) { return static_cast<std::uint8_t>((light(c) * light(3) + 127) / 255); };
    *row = {channel(0), channel(1), channel(2), 255};
  }
}

// Memory grows with the rows that really come, so that a header alone costs nothing (a progressive file needs all its
// coefficients first: libjpeg takes up to 6 bytes a pixel more).
bool read_rows(Reader& reader) {
  if (setjmp(reader.jump)) return false;
  jpeg_decompress_struct& jpeg = reader.jpeg;
  Picture& picture = reader.picture;
  const bool cmyk = jpeg.num_components == 4;
  jpeg.out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
  jpeg_start_decompress(&jpeg);
  for (int y = 0; y < picture.height; ++y) {
    picture.pixels.resize(picture.pixels.size() + picture.width);
    JSAMPROW row = cmyk ? reader.cmyk.data() : reinterpret_cast<JSAMPROW>(&picture(0, y));
    jpeg_read_scanlines(&jpeg, &row, 1);
    if (cmyk) to_rgba(reader.cmyk, jpeg.saw_Adobe_marker, &picture(0, y));
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

int orientation(const jpeg_decompress_struct& jpeg) {
  using namespace std::string_view_literals;
  for (auto* marker = jpeg.marker_list; marker; marker = marker->next) {
    const std::string_view data(reinterpret_cast<const char*>(marker->data), marker->data_length);
    if (data.starts_with("Exif\0\0"sv)) return exif_orientation(data.substr(6));
  }
  return 1;
}

}  // namespace

Picture decode_jpeg(std::string_view bytes, const std::string& name) {
  Reader reader;
  const auto require = [&](bool done) {
    if (!done) throw reader.ended ? truncated(name, "JPEG") : damaged(name, "JPEG", reader.error.data());
  };
  require(open(reader, bytes));
  check_size(name, reader.jpeg.image_width, reader.jpeg.image_height);
  reader.picture.width = static_cast<int>(reader.jpeg.image_width);
  reader.picture.height = static_cast<int>(reader.jpeg.image_height);
  reader.picture.pixels.reserve(std::size_t{reader.jpeg.image_width} * reader.jpeg.image_height);
  reader.cmyk.resize(reader.jpeg.num_components == 4 ? std::size_t{reader.jpeg.image_width} * 4 : 0);
  const int stored = orientation(reader.jpeg);  // the markers go with the end of decoding
  require(read_rows(reader));
  return oriented(std::move(reader.picture), stored);
}

}  // namespace carve::codec
