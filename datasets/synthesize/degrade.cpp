#include "synthesize/degrade.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "carve/core/random.h"
#include "carve/image/read_image.h"
#include "carve/image/write_jpeg.h"

namespace carve {
namespace {

std::uint64_t random_bits(const DegradeOptions& options, View view, int purpose, std::uint64_t place) {
  return mixed(mixed(mixed(static_cast<std::uint64_t>(options.seed)) + static_cast<std::uint64_t>(view) * 16 +
                     static_cast<std::uint64_t>(purpose)) +
               place);
}

enum Purpose { kShift, kScale, kWaverX, kWaverY, kRub, kNoise };

// Value noise in [-1, 1] on a lattice of 24 pixels, smoothly interpolated.
double wave(double x, double y, View view, int purpose, const DegradeOptions& options) {
  constexpr double kLength = 24;
  const double fx = std::floor(x / kLength), fy = std::floor(y / kLength);
  const auto at = [&](int i, int j) {
    const auto column = static_cast<std::uint64_t>(static_cast<std::int64_t>(fx) + i + (1 << 20));
    const auto row = static_cast<std::uint64_t>(static_cast<std::int64_t>(fy) + j + (1 << 20));
    return 2 * unit(random_bits(options, view, purpose, column << 32 | row)) - 1;
  };
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double u = ease(x / kLength - fx), v = ease(y / kLength - fy);
  return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v;
}

void add_noise(Picture& picture, View view, const DegradeOptions& options) {
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    Rgba& p = picture.pixels[i];
    if (p.a == 0) continue;
    int channel = 0;
    for (std::uint8_t* value : {&p.r, &p.g, &p.b}) {
      // Four 16-bit uniforms: variance 4 / 12 of a unit.
      const std::uint64_t bits = random_bits(options, view, kNoise, 4 * i + channel++);
      double sum = -2;
      for (int k = 0; k < 4; ++k) sum += (static_cast<double>(bits >> (16 * k) & 0xffff) + 0.5) / 65536;
      *value =
          static_cast<std::uint8_t>(std::lround(std::clamp(*value + options.noise * sum * std::sqrt(3.0), 0.0, 255.0)));
    }
  }
}

}  // namespace

Misplacement misplacement(View view, const DegradeOptions& options) {
  const std::uint64_t bits = random_bits(options, view, kShift, 0);
  // In turn, so that neighbouring views always disagree.
  const bool grows = ((random_bits(options, View::front, kScale, 0) >> 20) + static_cast<std::uint64_t>(view)) & 1;
  return {1 + (grows ? 1 : -1) * options.rescale / 100, (bits >> 20 & 1 ? 1 : -1) * options.shift,
          (bits >> 40 & 1 ? 1 : -1) * options.shift};
}

std::pair<double, double> waver(double x, double y, View view, const DegradeOptions& options) {
  if (options.jitter == 0) return {0, 0};
  return {options.jitter * wave(x, y, view, kWaverX, options), options.jitter * wave(x, y, view, kWaverY, options)};
}

void rub_out(Raster<std::uint8_t>& ink, double stroke, View view, const DegradeOptions& options) {
  if (options.broken == 0) return;
  std::vector<int> inked;
  std::int64_t total = 0, gone = 0;
  for (std::size_t i = 0; i < ink.pixels.size(); ++i) {
    total += ink.pixels[i];
    if (ink.pixels[i] >= 128) inked.push_back(static_cast<int>(i));
  }
  const double radius = std::hypot(options.gap, stroke) / 2;  // the gap is as long at the stroke's sides
  for (std::uint64_t turn = 0;
       !inked.empty() && static_cast<double>(gone) < options.broken * static_cast<double>(total); ++turn) {
    const std::size_t pick = random_bits(options, view, kRub, turn) % inked.size();
    const int centre = inked[pick], cx = centre % ink.width, cy = centre / ink.width;
    inked[pick] = inked.back();
    inked.pop_back();
    if (ink.pixels[centre] == 0) continue;
    const int reach = static_cast<int>(radius);
    for (int y = std::max(0, cy - reach); y <= std::min(ink.height - 1, cy + reach); ++y)
      for (int x = std::max(0, cx - reach); x <= std::min(ink.width - 1, cx + reach); ++x)
        if (std::hypot(x - cx, y - cy) <= radius) gone += std::exchange(ink(x, y), std::uint8_t{0});
  }
}

Picture reproduce(Picture picture, View view, const DegradeOptions& options) {
  if (options.noise > 0) add_noise(picture, view, options);
  if (options.jpeg) return decode_image(encode_jpeg(picture, *options.jpeg), "JPEG round trip");
  return picture;
}

}  // namespace carve
