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
    const Vec2 step = inwards(x, y);
    const Vec3 here = difference(x, y);
    if (step.isZero() || !comes_from_paper(x, y, step, here)) return 1;
    const Vec3 inside = unmixed(x, y, step, here);
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

  static std::pair<int, int> walk(int x, int y, const Vec2& step, int count) {
    return {x + static_cast<int>(std::lround(count * step.x())), y + static_cast<int>(std::lround(count * step.y()))};
  }

  // Nothing stands between the pixel and the background that is less like paper than the pixel: a stroke, say.
  bool comes_from_paper(int x, int y, const Vec2& step, const Vec3& here) const {
    for (int i = 1; i < kSoft; ++i) {
      const auto [u, v] = walk(x, y, step, -i);
      if (!picture_.contains(u, v) || ground_.background(u, v)) break;
      if (difference(u, v).norm() > here.norm() + kPlateau) return false;
    }
    return true;
  }

  // Walks inwards while the colour still moves away from the paper's.
  Vec3 unmixed(int x, int y, const Vec2& step, const Vec3& here) const {
    Vec3 colour = here;
    for (int i = 1; i <= kDeepest; ++i) {
      const auto [u, v] = walk(x, y, step, i);
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

Neighbourhood::Neighbourhood(const Mask& mask, int radius)
    : mask_(mask), radius_(radius), columns_(mask.width + 2 * radius), near_(mask.width) {}

const std::uint8_t* Neighbourhood::row(int y) {
  const int width = mask_.width;
  std::fill(columns_.begin(), columns_.end(), 0);
  for (int v = std::max(0, y - radius_); v <= std::min(mask_.height - 1, y + radius_); ++v) {
    const std::uint8_t* row = &mask_(0, v);
    std::uint8_t* to = columns_.data() + radius_;
    for (int x = 0; x < width; ++x) to[x] |= row[x];
  }
  std::fill(near_.begin(), near_.end(), 0);
  for (int shift = 0; shift <= 2 * radius_; ++shift) {
    const std::uint8_t* from = columns_.data() + shift;
    for (int x = 0; x < width; ++x) near_[x] |= from[x];
  }
  return near_.data();
}

namespace {

// The object's specks in a lossy drawing: ripples that hung together with it by its borders' mixed pixels.
void clear_lossy_specks(Mask& coverage) {
  Mask object(coverage.width, coverage.height);
  std::transform(coverage.pixels.begin(), coverage.pixels.end(), object.pixels.begin(), [](int c) { return c >= 128; });
  clear_specks(object, 1, 0, kLargestSpeck);
  for (std::size_t i = 0; i < object.pixels.size(); ++i)
    if (!object.pixels[i] && coverage.pixels[i] >= 128) coverage.pixels[i] = 0;
}

}  // namespace

Mask estimate_coverage(const Picture& picture, const Ground& ground) {
  Mask coverage(picture.width, picture.height);
  if (ground.colour.a == 0) {
    for (std::size_t i = 0; i < coverage.pixels.size(); ++i) {
      const std::uint8_t alpha = picture.pixels[i].a;
      coverage.pixels[i] = !ground.background.pixels[i] && alpha < 128 ? 255 : alpha;  // enclosed by strokes
    }
    return coverage;
  }
  const Mixture mixture(picture, ground);
  Neighbourhood neighbourhood(ground.background, kSoft);
  for (int y = 0; y < picture.height; ++y) {
    const std::uint8_t* near = neighbourhood.row(y);
    for (int x = 0; x < picture.width; ++x) {
      if (ground.background(x, y)) continue;
      coverage(x, y) = near[x] ? static_cast<std::uint8_t>(std::lround(255 * mixture.share(x, y))) : 255;
    }
  }
  if (ground.lossy) clear_lossy_specks(coverage);
  return coverage;
}

}  // namespace carve::labelling
