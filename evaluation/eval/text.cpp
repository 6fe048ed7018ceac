#include "eval/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "carve/core/embed.h"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_truetype.h>

CARVE_EMBED(unsigned char, carve_font, CARVE_FONT);

namespace carve {
namespace {

const stbtt_fontinfo& font() {
  static const stbtt_fontinfo info = [] {
    stbtt_fontinfo loaded;
    if (!stbtt_InitFont(&loaded, carve_font, 0)) throw std::runtime_error("the built-in font cannot be read");
    return loaded;
  }();
  return info;
}

// Code points of UTF-8; what is not UTF-8 becomes the replacement character.
std::vector<int> code_points(std::string_view text) {
  std::vector<int> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i++]);
    const int more = byte < 0x80 ? 0 : byte >> 5 == 6 ? 1 : byte >> 4 == 14 ? 2 : byte >> 3 == 30 ? 3 : -1;
    int point = more < 0 ? 0xfffd : more == 0 ? byte : byte & (0x3f >> more);
    for (int k = 0; k < more; ++k) {
      if (i == text.size() || (text[i] & 0xc0) != 0x80) {
        point = 0xfffd;
        break;
      }
      point = point << 6 | (text[i++] & 0x3f);
    }
    out.push_back(point);
  }
  return out;
}

void blend(Picture& picture, int x, int y, Rgba colour, int coverage) {
  if (!picture.contains(x, y)) return;
  Rgba& under = picture(x, y);
  const auto channel = [coverage](int from, int to) {
    return static_cast<std::uint8_t>((from * (255 - coverage) + to * coverage + 127) / 255);
  };
  under = {channel(under.r, colour.r), channel(under.g, colour.g), channel(under.b, colour.b),
           channel(under.a, colour.a)};
}

}  // namespace

double text_width(double size, std::string_view text) {
  const double scale = stbtt_ScaleForPixelHeight(&font(), static_cast<float>(size));
  double width = 0;
  for (const int point : code_points(text)) {
    int advance, bearing;
    stbtt_GetCodepointHMetrics(&font(), point, &advance, &bearing);
    width += scale * advance;
  }
  return width;
}

void draw_text(Picture& picture, double x, double y, double size, std::string_view text, Align align, Rgba colour) {
  const float scale = stbtt_ScaleForPixelHeight(&font(), static_cast<float>(size));
  if (align != Align::left) x -= text_width(size, text) * (align == Align::centre ? 0.5 : 1);
  for (const int point : code_points(text)) {
    int advance, bearing, x0, y0, x1, y1;
    stbtt_GetCodepointHMetrics(&font(), point, &advance, &bearing);
    const auto shift = static_cast<float>(x - std::floor(x));
    stbtt_GetCodepointBitmapBoxSubpixel(&font(), point, scale, scale, shift, 0, &x0, &y0, &x1, &y1);
    const int width = std::max(0, x1 - x0), height = std::max(0, y1 - y0);
    std::vector<unsigned char> ink(static_cast<std::size_t>(width) * height);
    if (!ink.empty())
      stbtt_MakeCodepointBitmapSubpixel(&font(), ink.data(), width, height, width, scale, scale, shift, 0, point);
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i)
        blend(picture, static_cast<int>(std::floor(x)) + x0 + i, static_cast<int>(std::lround(y)) + y0 + j, colour,
              ink[static_cast<std::size_t>(j) * width + i]);
    x += scale * advance;
  }
}

}  // namespace carve
