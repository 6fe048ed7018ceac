#include <tiffio.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>

#include "carve/image/codec.h"
#include "carve/image/read_image.h"

namespace carve::codec {
namespace {

// The file's bytes as libtiff reads them, and what it complained about first.
struct Source {
  std::string_view bytes;
  std::uint64_t position = 0;
  bool ended = false;  // something lies beyond the end of the file
  std::string error;
};

tmsize_t read(thandle_t handle, void* to, tmsize_t count) {
  auto& source = *static_cast<Source*>(handle);
  const std::uint64_t size = source.bytes.size(), rest = size - std::min(source.position, size);
  const std::uint64_t wanted = static_cast<std::uint64_t>(std::max<tmsize_t>(count, 0)), given = std::min(wanted, rest);
  source.ended |= given < wanted;
  if (given > 0) std::memcpy(to, source.bytes.data() + source.position, given);
  source.position += given;
  return static_cast<tmsize_t>(given);
}

tmsize_t write_nothing(thandle_t, void*, tmsize_t) { return -1; }

toff_t seek(thandle_t handle, toff_t offset, int whence) {
  auto& source = *static_cast<Source*>(handle);
  const std::uint64_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? source.position : source.bytes.size();
  return source.position = base + offset;
}

int close_nothing(thandle_t) { return 0; }

toff_t size(thandle_t handle) { return static_cast<Source*>(handle)->bytes.size(); }

int map(thandle_t handle, void** base, toff_t* size) {
  auto& source = *static_cast<Source*>(handle);
  *base = const_cast<char*>(source.bytes.data());  // libtiff reads it only: the file is open for reading
  *size = source.bytes.size();
  return 1;
}

void unmap_nothing(thandle_t, void*, toff_t) {}

int on_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  auto& source = *static_cast<Source*>(user);
  char text[300];
  std::vsnprintf(text, sizeof text, format, arguments);
  if (source.error.empty()) source.error = text;
  return 1;  // nothing is printed
}

int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

using Options = std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)>;
using File = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

// Through read(), libtiff tells when a tag's values lie beyond the end, where from a map it just leaves the tag out;
// but its tiles without compression come whole from a map only (libtiff 4.5 compares their size with that of its
// buffer).
enum class Access { calls, map };

File open(Source& source, const std::string& name, Access access) {
  const Options options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  if (!options) throw std::bad_alloc();
  // One strip may hold the largest picture that is read, with four 16-bit channels, and no more.
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), tmsize_t{8} * kLargestSide * (kLargestSide + 1));
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_warning, nullptr);
  source.position = 0;
  return File(TIFFClientOpenExt(name.c_str(), access == Access::map ? "r" : "rm", &source, read, write_nothing, seek,
                                close_nothing, size, map, unmap_nothing, options.get()),
              TIFFClose);
}

// libtiff's RGBA reader multiplies straight alpha into the colours and leaves associated alpha alone. Calling every
// alpha associated makes it leave both alone; true if the file's own alpha was.
bool keep_alpha_as_stored(TIFF* tiff) {
  std::uint16_t count = 0, *kinds = nullptr;
  if (!TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &kinds) || count == 0) return false;
  if (kinds[0] != EXTRASAMPLE_UNASSALPHA) return kinds[0] == EXTRASAMPLE_ASSOCALPHA;
  std::vector<std::uint16_t> changed(kinds, kinds + count);
  changed[0] = EXTRASAMPLE_ASSOCALPHA;
  TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, count, changed.data());
  return false;
}

// Grey of 8 or 16 bits, perhaps with alpha: libtiff's own routines cut 16 bits to 8 instead of rounding, drop the alpha
// beside them, and lose their place in tiles of grey with alpha.
void put_grey(TIFFRGBAImage* image, std::uint32_t* to, std::uint32_t, std::uint32_t, std::uint32_t width,
              std::uint32_t height, std::int32_t skip_from, std::int32_t skip_to, unsigned char* from) {
  const std::ptrdiff_t bytes = image->bitspersample / 8, pixel = bytes * image->samplesperpixel;
  const auto sample = [&](int channel) -> std::uint32_t {
    if (bytes == 1) return from[channel];
    std::uint16_t value;
    std::memcpy(&value, from + 2 * channel, 2);
    return (value + 128u) / 257;
  };
  for (; height > 0; --height) {
    for (std::uint32_t x = 0; x < width; ++x, from += pixel) {
      const std::uint32_t grey = image->photometric == PHOTOMETRIC_MINISWHITE ? 255 - sample(0) : sample(0);
      const std::uint32_t alpha = image->alpha && image->samplesperpixel > 1 ? sample(1) : 255;
      *to++ = grey | grey << 8 | grey << 16 | alpha << 24;
    }
    to += skip_to;
    from += skip_from * pixel;
  }
}

// The stored rows in the order of the file, packed as libtiff does: ABGR from the highest byte down.
bool read_pixels(TIFF* tiff, Picture& picture, std::string& error) {
  char message[1024] = "";
  TIFFRGBAImage image;
  if (!TIFFRGBAImageOK(tiff, message) || !TIFFRGBAImageBegin(&image, tiff, 1, message)) {
    if (error.empty()) error = message;
    return false;
  }
  image.orientation = image.req_orientation = ORIENTATION_TOPLEFT;
  const bool grey = image.photometric == PHOTOMETRIC_MINISBLACK || image.photometric == PHOTOMETRIC_MINISWHITE;
  if (grey && image.isContig && image.bitspersample % 8 == 0) image.put.contig = put_grey;
  const bool done = TIFFRGBAImageGet(&image, reinterpret_cast<std::uint32_t*>(picture.pixels.data()), picture.width,
                                     picture.height) != 0;
  TIFFRGBAImageEnd(&image);
  return done;
}

void unpack(Picture& picture, bool associated) {
  for (Rgba& pixel : picture.pixels) {
    std::uint32_t packed;
    std::memcpy(&packed, &pixel, 4);
    const std::uint32_t a = TIFFGetA(packed);
    const auto channel = [&](std::uint32_t value) {
      return static_cast<std::uint8_t>(associated && a > 0 ? std::min(255u, (value * 255 + a / 2) / a) : value);
    };
    pixel = {channel(TIFFGetR(packed)), channel(TIFFGetG(packed)), channel(TIFFGetB(packed)),
             static_cast<std::uint8_t>(a)};
  }
}

}  // namespace

Picture decode_tiff(std::string_view bytes, const std::string& name) {
  static_assert(sizeof(Rgba) == 4);
  Source source{bytes, 0, false, {}};
  const auto failure = [&] {
    return source.ended ? truncated(name, "TIFF")
                        : damaged(name, "TIFF", source.error.empty() ? "cannot be decoded" : source.error);
  };
  File tiff = open(source, name, Access::calls);
  if (!tiff) throw failure();
  std::uint32_t width = 0, height = 0;
  std::uint16_t orientation = ORIENTATION_TOPLEFT;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_ORIENTATION, &orientation);
  check_size(name, width, height);
  if (source.ended) throw failure();
  tiff = open(source, name, Access::map);
  if (!tiff) throw failure();

  const bool associated = keep_alpha_as_stored(tiff.get());
  Picture picture(static_cast<int>(width), static_cast<int>(height));
  if (!read_pixels(tiff.get(), picture, source.error) || source.ended) throw failure();
  unpack(picture, associated);
  return oriented(std::move(picture), orientation <= 8 ? orientation : 1);
}

}  // namespace carve::codec
