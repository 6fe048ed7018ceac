#include <algorithm>
#include <utility>

#include "carve/image/codec.h"

namespace carve::codec {
namespace {

// An unsigned number of `size` bytes at `offset`; the caller has checked the range.
std::uint32_t number(std::string_view bytes, std::size_t offset, int size, bool big_endian) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i) {
    const int shift = 8 * (big_endian ? size - 1 - i : i);
    value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << shift;
  }
  return value;
}

void mirror_rows(Picture& picture) {
  for (int y = 0; y < picture.height; ++y) {
    const auto row = picture.pixels.begin() + static_cast<std::ptrdiff_t>(y) * picture.width;
    std::reverse(row, row + picture.width);
  }
}

void flip_columns(Picture& picture) {
  const auto row = [&](int y) { return picture.pixels.begin() + static_cast<std::ptrdiff_t>(y) * picture.width; };
  for (int y = 0; y < picture.height / 2; ++y) std::swap_ranges(row(y), row(y + 1), row(picture.height - 1 - y));
}

Picture transposed(const Picture& picture) {
  Picture out(picture.height, picture.width);
  constexpr int kBlock = 32;  // both pictures' rows of a block stay in the cache
  for (int y0 = 0; y0 < picture.height; y0 += kBlock)
    for (int x0 = 0; x0 < picture.width; x0 += kBlock)
      for (int y = y0; y < std::min(y0 + kBlock, picture.height); ++y)
        for (int x = x0; x < std::min(x0 + kBlock, picture.width); ++x) out(y, x) = picture(x, y);
  return out;
}

}  // namespace

int exif_orientation(std::string_view tiff) {
  if (tiff.size() < 8) return 1;
  const bool big_endian = tiff[0] == 'M';
  const std::size_t directory = number(tiff, 4, 4, big_endian);
  if (directory + 2 > tiff.size()) return 1;
  const std::size_t entries = number(tiff, directory, 2, big_endian);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    if (entry + 12 > tiff.size()) return 1;
    if (number(tiff, entry, 2, big_endian) != 0x0112) continue;
    const int value = static_cast<int>(number(tiff, entry + 8, 2, big_endian));
    return value >= 1 && value <= 8 ? value : 1;
  }
  return 1;
}

Picture oriented(Picture picture, int orientation) {
  // 5 to 8 are 1 to 4 of the transposed picture.
  if (orientation > 4) picture = transposed(picture), orientation -= 4;
  if (orientation == 2 || orientation == 3) mirror_rows(picture);
  if (orientation == 3 || orientation == 4) flip_columns(picture);
  return picture;
}

}  // namespace carve::codec
