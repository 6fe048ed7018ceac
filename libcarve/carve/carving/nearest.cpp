#include "carve/carving/nearest.h"

#include <algorithm>
#include <cmath>

namespace carve {

NearestSet::NearestSet(const Mask& mask) : width_(mask.width), height_(mask.height), column_(mask.pixels.size()) {
  for (int y = 0; y < height_; ++y) {
    std::int16_t* row = column_.data() + static_cast<std::size_t>(y) * width_;
    int last = -1;
    for (int x = 0; x < width_; ++x) {
      if (mask(x, y)) last = x;
      row[x] = static_cast<std::int16_t>(last);
    }
    last = -1;
    for (int x = width_ - 1; x >= 0; --x) {
      if (row[x] == x) last = x;
      if (last >= 0 && (row[x] < 0 || last - x < x - row[x])) row[x] = static_cast<std::int16_t>(last);
    }
  }
}

int NearestSet::operator()(int x, int y, double limit) const {
  enum Side { left, above, right, below };
  const double reach = std::min(limit, static_cast<double>(width_) + height_);
  auto least = static_cast<std::int64_t>(std::floor(reach * reach)) + 1;
  int nearest = -1;
  Side found = below;
  const auto look = [&](int at, Side side) {
    const int column = column_[static_cast<std::size_t>(at) * width_ + x];
    if (column < 0) return;
    const std::int64_t dx = column - x, dy = at - y, distance = dx * dx + dy * dy;
    if (at == y && dx > 0) side = right;
    if (distance > least || (distance == least && side >= found)) return;
    least = distance, found = side, nearest = at * width_ + column;
  };
  look(y, left);
  for (std::int64_t k = 1; k * k <= least && (k <= y || k < height_ - y); ++k) {
    if (k <= y) look(y - static_cast<int>(k), above);
    if (k < height_ - y) look(y + static_cast<int>(k), below);
  }
  return nearest;
}

double NearestSet::distance(int x, int y, double limit) const {
  const int nearest = (*this)(x, y, limit);
  if (nearest < 0) return std::numeric_limits<double>::infinity();
  const int dx = nearest % width_ - x, dy = nearest / width_ - y;
  return std::sqrt(static_cast<double>(dx) * dx + static_cast<double>(dy) * dy);
}

Raster<std::uint16_t> squared_distances(const Mask& mask, int limit) {
  const auto most = static_cast<std::uint16_t>(limit * limit);
  const int w = mask.width, h = mask.height;
  Raster<std::uint16_t> in_row(w, h, most), result(w, h, most);
  for (int y = 0; y < h; ++y) {
    std::uint16_t* row = &in_row(0, y);
    const auto scan = [&](int first, int end, int step) {
      int away = limit;
      for (int x = first; x != end; x += step) {
        away = mask(x, y) ? 0 : std::min(away + 1, limit);
        row[x] = std::min(row[x], static_cast<std::uint16_t>(away * away));
      }
    };
    scan(0, w, 1);
    scan(w - 1, -1, -1);
  }
  for (int y = 0; y < h; ++y) {
    std::uint16_t* to = &result(0, y);
    for (int other = std::max(0, y - limit); other <= std::min(h - 1, y + limit); ++other) {
      const auto down = static_cast<std::uint16_t>((other - y) * (other - y));
      const std::uint16_t* from = &in_row(0, other);
      for (int x = 0; x < w; ++x) {
        const auto sum = static_cast<std::uint16_t>(from[x] + down);
        to[x] = std::min(to[x], sum);
      }
    }
  }
  return result;
}

}  // namespace carve
