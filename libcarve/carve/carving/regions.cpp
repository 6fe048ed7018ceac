#include "carve/carving/regions.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "carve/carving/colour_segments.h"
#include "carve/carving/nearest.h"
#include "carve/carving/region_strokes.h"
#include "carve/carving/stroke_ends.h"
#include "carve/grid/edge_crossings.h"
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

  RegionBorders borders(const RegionMap& map, const VoxelGrid& hull) const {
    const int w = edge_.width, h = edge_.height, width = map.region.width, height = map.region.height;
    const std::vector<double> column = columns(hull), row = rows(hull);
    RegionBorders out{view_.view, Raster<float>(width, height, 0), Raster<float>(width, height, 0)};
    const auto parted = [&](int i, int j, int m, int n) {
      return m < width && n < height && map.region(i, j) >= 0 && map.region(m, n) >= 0 &&
             map.region(i, j) != map.region(m, n);
    };
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        if (parted(i, j, i + 1, j))
          out.right(i, j) = border_between({pixel_at(row[j], h) * w, 1, w}, column[i], column[i + 1]);
        if (parted(i, j, i, j + 1))
          out.below(i, j) = border_between({pixel_at(column[i], w), w, h}, row[j], row[j + 1]);
      }
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

  /// Columns of the grid pixels' centres in the window.
  std::vector<double> columns(const VoxelGrid& hull) const {
    const ShadowLayout layout(hull.size(), view_.view);
    std::vector<double> out(layout.width);
    for (int i = 0; i < layout.width; ++i)
      out[i] = view_.column(centre(hull, layout.frame.right.axis, layout.right_index(i))) - window_.x0;
    return out;
  }
  /// Their rows.
  std::vector<double> rows(const VoxelGrid& hull) const {
    const ShadowLayout layout(hull.size(), view_.view);
    std::vector<double> out(layout.height);
    for (int j = 0; j < layout.height; ++j)
      out[j] = view_.row(centre(hull, layout.frame.up.axis, layout.up_index(j))) - window_.y0;
    return out;
  }
  static double centre(const VoxelGrid& hull, int axis, int index) {
    return hull.low()[axis] + (index + 0.5) * hull.spacing();
  }
  /// The pixel at a place along a line of `count`.
  static int pixel_at(double place, int count) { return std::clamp(static_cast<int>(std::floor(place)), 0, count - 1); }

  Sample sample(const Mask& seen, const VoxelGrid& hull) const {
    Sample out{Raster<int>(seen.width, seen.height, -1), Raster<int>(seen.width, seen.height, -1)};
    const std::vector<double> column = columns(hull), row = rows(hull);
    for (int j = 0; j < seen.height; ++j)
      for (int i = 0; i < seen.width; ++i) {
        if (!seen(i, j)) continue;
        out.pixel(i, j) = pixel_at(row[j], edge_.height) * edge_.width + pixel_at(column[i], edge_.width);
        out.surface(i, j) = labelled(out.pixel(i, j));
      }
    return out;
  }

  /// A row or a column of the window.
  struct Line {
    int first, step, count;
    int operator()(int k) const { return first + step * k; }
  };

  /// Where on the way along a line from the centre of one grid pixel to the next its segment ends and the other's
  /// begins, as a share of the way; 0 if others lie between them.
  float border_between(const Line& line, double from, double to) const {
    const int a = pixel_at(from, line.count), b = pixel_at(to, line.count), step = b > a ? 1 : -1;
    const auto segment = [&](int k) {
      const int at = labelled(line(k));
      return at < 0 ? -1 : segment_.pixels[at];
    };
    const int here = segment(a), there = segment(b);
    int k = a;
    while (k != b && segment(k) == here) k += step;
    if (here == there || segment(k) != there) return 0;
    const double place = stroke_middle(line, k - step, k).value_or(std::max(k, k - step));
    return std::clamp(static_cast<float>((place - from) / (to - from)), kClearance, 1 - kClearance);
  }

  /// The middle of the ink of the stroke that one of two pixels of a line belongs to; none if there is no stroke, or
  /// one that runs along the line.
  std::optional<double> stroke_middle(const Line& line, int p, int q) const {
    const auto drawn = [&](int k) { return k >= 0 && k < line.count && edge_.pixels[line(k)]; };
    if (!drawn(p) && !drawn(q)) return {};
    const int longest = static_cast<int>(2 * stroke_) + 2;  // of a stroke across the line, or aslant
    int first = drawn(p) ? p : q, last = first;
    while (drawn(first - 1) && last - first < longest) --first;
    while (drawn(last + 1) && last - first < longest) ++last;
    if (last - first >= longest) return {};
    const auto brightness = [&](int k) {
      const Rgba& c = window_.colour.pixels[line(std::clamp(k, 0, line.count - 1))];
      return (c.r + c.g + c.b) / 3.0;
    };
    constexpr int kRim = 1;  // pixels that are a stroke's in part only
    const double before = brightness(first - kRim - 1), after = brightness(last + kRim + 1);
    double ink = 0, moment = 0;
    for (int k = first - kRim; k <= last + kRim; ++k) {
      const double paper = 2 * k < first + last ? before : after;
      const double share = std::max(0.0, paper - brightness(k));
      ink += share, moment += share * (k + 0.5);
    }
    constexpr double kFaint = 32;  // a stroke on a surface as dark
    return ink > kFaint ? std::optional(moment / ink) : std::nullopt;
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

RegionBorders CutDrawing::borders(const RegionMap& map, const VoxelGrid& hull) const {
  return work_->borders(map, hull);
}

RegionMap find_regions(const AlignedView& view, const VoxelGrid& hull, const RegionOptions& options) {
  return CutDrawing(view, hull.size().maxCoeff() * hull.spacing(), options).on(hull);
}

}  // namespace carve
