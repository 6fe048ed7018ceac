#include "carve/carving/carve_silhouettes.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "carve/core/error.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"

namespace carve {
namespace {

/// All views' masks at the grid's resolution, by the plane they lie in: rows of bits along x where the plane has x.
class Planes {
 public:
  explicit Planes(const VoxelGrid& grid)
      : size_(grid.size()),
        words_(grid.words_per_row()),
        xy_(row_of_ones(), size_.y(), words_),
        xz_(row_of_ones(), size_.z(), words_),
        zy_(static_cast<std::size_t>(size_.z()) * size_.y(), 1) {}

  void intersect(const PatchLabels& mask) {
    const ShadowLayout layout(size_, mask.view);
    if (layout.frame.toward.axis == 0) return intersect_side(mask.inside, layout);
    BitPlane& plane = layout.frame.toward.axis == 2 ? xy_ : xz_;
    parallel_ranges(0, layout.height, 64, [&](int first, int last) {
      std::vector<std::uint8_t> bytes(64 * static_cast<std::size_t>(words_), 0);
      for (int j = first; j < last; ++j) {
        const std::uint8_t* inside = &mask.inside(0, j);
        if (layout.frame.right.sign > 0)
          std::copy_n(inside, layout.width, bytes.begin());
        else
          std::reverse_copy(inside, inside + layout.width, bytes.begin());
        for (int w = 0; w < words_; ++w) plane.row(layout.up_index(j))[w] &= packed(bytes.data() + 64 * w);
      }
    });
  }

  /// A row along x is the front's row and the top's row where the side shows the row, else nothing.
  /// \return whether any bit is set
  bool carve(int y, int z, std::uint64_t* row) const {
    if (!zy_[z * size_.y() + y]) {
      std::fill_n(row, words_, 0);
      return false;
    }
    const std::uint64_t *front = xy_.row(y), *top = xz_.row(z);
    std::uint64_t any = 0;
    for (int w = 0; w < words_; ++w) any |= row[w] = front[w] & top[w];
    return any != 0;
  }

 private:
  struct BitPlane {
    BitPlane(const std::vector<std::uint64_t>& ones, int rows, int words) : words_per_row(words) {
      for (int j = 0; j < rows; ++j) words_.insert(words_.end(), ones.begin(), ones.end());
    }
    std::uint64_t* row(int up) { return words_.data() + static_cast<std::size_t>(up) * words_per_row; }
    const std::uint64_t* row(int up) const { return words_.data() + static_cast<std::size_t>(up) * words_per_row; }
    int words_per_row;
    std::vector<std::uint64_t> words_;
  };

  /// 64 bytes of 0 or 1 as bits: the product moves the low bits of eight bytes into its top byte.
  static std::uint64_t packed(const std::uint8_t* bytes) {
    std::uint64_t word = 0;
    for (int k = 0; k < 8; ++k) {
      std::uint64_t eight = 0;
      for (int b = 0; b < 8; ++b) eight |= std::uint64_t{bytes[8 * k + b]} << 8 * b;
      word |= (eight * 0x0102040810204080u >> 56) << 8 * k;
    }
    return word;
  }

  void intersect_side(const Mask& inside, const ShadowLayout& layout) {
    parallel_ranges(0, layout.width, 64, [&](int first, int last) {
      for (int j = 0; j < layout.height; ++j)
        for (int i = first; i < last; ++i)
          zy_[static_cast<std::size_t>(layout.right_index(i)) * size_.y() + layout.up_index(j)] &= inside(i, j);
    });
  }

  std::vector<std::uint64_t> row_of_ones() const {
    std::vector<std::uint64_t> row(words_, ~std::uint64_t{0});
    if (const int rest = size_.x() % 64) row.back() = (std::uint64_t{1} << rest) - 1;
    return row;
  }

  Vec3i size_;
  int words_;
  BitPlane xy_, xz_;
  std::vector<std::uint8_t> zy_;  // [z * ny + y]
};

}  // namespace

Carving carve_silhouettes(const ViewSet& views, const CarveOptions& options) {
  check("", options);
  Carving result{grid_over(views.low(), views.high(), options.grid, Fill::undefined), {}};
  Planes planes(result.grid);
  for (const AlignedView& view : views.views) {
    result.views.push_back(patch_labels(view, result.grid, options.patch));
    planes.intersect(result.views.back());
  }

  std::atomic<bool> any = false;
  parallel_ranges(0, result.grid.size().z(), 4, [&](int first, int last) {
    bool found = false;
    for (int z = first; z < last; ++z)
      for (int y = 0; y < result.grid.size().y(); ++y) found |= planes.carve(y, z, result.grid.row(y, z));
    if (found) any = true;
  });
  if (!any) throw NoResult("the silhouettes have no voxel in common at grid " + std::to_string(options.grid));
  return result;
}

}  // namespace carve
