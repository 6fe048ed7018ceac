#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <stdexcept>

#include "carve/mesh/neighbours.h"
#include "eval/ramp.h"
#include "eval/render.h"
#include "eval/texture_scores.h"

namespace carve {
namespace {

constexpr int kRim = 2;           // pixels beside strokes and background that are not compared
constexpr double kHidden = 0.01;  // how far behind what a drawing sees a point is hidden, object units
constexpr float kGhost = 24;      // RGB distance

// A drawing and the model as seen in it.
struct Seeing {
  const AlignedView* view;
  CameraAxes axes;
  Window window;
  Seen seen;
  Raster<Colour> rendered;
  Mask compared;  // 1 = all, 2 = no other drawing sees it more squarely

  Colour drawn(int x, int y) const {
    const Rgba p = view->drawing.picture(x, y);
    return {float(p.r), float(p.g), float(p.b)};
  }
  bool covered(int x, int y) const { return seen.triangle(x, y) >= 0; }
  Vec3 point(int x, int y) const {
    return (window.right0 + (x + 0.5) * window.right_per_pixel) * axes.right +
           (window.up0 + (y + 0.5) * window.up_per_pixel) * axes.up + seen.depth(x, y) * axes.toward;
  }
  // The pixel a point projects to; negative where the drawing does not see it.
  std::pair<int, int> pixel(const Vec3& p) const {
    const int x = static_cast<int>(std::floor((p.dot(axes.right) - window.right0) / window.right_per_pixel));
    const int y = static_cast<int>(std::floor((p.dot(axes.up) - window.up0) / window.up_per_pixel));
    if (!seen.depth.contains(x, y) || !(p.dot(axes.toward) > seen.depth(x, y) - kHidden)) return {-1, -1};
    return {x, y};
  }
};

Mask trusted(const Drawing& drawing) {
  Mask mask(drawing.labels.width, drawing.labels.height);
  const auto whole = [&](int x, int y) {
    return drawing.labels.contains(x, y) && drawing.labels(x, y) == Label::surface && drawing.coverage(x, y) == 255;
  };
  const Box& box = drawing.bounds;
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x) {
      bool all = true;
      for (int v = y - kRim; v <= y + kRim && all; ++v)
        for (int u = x - kRim; u <= x + kRim && all; ++u) all = whole(u, v);
      mask(x, y) = all;
    }
  return mask;
}

Seeing see(const TexturedMesh& model, const AlignedView& view) {
  const Frame f = frame(view.view);
  const double right = view.column_per_unit * f.right.sign, up = view.row_per_unit * f.up.sign;
  Seeing s{&view, camera(view.view), {}, {}, {}, trusted(view.drawing)};
  const Raster<Label>& labels = view.drawing.labels;
  s.window = {labels.width, labels.height, -view.column0 / right, 1 / right, -view.row0 / up, 1 / up};
  s.seen = rasterise(model.mesh, s.axes, s.window);
  const Raster<Vec2> uvs = seen_uvs(model, s.axes, s.window, s.seen);
  s.rendered = Raster<Colour>(labels.width, labels.height, Colour::Zero());
  for (std::size_t i = 0; i < uvs.pixels.size(); ++i)
    if (s.seen.triangle.pixels[i] >= 0)
      s.rendered.pixels[i] = texture_at(model.texture, uvs.pixels[i]);
    else
      s.compared.pixels[i] = 0;
  return s;
}

class Errors {
 public:
  void add(const Colour& a, const Colour& b) { sum_ += (a - b).squaredNorm(), ++count_; }
  std::optional<double> psnr() const {
    if (count_ == 0) return std::nullopt;
    const double mean = sum_ / (3.0 * static_cast<double>(count_));
    return std::min(100.0, 10 * std::log10(255.0 * 255.0 / std::max(mean, 1e-9)));
  }

 private:
  double sum_ = 0;
  std::int64_t count_ = 0;
};

float grey(const Colour& c) { return 0.299F * c[0] + 0.587F * c[1] + 0.114F * c[2]; }

// SSIM of one window, over those of its pixels that are compared.
double ssim_at(const Seeing& s, int x, int y) {
  constexpr int kReach = 3;
  constexpr double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int v = y - kReach; v <= y + kReach; ++v)
    for (int u = x - kReach; u <= x + kReach; ++u) {
      if (!s.compared.contains(u, v) || s.compared(u, v) != 2) continue;
      const double p = grey(s.rendered(u, v)), q = grey(s.drawn(u, v));
      n += 1, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
    }
  a /= n, b /= n;
  const double va = std::max(0.0, aa / n - a * a), vb = std::max(0.0, bb / n - b * b), covariance = ab / n - a * b;
  return (2 * a * b + c1) * (2 * covariance + c2) / ((a * a + b * b + c1) * (va + vb + c2));
}

// Whether a colour is what some drawing shows at the point, or one pixel beside.
bool is_drawn(const std::vector<Seeing>& all, const Vec3& point, const Vec3& normal, const Colour& colour) {
  for (const Seeing& s : all) {
    if (normal.dot(s.axes.toward) < 0.05) continue;
    const auto [x, y] = s.pixel(point);
    for (int v = y - 1; v <= y + 1 && x >= 0; ++v)
      for (int u = x - 1; u <= x + 1; ++u)
        if (s.compared.contains(u, v) && (s.drawn(u, v) - colour).norm() <= kGhost) return true;
  }
  return false;
}

void mark_own(std::vector<Seeing>& all, const std::vector<Vec3>& normals) {
  for (Seeing& s : all)
    for (int y = 0; y < s.compared.height; ++y)
      for (int x = 0; x < s.compared.width; ++x) {
        if (!s.compared(x, y)) continue;
        const Vec3& normal = normals[s.seen.triangle(x, y)];
        const Vec3 point = s.point(x, y);
        const double here = normal.dot(s.axes.toward);
        const bool own = std::ranges::none_of(all, [&](const Seeing& other) {
          return normal.dot(other.axes.toward) > here + 1e-6 && other.pixel(point).first >= 0;
        });
        if (own) s.compared(x, y) = 2;
      }
}

std::vector<Seeing> see(const TexturedMesh& model, const ViewSet& views, const std::vector<Vec3>& normals) {
  if (model.texture.empty() || model.uv_triangles.size() != model.mesh.triangles.size())
    throw std::invalid_argument("the model must have a texture");
  std::vector<Seeing> all;
  for (const AlignedView& view : views.views) all.push_back(see(model, view));
  mark_own(all, normals);
  return all;
}

}  // namespace

Picture differences(const TexturedMesh& model, const ViewSet& views) {
  constexpr double kRange = 128;
  constexpr int kGap = 8;
  const std::vector<Seeing> all = see(model, views, triangle_normals(model.mesh));
  int width = 0, height = 0;
  for (const AlignedView& view : views.views) {
    width = std::max(width, view.drawing.bounds.width() + kGap);
    height += view.drawing.bounds.height() + kGap;
  }
  Picture sheet(4 * width, height, {255, 255, 255, 255});
  int top = 0;
  for (const Seeing& s : all) {
    const Box& box = s.view->drawing.bounds;
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x) {
        Rgba* row = &sheet(x - box.x0, top + y - box.y0);
        if (s.view->drawing.labels(x, y) != Label::background) row[0] = to_pixel(s.drawn(x, y));
        if (s.covered(x, y)) row[width] = to_pixel(s.rendered(x, y));
        if (s.compared(x, y))
          row[(s.compared(x, y) == 2 ? 2 : 3) * width] =
              colour(Ramp::sequential, (s.rendered(x, y) - s.drawn(x, y)).norm(), kRange);
      }
    top += box.height() + kGap;
  }
  return sheet;
}

RoundTrip round_trip(const TexturedMesh& model, const ViewSet& views) {
  const std::vector<Vec3> normals = triangle_normals(model.mesh);
  const std::vector<Seeing> all = see(model, views, normals);
  Errors own, every, raw;
  double ssim = 0, ghosts = 0;
  std::int64_t owned = 0, compared = 0;
  for (const Seeing& s : all)
    for (int y = 0; y < s.compared.height; ++y)
      for (int x = 0; x < s.compared.width; ++x) {
        if (!s.covered(x, y) || s.view->drawing.labels(x, y) == Label::background) continue;
        const Colour rendered = s.rendered(x, y), drawn = s.drawn(x, y);
        raw.add(rendered, drawn);
        if (!s.compared(x, y)) continue;
        every.add(rendered, drawn);
        ++compared;
        ghosts += !is_drawn(all, s.point(x, y), normals[s.seen.triangle(x, y)], rendered);
        if (s.compared(x, y) != 2) continue;
        own.add(rendered, drawn);
        ++owned;
        ssim += ssim_at(s, x, y);
      }
  RoundTrip result{own.psnr(), every.psnr(), raw.psnr(), {}, {}};
  if (owned) result.ssim = ssim / static_cast<double>(owned);
  if (compared) result.ghosting = ghosts / static_cast<double>(compared);
  return result;
}

std::ostream& operator<<(std::ostream& out, const RoundTrip& r) {
  const auto line = [&](const char* name, const std::optional<double>& value, const char* what) {
    char text[160];
    if (value)
      std::snprintf(text, sizeof text, "%-16s %.4f   %s\n", name, *value, what);
    else
      std::snprintf(text, sizeof text, "%-16s -   %s\n", name, what);
    out << text;
  };
  line("psnr", r.psnr, "dB, pixels that no other drawing sees more squarely");
  line("psnr all", r.psnr_all, "dB, all pixels of surface");
  line("psnr raw", r.psnr_raw, "dB, strokes and rims too");
  line("ssim", r.ssim, "at the pixels of psnr");
  line("ghosting", r.ghosting, "share of pixels whose colour no drawing shows there");
  return out;
}

}  // namespace carve
