#include "carve/texture/packing.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace carve {
namespace {

using Word = std::uint64_t;

// A shape's rows as bits, in steps of 64.
struct Bits {
  int words;
  std::vector<Word> rows;
};

Bits bits_of(const Mask& shape) {
  Bits bits{(shape.width + 63) / 64, {}};
  bits.rows.assign(static_cast<std::size_t>(bits.words) * shape.height, 0);
  for (int y = 0; y < shape.height; ++y)
    for (int x = 0; x < shape.width; ++x)
      if (shape(x, y)) bits.rows[static_cast<std::size_t>(y) * bits.words + x / 64] |= Word{1} << x % 64;
  return bits;
}

class Sheet {
 public:
  explicit Sheet(int side)
      : side_(side), words_((side + 63) / 64 + 1), rows_(static_cast<std::size_t>(side) * words_) {}

  std::optional<Place> find(const Mask& shape, const Bits& bits) const {
    for (int y = 0; y + shape.height <= side_; ++y)
      for (int x = 0; x + shape.width <= side_;) {
        const int skip = clash(shape, bits, x, y);
        if (skip == 0) return Place{x, y};
        x += skip;
      }
    return std::nullopt;
  }

  void take(const Mask& shape, const Bits& bits, Place place) {
    for (int y = 0; y < shape.height; ++y)
      for (int w = 0; w < bits.words; ++w) {
        const Word word = bits.rows[static_cast<std::size_t>(y) * bits.words + w];
        const int shift = place.x % 64;
        Word* row = &rows_[static_cast<std::size_t>(place.y + y) * words_ + place.x / 64 + w];
        row[0] |= word << shift;
        if (shift && word >> (64 - shift)) row[1] |= word >> (64 - shift);
      }
  }

 private:
  // 0 where the shape fits, else how far it must at least move to the right.
  int clash(const Mask& shape, const Bits& bits, int x, int y) const {
    const int shift = x % 64;
    for (int i = 0; i < shape.height; ++i)
      for (int w = 0; w < bits.words; ++w) {
        const Word* row = &rows_[static_cast<std::size_t>(y + i) * words_ + x / 64 + w];
        const Word taken = shift ? row[0] >> shift | row[1] << (64 - shift) : row[0];
        const Word shape_row = bits.rows[static_cast<std::size_t>(i) * bits.words + w];
        if (!(taken & shape_row)) continue;
        // The first of the shape's cells that clashes must pass all taken cells that follow without a gap.
        const int first = std::countr_zero(taken & shape_row);
        return std::max(1, std::countr_one(taken >> first));
      }
    return 0;
  }

  int side_, words_;
  std::vector<Word> rows_;
};

}  // namespace

std::optional<std::vector<Place>> pack(const std::vector<Mask>& shapes, int side) {
  std::vector<int> order(shapes.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](int a, int b) {
    return std::pair(-shapes[a].height, -shapes[a].width) < std::pair(-shapes[b].height, -shapes[b].width);
  });
  Sheet sheet(side);
  std::vector<Place> places(shapes.size());
  for (const int i : order) {
    const Bits bits = bits_of(shapes[i]);
    const auto place = sheet.find(shapes[i], bits);
    if (!place) return std::nullopt;
    sheet.take(shapes[i], bits, *place);
    places[i] = *place;
  }
  return places;
}

}  // namespace carve
