#include "synthesize/degrade.h"

#include <algorithm>
#include <cmath>
// jpeglib.h needs size_t and FILE.
#include <cstdio>
// clang-format off
#include <jpeglib.h>
// clang-format on
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "carve/image/read_image.h"

namespace carve {
namespace {

// A counter-based generator (splitmix64's finaliser): any number at any place, whoever asks first.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
std::uint64_t random_bits(const DegradeOptions& options, View view, int purpose, std::uint64_t place) {
  return mixed(mixed(mixed(static_cast<std::uint64_t>(options.seed)) + static_cast<std::uint64_t>(view) * 16 +
                     static_cast<std::uint64_t>(purpose)) +
               place);
}
double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

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

std::uint8_t over_white(std::uint8_t value, std::uint8_t alpha) {
  return static_cast<std::uint8_t>((value * alpha + 255 * (255 - alpha) + 127) / 255);
}

Picture through_jpeg(const Picture& picture, int quality) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  errors.error_exit = [](j_common_ptr common) {
    char message[JMSG_LENGTH_MAX];
    common->err->format_message(common, message);
    throw std::runtime_error(std::string("JPEG: ") + message);
  };
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_create_compress(&info);
  const std::unique_ptr<jpeg_compress_struct, void (*)(jpeg_compress_struct*)> guard(&info, jpeg_destroy_compress);
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<unsigned>(picture.width);
  info.image_height = static_cast<unsigned>(picture.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  jpeg_start_compress(&info, TRUE);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(picture.width) * 3);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Rgba p = picture(x, y);
      row[3 * x] = over_white(p.r, p.a), row[3 * x + 1] = over_white(p.g, p.a), row[3 * x + 2] = over_white(p.b, p.a);
    }
    JSAMPROW line = row.data();
    jpeg_write_scanlines(&info, &line, 1);
  }
  jpeg_finish_compress(&info);
  const std::unique_ptr<unsigned char, void (*)(void*)> owned(bytes, std::free);
  return decode_image(std::string_view(reinterpret_cast<const char*>(bytes), size), "JPEG round trip");
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
  if (options.jpeg) return through_jpeg(picture, *options.jpeg);
  return picture;
}

}  // namespace carve
