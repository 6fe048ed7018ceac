#include "carve/texture/clean_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace carve {
namespace {

constexpr int kMargin = 4;

// 1 where a pixel of the mask lies within `radius` rows and columns.
Mask dilated(const Mask& mask, int radius) {
  if (radius == 0) return mask;
  Mask rows(mask.width, mask.height), all(mask.width, mask.height);
  const auto spread = [radius](const std::uint8_t* from, std::uint8_t* to, int count, std::size_t stride) {
    int last = -radius - 1;  // the last pixel set so far
    for (int i = 0; i < count + radius; ++i) {
      if (i < count && from[i * stride]) last = i;
      const int at = i - radius;
      if (at >= 0) to[at * stride] = at - last <= radius;
    }
  };
  for (int y = 0; y < mask.height; ++y) spread(&mask(0, y), &rows(0, y), mask.width, 1);
  for (int x = 0; x < mask.width; ++x) spread(&rows(x, 0), &all(x, 0), mask.height, mask.width);
  return all;
}

struct Cut {
  Mask object, paint;  // not background; whole pixels of surface
  CleanDrawing clean;
};

Cut cut_out(const Drawing& drawing, bool inpaint) {
  const Box& box = drawing.bounds;
  const int width = box.width() + 2 * kMargin, height = box.height() + 2 * kMargin;
  Cut cut{Mask(width, height), Mask(width, height), {Picture(width, height), box.x0 - kMargin, box.y0 - kMargin}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int i = x + cut.clean.x0, j = y + cut.clean.y0;
      if (!drawing.labels.contains(i, j)) continue;
      const Rgba p = drawing.picture(i, j);
      cut.clean.picture(x, y) = {p.r, p.g, p.b, 255};
      const Label label = drawing.labels(i, j);
      cut.object(x, y) = label != Label::background;
      cut.paint(x, y) = drawing.coverage(i, j) == 255 && p.a == 255 && (label == Label::surface || !inpaint);
    }
  return cut;
}

// Takes the rim away from `paint`, except where nothing would be left beside it.
void erode(Mask& paint, int fringe) {
  Mask other(paint.width, paint.height);
  for (std::size_t i = 0; i < other.pixels.size(); ++i) other.pixels[i] = !paint.pixels[i];
  Mask core = dilated(other, fringe);
  for (std::uint8_t& c : core.pixels) c = !c;
  const Mask opened = dilated(core, fringe + 1);
  for (std::size_t i = 0; i < paint.pixels.size(); ++i)
    paint.pixels[i] = paint.pixels[i] && (core.pixels[i] || !opened.pixels[i]);
}

// Grows sites through the pixels of `through`, ring by ring; of the sites that reach a pixel in one ring the nearest
// wins.
class Spread {
 public:
  explicit Spread(const Mask& known) : width_(known.width), height_(known.height), site_(known.pixels.size(), -1) {
    for (std::size_t i = 0; i < known.pixels.size(); ++i)
      if (known.pixels[i]) site_[i] = static_cast<int>(i);
  }

  void grow(const Mask& through) {
    std::vector<int> ring;
    for (int i = 0; i < static_cast<int>(site_.size()); ++i)
      if (site_[i] >= 0 && beside_open(i, through)) ring.push_back(i);
    std::vector<int> round(site_.size(), -1), next;
    for (int r = 0; !ring.empty(); ++r, ring.swap(next)) {
      next.clear();
      for (const int i : ring)
        for_each_neighbour(i, [&](int j) {
          if (!through.pixels[j] || (site_[j] >= 0 && round[j] != r)) return;
          if (site_[j] < 0) {
            round[j] = r;
            next.push_back(j);
          } else if (distance2(j, site_[i]) >= distance2(j, site_[j])) {
            return;
          }
          site_[j] = site_[i];
        });
    }
  }
  bool reached(int i) const { return site_[i] >= 0; }
  void settle(int i) { site_[i] = i; }
  const std::vector<int>& sites() const { return site_; }

 private:
  template <class Visit>
  void for_each_neighbour(int i, const Visit& visit) const {
    const int x = i % width_, y = i / width_;
    for (int v = std::max(0, y - 1); v <= std::min(height_ - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(width_ - 1, x + 1); ++u)
        if (u != x || v != y) visit(v * width_ + u);
  }
  bool beside_open(int i, const Mask& through) const {
    bool open = false;
    for_each_neighbour(i, [&](int j) { open |= through.pixels[j] && site_[j] < 0; });
    return open;
  }
  std::int64_t distance2(int i, int j) const {
    const std::int64_t x = i % width_ - j % width_, y = i / width_ - j / width_;
    return x * x + y * y;
  }

  int width_, height_;
  std::vector<int> site_;
};

}  // namespace

void CleanDrawing::sample(double column, double row, float colour[3]) const {
  const double x = std::clamp(column - x0 - 0.5, 0.0, picture.width - 1.0);
  const double y = std::clamp(row - y0 - 0.5, 0.0, picture.height - 1.0);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const int right = i + 1 < picture.width ? 1 : 0, down = j + 1 < picture.height ? picture.width : 0;
  const auto s = static_cast<float>(x - i), t = static_cast<float>(y - j);
  const Rgba* p = &picture(i, j);
  const Rgba &a = p[0], &b = p[right], &c = p[down], &d = p[right + down];
  const auto mix = [&](float a, float b, float c, float d) {
    const float above = a + s * (b - a), below = c + s * (d - c);
    return above + t * (below - above);
  };
  colour[0] = mix(a.r, b.r, c.r, d.r);
  colour[1] = mix(a.g, b.g, c.g, d.g);
  colour[2] = mix(a.b, b.b, c.b, d.b);
}

CleanDrawing clean(const Drawing& drawing, bool inpaint, int fringe) {
  Cut cut = cut_out(drawing, inpaint);
  if (inpaint) erode(cut.paint, fringe);
  Spread spread(cut.paint);
  spread.grow(cut.object);
  for (int i = 0; i < static_cast<int>(cut.object.pixels.size()); ++i)
    if (cut.object.pixels[i] && !spread.reached(i)) spread.settle(i);
  spread.grow(Mask(cut.object.width, cut.object.height, 1));
  Picture filled(cut.object.width, cut.object.height);
  for (std::size_t i = 0; i < filled.pixels.size(); ++i) filled.pixels[i] = cut.clean.picture.pixels[spread.sites()[i]];
  cut.clean.picture = std::move(filled);
  return std::move(cut.clean);
}

}  // namespace carve
