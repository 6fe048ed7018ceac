#include "carve/carving/patch_labels.h"

#include <algorithm>
#include <cmath>

#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"
#include "carve/image/outline.h"

namespace carve {
namespace {

/// Pixels along one side of a drawing, half-open; empty outside the drawing.
struct Interval {
  int first = 0, last = 0;
  bool operator==(const Interval&) const = default;
};

/// The pixels whose centres lie in [low, high]. Ends are taken with a tolerance, so that a mirrored drawing gives the
/// mirrored result where a patch ends on a pixel's centre.
Interval pixels_between(double low, double high, int pixels) {
  const auto clamped = [&](double x) { return static_cast<int>(std::clamp<double>(x, 0, pixels)); };
  const int first = clamped(std::ceil(low - 0.5 - kOutlineTolerance));
  const int last = clamped(std::floor(high - 0.5 + kOutlineTolerance) + 1);
  return first < last ? Interval{first, last} : Interval{};
}

/// The patches along one side of the drawing.
struct Side {
  std::vector<double> centre;    // pixel coordinates
  std::vector<Interval> patch;   // pixels whose centres lie in the patch; if there are none, those at its centre
  std::vector<Interval> middle;  // the pixel at the patch's centre; two if the centre lies between them

  /// \param start, step  pixel coordinate of the first patch's lower end, and the patches' (signed) width
  Side(int patches, double start, double step, int pixels) {
    for (int i = 0; i < patches; ++i) {
      const double a = start + step * i, b = start + step * (i + 1);
      centre.push_back(start + step * (i + 0.5));
      middle.push_back(pixels_between(centre[i] - 0.5, centre[i] + 0.5, pixels));
      patch.push_back(pixels_between(std::min(a, b), std::max(a, b), pixels));
      if (patch[i] == Interval{}) patch[i] = middle[i];
    }
  }
};

/// Bits of the pixels in a row of patches, or-ed: first down, then across.
class Gather {
 public:
  /// \param outside  the bits outside of the drawing
  Gather(const std::vector<Interval>& columns, int pixels, std::uint8_t outside)
      : columns_(columns), line_(pixels + 1), outside_(outside) {
    for (const Interval& column : columns) {
      widest_ = std::max(widest_, column.last - column.first);
      first_.push_back(column == Interval{} ? pixels : column.first);
      last_.push_back(column == Interval{} ? pixels : column.last - 1);
    }
  }

  template <class T, class Bits>
  void operator()(const Raster<T>& pixels, Bits bits, const Interval& rows, std::uint8_t* out) {
    std::ranges::fill(line_, rows == Interval{} ? outside_ : std::uint8_t{0});
    line_[pixels.width] = outside_;
    for (int y = rows.first; y < rows.last; ++y) {
      const T* values = &pixels(0, y);
      for (int x = 0; x < pixels.width; ++x) line_[x] |= bits(values[x]);
    }
    const int count = static_cast<int>(columns_.size());
    for (int i = 0; i < count; ++i) out[i] = line_[first_[i]] | line_[last_[i]];
    if (widest_ <= 2) return;
    for (int i = 0; i < count; ++i)
      for (int x = columns_[i].first + 1; x < columns_[i].last - 1; ++x) out[i] |= line_[x];
  }

 private:
  const std::vector<Interval>& columns_;
  std::vector<std::uint8_t> line_;  // one entry more than a row of pixels: the outside
  std::vector<int> first_, last_;
  int widest_ = 0;
  std::uint8_t outside_;
};

class Projection {
 public:
  Projection(const AlignedView& view, const ShadowLayout& layout, const VoxelGrid& grid, Patch patch)
      : drawing_(view.drawing),
        outline_(view.drawing.coverage),
        patch_(patch),
        columns_(layout.width, view.column(low_end(grid, layout.frame.right, layout.width)),
                 view.column_per_unit * grid.spacing() * layout.frame.right.sign, drawing_.labels.width),
        rows_(layout.height, view.row(high_end(grid, layout.frame.up, layout.height)),
              -view.row_per_unit * grid.spacing() * layout.frame.up.sign, drawing_.labels.height) {}

  void rows(int first, int last, PatchLabels& out) const {
    const int width = out.labels.width, pixels = drawing_.labels.width;
    Gather gather_labels(columns_.patch, pixels, kBackground), gather_cover(columns_.middle, pixels, 0);
    std::vector<std::uint8_t> middle(width), patch(width);
    std::vector<int> partly;  // columns whose middle pixels are covered in part
    for (int j = first; j < last; ++j) {
      std::uint8_t *labels = &out.labels(0, j), *inside = &out.inside(0, j);
      // A grid finer than the drawing meets the same pixels several times.
      if (j == first || rows_.patch[j] != rows_.patch[j - 1])
        gather_labels(drawing_.labels, label_bit, rows_.patch[j], patch.data());
      if (j == first || rows_.middle[j] != rows_.middle[j - 1]) {
        gather_cover(drawing_.coverage, cover_bit, rows_.middle[j], middle.data());
        partly.clear();
        for (int i = 0; i < width; ++i)
          if (middle[i] == kPartly) partly.push_back(i);
      }
      std::ranges::copy(patch, labels);
      for (int i = 0; i < width; ++i) inside[i] = middle[i] >> 1;
      for (int i : partly) inside[i] = outline_.contains(columns_.centre[i], rows_.centre[j]);
      combine(labels, inside, width);
    }
  }

 private:
  enum Cover : std::uint8_t { kPartly = 1, kFull = 2 };
  static constexpr auto cover_bit = [](std::uint8_t coverage) {
    return static_cast<std::uint8_t>(coverage == 255 ? kFull : coverage != 0 ? kPartly : 0);
  };
  static constexpr auto label_bit = [](Label label) {  // 1 << label, which vectorises
    const auto value = static_cast<std::uint8_t>(label);
    return static_cast<std::uint8_t>(value + 1 + (value == 2));
  };

  /// World coordinate of the grid's end on the image's left, and on its top.
  static double low_end(const VoxelGrid& grid, SignedAxis right, int width) {
    return grid.low()[right.axis] + (right.sign > 0 ? 0 : grid.spacing() * width);
  }
  static double high_end(const VoxelGrid& grid, SignedAxis up, int height) {
    return grid.low()[up.axis] + (up.sign > 0 ? grid.spacing() * height : 0);
  }

  /// A patch that counts as the object shows it, if only by a fraction of a pixel.
  void combine(std::uint8_t* labels, std::uint8_t* inside, int width) const {
    constexpr std::uint8_t object = kSurface | kEdge;
    if (patch_ == Patch::any)
      for (int i = 0; i < width; ++i) inside[i] |= (labels[i] & object) != 0;
    for (int i = 0; i < width; ++i) labels[i] |= inside[i] && !(labels[i] & object) ? kSurface : 0;
  }

  const Drawing& drawing_;
  Outline outline_;
  Patch patch_;
  Side columns_, rows_;
};

}  // namespace

PatchLabels patch_labels(const AlignedView& view, const VoxelGrid& grid, Patch patch) {
  const ShadowLayout layout(grid.size(), view.view);
  PatchLabels result{view.view, Raster<std::uint8_t>(layout.width, layout.height), Mask(layout.width, layout.height)};
  const Projection projection(view, layout, grid, patch);
  parallel_ranges(0, layout.height, 64, [&](int first, int last) { projection.rows(first, last, result); });
  return result;
}

}  // namespace carve
