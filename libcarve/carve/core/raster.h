#pragma once
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace carve {

/// A rectangle of values, row by row; (0, 0) is the top left pixel and y points down, as in image files.
template <class T>
struct Raster {
  int width = 0, height = 0;
  std::vector<T> pixels;  // pixels[y * width + x]

  Raster() = default;
  Raster(int w, int h, T fill = T{}) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, fill) {}

  T& operator()(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const T& operator()(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  bool empty() const { return pixels.empty(); }
  bool operator==(const Raster&) const = default;
};

/// 8 bits a channel, sRGB, alpha not premultiplied.
struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  bool operator==(const Rgba&) const = default;
};
using Picture = Raster<Rgba>;
using Mask = Raster<std::uint8_t>;  // 1 = inside

/// What a pixel of a drawing says (thesis 3.1.1): nothing, the object's surface, or a stroke = a surface discontinuity.
enum class Label : std::uint8_t { background, surface, edge };

/// Half-open rectangle of pixels: x0 <= x < x1, y0 <= y < y1.
struct Box {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  bool operator==(const Box&) const = default;
};

}  // namespace carve
