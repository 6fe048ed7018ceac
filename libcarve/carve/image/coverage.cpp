#include <algorithm>
#include <cmath>

#include "carve/core/vector.h"
#include "carve/image/labelling.h"

namespace carve::labelling {
namespace {

constexpr int kSoft = 2;        // pixels beside the background that may be a mixture of it and the object
constexpr int kDeepest = 3;     // pixels further in where the unmixed colour is looked for
constexpr double kPlateau = 8;  // colours that differ less are one

class Mixture {
 public:
  Mixture(const Picture& picture, const Ground& ground) : picture_(picture), ground_(ground) {}

  // How much of the pixel the object covers: its colour's place between the paper's and the first unmixed colour
  // inwards. 1 where no direction leads inwards (a line one pixel wide) or the colour is no such mixture.
  double share(int x, int y) const {
    const Vec3 here = difference(x, y);
    const Vec3 inside = unmixed(x, y, here);
    const double length2 = inside.squaredNorm();
    if (length2 <= here.squaredNorm()) return 1;
    const double share = here.dot(inside) / length2;
    const double off = (here - share * inside).norm();
    return off > 0.5 * here.norm() + kPlateau ? 1 : std::clamp(share, 0.0, 1.0);
  }

 private:
  // Of the pixel's colour from the paper's.
  Vec3 difference(int x, int y) const {
    const Rgba c = over(picture_(x, y), ground_.colour), p = ground_.colour;
    return Vec3(c.r - p.r, c.g - p.g, c.b - p.b);
  }

  // Away from the background pixels around, the nearest most.
  Vec2 inwards(int x, int y) const {
    Vec2 sum = Vec2::Zero();
    for (int dy = -kSoft; dy <= kSoft; ++dy)
      for (int dx = -kSoft; dx <= kSoft; ++dx) {
        const int d2 = dx * dx + dy * dy;
        if (d2 == 0 || !ground_.background.contains(x + dx, y + dy) || !ground_.background(x + dx, y + dy)) continue;
        sum -= Vec2(dx, dy) / (d2 * d2);
      }
    const double longest = sum.cwiseAbs().maxCoeff();
    return longest < 1e-9 ? Vec2(0, 0) : Vec2(sum / longest);
  }

  // Walks inwards while the colour still moves away from the paper's.
  Vec3 unmixed(int x, int y, const Vec3& here) const {
    const Vec2 step = inwards(x, y);
    Vec3 colour = here;
    if (step.isZero()) return colour;
    for (int i = 1; i <= kDeepest; ++i) {
      const int u = x + static_cast<int>(std::lround(i * step.x())),
                v = y + static_cast<int>(std::lround(i * step.y()));
      if (!picture_.contains(u, v) || ground_.background(u, v)) break;
      const Vec3 next = difference(u, v);
      if (next.norm() < colour.norm() + kPlateau) break;
      colour = next;
    }
    return colour;
  }

  const Picture& picture_;
  const Ground& ground_;
};

}  // namespace

void near_row(const Mask& mask, int y, int radius, std::vector<std::uint8_t>& near) {
  const int width = mask.width;
  std::vector<std::uint8_t> rows(width + 2 * radius, 0);
  for (int v = std::max(0, y - radius); v <= std::min(mask.height - 1, y + radius); ++v) {
    const std::uint8_t* row = &mask(0, v);
    for (int x = 0; x < width; ++x) rows[x + radius] |= row[x];
  }
  near.assign(width, 0);
  for (int shift = 0; shift <= 2 * radius; ++shift)
    for (int x = 0; x < width; ++x) near[x] |= rows[x + shift];
}

Mask estimate_coverage(const Picture& picture, const Ground& ground) {
  Mask coverage(picture.width, picture.height);
  if (ground.rule == Background::alpha) {
    std::transform(picture.pixels.begin(), picture.pixels.end(), coverage.pixels.begin(), [](Rgba p) { return p.a; });
    return coverage;
  }
  const Mixture mixture(picture, ground);
  std::vector<std::uint8_t> near;
  for (int y = 0; y < picture.height; ++y) {
    near_row(ground.background, y, kSoft, near);
    for (int x = 0; x < picture.width; ++x) {
      if (ground.background(x, y)) continue;
      coverage(x, y) = near[x] ? static_cast<std::uint8_t>(std::lround(255 * mixture.share(x, y))) : 255;
    }
  }
  return coverage;
}

}  // namespace carve::labelling
