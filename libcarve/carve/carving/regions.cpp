#include "carve/carving/regions.h"

#include <algorithm>
#include <cmath>

#include "carve/carving/colour_segments.h"
#include "carve/carving/nearest.h"
#include "carve/carving/region_strokes.h"
#include "carve/carving/stroke_ends.h"
#include "carve/grid/shadow.h"

namespace carve {
namespace {

/// The part of a drawing that shows the object, cut out with a margin of one background pixel.
RegionWindow window_of(const Drawing& drawing) {
  const Box& b = drawing.bounds;
  RegionWindow out{b.x0 - 1, b.y0 - 1, Raster<Label>(b.width() + 2, b.height() + 2, Label::background),
                   Raster<Rgba>(b.width() + 2, b.height() + 2)};
  for (int y = b.y0; y < b.y1; ++y) {
    std::copy_n(&drawing.labels(b.x0, y), b.width(), &out.label(1, y - out.y0));
    std::copy_n(&drawing.picture(b.x0, y), b.width(), &out.colour(1, y - out.y0));
  }
  return out;
}

/// Where one of a pixel and its eight neighbours is set; nothing on the raster's rim.
Mask grown(const Mask& mask) {
  Mask out(mask.width, mask.height);
  for (int y = 1; y + 1 < mask.height; ++y)
    for (int x = 1; x + 1 < mask.width; ++x)
      for (int row = y - 1; row <= y + 1; ++row) out(x, y) |= mask(x - 1, row) | mask(x, row) | mask(x + 1, row);
  return out;
}

}  // namespace

class CutDrawing::Work {
 public:
  Work(const AlignedView& view, double longest, const RegionOptions& options)
      : view_(view),
        scale_(std::min(std::abs(view.column_per_unit), std::abs(view.row_per_unit))),
        voxel_(scale_ * longest / 128),
        window_(window_of(view.drawing)),
        background_(where(window_.label, Label::background)),
        edge_(cleaned(options)),
        surface_(where(window_.label, Label::surface)),
        stroke_(stroke_width(edge_)),
        nearest_surface_(surface_),
        part_(parts(options)),
        segment_(part_),
        inner_(inner_strokes()),
        nearest_inner_(inner_) {
    if (options.colours) split_by_colour();
  }

  RegionMap on(const VoxelGrid& hull) const {
    RegionMap out;
    out.view = view_.view;
    const Mask seen = shadow(hull, view_.view);
    const Sample at = sample(seen, hull);
    const std::vector<int> name = name_regions(out, at);
    find_colours(out, name);
    find_borders(out, at, std::max(voxel_, scale_ * hull.spacing()));
    return out;
  }

 private:
  /// The window's pixel at each grid pixel's centre, and the surface pixel that stands for it; -1: none.
  struct Sample {
    Raster<int> pixel, surface;
  };

  /// The strokes, the false ones dropped from the window.
  Mask cleaned(const RegionOptions& options) {
    constexpr double kInARow = 4;  // gaps as long as the outline's that may follow each other
    const double broken = std::min(64.0, kInARow * outline_gap(window_.label)), gap = std::max(options.gap, broken);
    gap_ = gap;
    broken_ = broken > 0;
    drop_false_strokes(window_, background_, stroke_width(where(window_.label, Label::edge)), gap, 4 * voxel_);
    component_ = stroke_components(window_.label, gap);
    if (broken > 0) fill_specks(window_.label, component_, 4 * voxel_ * voxel_);
    return where(window_.label, Label::edge);
  }

  /// Outlines are strokes that run along the background; what counts as a discontinuity lies further inside.
  Mask inner_strokes() const {
    Mask inner(edge_.width, edge_.height);
    for (int y = 0; y < edge_.height; ++y)
      for (int x = 0; x < edge_.width; ++x) inner(x, y) = edge_(x, y) && background_(x, y, 1.5 * stroke_ + 1) < 0;
    return inner;
  }

  /// In a drawing whose outline has gaps, an end is most likely one too.
  Raster<int> parts(const RegionOptions& options) const {
    if (broken_) return component_;
    const double longest = options.ends / 100 * std::max(edge_.width, edge_.height);
    return longest >= 1 ? cut_at_ends(window_.label, component_, stroke_, gap_, longest) : component_;
  }

  /// Within a part the anti-aliased rim takes the nearest colour segment; across parts it must not.
  void split_by_colour() {
    Mask clean(edge_.width, edge_.height);
    Mask other(edge_.width, edge_.height);
    for (std::size_t i = 0; i < other.pixels.size(); ++i) other.pixels[i] = !surface_.pixels[i];
    const Mask rim = grown(other);
    for (std::size_t i = 0; i < clean.pixels.size(); ++i) clean.pixels[i] = surface_.pixels[i] && !rim.pixels[i];
    const Raster<int> colours = colour_segments(part_, window_.colour, clean, std::max(1.0, voxel_ * voxel_));
    const NearestSet nearest(clean);
    for (int y = 0; y < edge_.height; ++y)
      for (int x = 0; x < edge_.width; ++x) {
        if (!surface_(x, y)) continue;
        const int colour = clean(x, y) ? y * edge_.width + x : nearest(x, y);
        if (colour >= 0 && part_.pixels[colour] == part_(x, y)) segment_(x, y) = colours.pixels[colour];
      }
  }

  /// The surface pixel that a pixel takes its region from; -1 if there is none.
  int labelled(int pixel) const {
    return surface_.pixels[pixel] ? pixel : nearest_surface_(pixel % edge_.width, pixel / edge_.width);
  }

  Sample sample(const Mask& seen, const VoxelGrid& hull) const {
    Sample out{Raster<int>(seen.width, seen.height, -1), Raster<int>(seen.width, seen.height, -1)};
    const Frame f = frame(view_.view);
    const auto coordinate = [&](SignedAxis axis, int i, int n) {
      const int index = axis.sign > 0 ? i : n - 1 - i;
      return hull.low()[axis.axis] + (index + 0.5) * hull.spacing();
    };
    for (int j = 0; j < seen.height; ++j)
      for (int i = 0; i < seen.width; ++i) {
        if (!seen(i, j)) continue;
        const double a = coordinate(f.right, i, seen.width), b = coordinate(f.up, seen.height - 1 - j, seen.height);
        const int x = std::clamp(static_cast<int>(std::floor(view_.column(a))) - window_.x0, 0, edge_.width - 1);
        const int y = std::clamp(static_cast<int>(std::floor(view_.row(b))) - window_.y0, 0, edge_.height - 1);
        out.pixel(i, j) = y * edge_.width + x;
        out.surface(i, j) = labelled(out.pixel(i, j));
      }
    return out;
  }

  /// \return each segment's region
  std::vector<int> name_regions(RegionMap& out, const Sample& sample) const {
    std::vector<int> name(segment_.pixels.size() + 1, -1);  // one more: of a drawing without surface
    out.region = Raster<int>(sample.pixel.width, sample.pixel.height, -1);
    for (std::size_t k = 0; k < sample.pixel.pixels.size(); ++k) {
      if (sample.pixel.pixels[k] < 0) continue;
      const int at = sample.surface.pixels[k];
      int& region = at < 0 ? name.back() : name[segment_.pixels[at]];
      if (region < 0) region = out.count++;
      out.region.pixels[k] = region;
    }
    return name;
  }

  void find_colours(RegionMap& out, const std::vector<int>& name) const {
    out.colour.assign(out.count, Vec3::Zero());
    std::vector<double> weight(out.count, 0);
    for (std::size_t i = 0; i < segment_.pixels.size();) {
      const int segment = segment_.pixels[i];
      const std::size_t begin = i;
      std::int64_t red = 0, green = 0, blue = 0;
      for (; i < segment_.pixels.size() && segment_.pixels[i] == segment; ++i) {
        const Rgba& c = window_.colour.pixels[i];
        red += c.r, green += c.g, blue += c.b;
      }
      const int region = segment < 0 ? -1 : name[segment];
      if (region < 0) continue;
      out.colour[region] += Vec3(red, green, blue);
      weight[region] += i - begin;
    }
    for (int r = 0; r < out.count; ++r)
      if (weight[r] > 0) out.colour[r] /= weight[r];
  }

  /// The middle of a stroke lies where the nearest surface pixels of two neighbours are on its two sides.
  bool crossed(int p, int q) const {
    const int w = edge_.width, x0 = p % w, y0 = p / w, x1 = q % w, y1 = q / w;
    const int n = std::max({1, std::abs(x1 - x0), std::abs(y1 - y0)});
    for (int k = 0; k < n; ++k) {
      const int ax = x0 + (x1 - x0) * k / n, ay = y0 + (y1 - y0) * k / n;
      const int bx = x0 + (x1 - x0) * (k + 1) / n, by = y0 + (y1 - y0) * (k + 1) / n;
      if (!inner_(ax, ay) && !inner_(bx, by)) continue;
      const int a = labelled(ay * w + ax), b = labelled(by * w + bx);
      if (a < 0 || b < 0) continue;
      if (std::hypot(a % w - b % w, a / w - b / w) >= 0.75 * stroke_) return true;
    }
    return false;
  }

  /// \param voxel  pixels; what is near does not shrink on finer grids
  void find_borders(RegionMap& out, const Sample& sample, double voxel) const {
    constexpr double kNear = 1.5;  // voxels
    const int w = edge_.width, width = sample.pixel.width, height = sample.pixel.height;
    Mask near(width, height);
    for (std::size_t k = 0; k < sample.pixel.pixels.size(); ++k)
      if (const int p = sample.pixel.pixels[k]; p >= 0)
        near.pixels[k] = nearest_inner_.distance(p % w, p / w, kNear * voxel) < kNear * voxel;
    const auto border = [&](int i, int j, int di, int dj) {
      if (i + di >= width || j + dj >= height) return Border::near;
      const int p = sample.pixel(i, j), q = sample.pixel(i + di, j + dj);
      if (p < 0 || q < 0) return Border::near;
      const int a = sample.surface(i, j), b = sample.surface(i + di, j + dj);
      const bool one = (a < 0 ? -1 : component_.pixels[a]) == (b < 0 ? -1 : component_.pixels[b]);
      if (!one) return crossed(p, q) ? Border::stroke : Border::near;
      if (crossed(p, q)) return Border::open;
      if (near(i, j) || near(i + di, j + dj)) return Border::near;
      if (out.region(i, j) == out.region(i + di, j + dj)) return Border::none;
      return a >= 0 && b >= 0 && part_.pixels[a] == part_.pixels[b] ? Border::colour : Border::none;
    };
    out.right = out.below = Raster<Border>(width, height, Border::near);
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        out.right(i, j) = border(i, j, 1, 0);
        out.below(i, j) = border(i, j, 0, 1);
      }
  }

  const AlignedView& view_;
  double scale_;  // pixels per unit
  double voxel_;  // of a grid of 128, in pixels: how fine the drawing is cut does not depend on the grid
  RegionWindow window_;
  NearestSet background_;
  double gap_ = 0;         // in strokes, in pixels
  bool broken_ = false;    // the outline has gaps
  Raster<int> component_;  // of surface pixels, between strokes
  Mask edge_, surface_;
  double stroke_;  // width in pixels
  NearestSet nearest_surface_;
  Raster<int> part_;     // of surface pixels: a component, or what strokes that end in it cut it into
  Raster<int> segment_;  // of surface pixels, of one colour
  Mask inner_;           // strokes
  NearestSet nearest_inner_;
};

CutDrawing::CutDrawing(const AlignedView& view, double longest, const RegionOptions& options)
    : work_(std::make_shared<const Work>(view, longest, options)) {}

RegionMap CutDrawing::on(const VoxelGrid& hull) const { return work_->on(hull); }

RegionMap find_regions(const AlignedView& view, const VoxelGrid& hull, const RegionOptions& options) {
  return CutDrawing(view, hull.size().maxCoeff() * hull.spacing(), options).on(hull);
}

}  // namespace carve
