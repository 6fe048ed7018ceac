#include <algorithm>

#include "carve/image/labelling.h"

namespace carve::labelling {

std::size_t Flood::operator()(int x, int y, std::uint8_t from, std::uint8_t to) {
  std::size_t count = 0;
  seeds_.emplace_back(x, y);
  while (!seeds_.empty()) {
    const auto [seed_x, seed_y] = seeds_.back();
    seeds_.pop_back();
    std::uint8_t* row = &places_(0, seed_y);
    if (row[seed_x] != from) continue;
    int first = seed_x, last = seed_x;
    while (first > 0 && row[first - 1] == from) --first;
    while (last + 1 < places_.width && row[last + 1] == from) ++last;
    std::fill(row + first, row + last + 1, to);
    count += last - first + 1;
    for (const int beside : {seed_y - 1, seed_y + 1})
      if (beside >= 0 && beside < places_.height)
        push_runs(std::max(0, first - reach_), std::min(places_.width - 1, last + reach_), beside, from);
  }
  return count;
}

void Flood::push_runs(int first, int last, int y, std::uint8_t value) {
  const std::uint8_t* row = &places_(0, y);
  for (int x = first; x <= last; ++x)
    if (row[x] == value && (x == first || row[x - 1] != value)) seeds_.emplace_back(x, y);
}

void flood_from_border(Mask& places) {
  Flood flood(places);
  for_each_border_pixel(places.width, places.height, [&](int x, int y) {
    if (places(x, y) == enclosed) flood(x, y, enclosed, outside);
  });
}

void replace(Mask& mask, std::uint8_t from, std::uint8_t to) {
  for (std::uint8_t& value : mask.pixels) value = value == from ? to : value;
}

void clear_specks(Mask& mask, std::uint8_t from, std::uint8_t to, std::size_t largest) {
  Flood flood(mask, Flood::corners);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask(x, y) == from && flood(x, y, from, seen) <= largest) flood(x, y, seen, to);
  replace(mask, seen, from);
}

}  // namespace carve::labelling
