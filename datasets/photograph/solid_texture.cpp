#include "photograph/solid_texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "carve/core/random.h"

namespace carve {
namespace {

// Three channels in [-1, 1] from one number.
Vec3 lattice(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t key) {
  const auto at = [](std::int64_t i) { return static_cast<std::uint64_t>(i + (1 << 20)) & 0x1fffff; };
  const std::uint64_t bits = mixed(key ^ mixed(at(x) | at(y) << 21 | at(z) << 42));
  const auto channel = [&](int shift) { return static_cast<double>(bits >> shift & 0x1fffff) / 0xfffff - 1; };
  return {channel(0), channel(21), channel(42)};
}

Vec3 value_noise(const Vec3& p, std::uint64_t key) {
  const Vec3 low(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  const Vec3 t = p - low;
  const Vec3 w = t.unaryExpr([](double f) { return f * f * (3 - 2 * f); });
  Vec3 sum = Vec3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double weight = (i ? w.x() : 1 - w.x()) * (j ? w.y() : 1 - w.y()) * (k ? w.z() : 1 - w.z());
    sum += weight * lattice(static_cast<std::int64_t>(low.x()) + i, static_cast<std::int64_t>(low.y()) + j,
                            static_cast<std::int64_t>(low.z()) + k, key);
  }
  return sum;
}

}  // namespace

Vec3 noise_colour(const Vec3& place, double side, const SolidTextureOptions& options) {
  constexpr double kContrast = 2.2;  // value noise keeps near 0, and sums of it nearer
  Vec3 sum = Vec3::Zero();
  double size = options.grain / 100 * side;
  for (int octave = 0; octave < options.octaves; ++octave, size *= 2) {
    const std::uint64_t key = mixed(static_cast<std::uint64_t>(options.seed) << 8 | static_cast<unsigned>(octave));
    sum += value_noise(place / size + Vec3::Constant(0.5 * octave), key);
  }
  sum *= kContrast / std::sqrt(static_cast<double>(options.octaves));
  return sum.unaryExpr([](double v) { return 0.5 + 0.5 * std::clamp(v, -1.0, 1.0); });
}

}  // namespace carve
