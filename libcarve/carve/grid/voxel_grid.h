#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "carve/core/pages.h"
#include "carve/core/vector.h"

namespace carve {

inline constexpr int kLargestGrid = 2048;  // voxels along one axis

/// What a new grid holds. `undefined` is for those who write every word themselves, the bits past nx as 0.
enum class Fill { empty, full, undefined };

/// Occupancy of a box of voxels, one bit each. Bit (x, y, z) stands for the voxel's centre; 1 = inside.
///
/// Bits run along x, 64 to a word, each (y, z) row starts a new word: word w of row (y, z) is
/// words[(z * ny + y) * words_per_row + w] and holds x = 64 w + bit. Bits past nx are always 0.
class VoxelGrid {
 public:
  VoxelGrid() = default;
  /// \param low  world position of the box's lower corner: voxel (x, y, z) has its centre at low + spacing * (x+.5,
  /// ...) \throws std::invalid_argument if a size is not in [1, kLargestGrid], or spacing not positive and finite
  VoxelGrid(Vec3i size, Vec3 low, double spacing, Fill fill = Fill::empty);

  const Vec3i& size() const { return size_; }
  const Vec3& low() const { return low_; }
  double spacing() const { return spacing_; }
  int words_per_row() const { return words_per_row_; }

  std::uint64_t* row(int y, int z) { return words_.data() + row_offset(y, z); }
  const std::uint64_t* row(int y, int z) const { return words_.data() + row_offset(y, z); }
  std::span<std::uint64_t> words() { return words_; }
  std::span<const std::uint64_t> words() const { return words_; }

  bool operator()(int x, int y, int z) const { return row(y, z)[x >> 6] >> (x & 63) & 1; }
  void set(int x, int y, int z, bool inside) {
    const std::uint64_t bit = std::uint64_t{1} << (x & 63);
    std::uint64_t& word = row(y, z)[x >> 6];
    word = inside ? word | bit : word & ~bit;
  }
  bool contains(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < size_.x() && y < size_.y() && z < size_.z();
  }
  Vec3 centre(int x, int y, int z) const { return low_ + spacing_ * Vec3(x + 0.5, y + 0.5, z + 0.5); }

  std::int64_t count() const;  // voxels inside
  double volume() const { return count() * spacing_ * spacing_ * spacing_; }
  bool operator==(const VoxelGrid&) const = default;

 private:
  std::size_t row_offset(int y, int z) const { return (static_cast<std::size_t>(z) * size_.y() + y) * words_per_row_; }
  Vec3i size_ = Vec3i::Zero();
  Vec3 low_ = Vec3::Zero();
  double spacing_ = 1;
  int words_per_row_ = 0;
  std::vector<std::uint64_t, PageAllocator<std::uint64_t>> words_;
};

/// A grid with `resolution` voxels along the longest side of a box, centred on it; each axis gets as many whole
/// voxels as cover it. \throws std::invalid_argument: resolution not in [1, kLargestGrid], or an empty box
VoxelGrid grid_over(const Vec3& low, const Vec3& high, int resolution, Fill fill = Fill::empty);

/// Every voxel of `inner` is one of `outer`. \throws std::invalid_argument if the grids' sizes differ
bool contains(const VoxelGrid& outer, const VoxelGrid& inner);

/// Volume of the intersection over volume of the union; 1 if both are empty. \throws as contains
double intersection_over_union(const VoxelGrid& a, const VoxelGrid& b);

}  // namespace carve
