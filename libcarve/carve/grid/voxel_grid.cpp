#include "carve/grid/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace carve {
namespace {

/// Set bits of a word. Adding neighbours, pairs and nibbles needs no instruction that some machines lack: without it
/// std::popcount is a call.
std::int64_t bits(std::uint64_t word) {
  word -= word >> 1 & 0x5555555555555555;
  word = (word & 0x3333333333333333) + (word >> 2 & 0x3333333333333333);
  word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0f;
  return static_cast<std::int64_t>(word * 0x0101010101010101 >> 56);
}

void check_same_size(const VoxelGrid& a, const VoxelGrid& b) {
  if (a.size() != b.size()) throw std::invalid_argument("grids must have one size");
}

}  // namespace

VoxelGrid::VoxelGrid(Vec3i size, Vec3 low, double spacing, Fill fill)
    : size_(std::move(size)), low_(std::move(low)), spacing_(spacing) {
  if (size_.minCoeff() < 1 || size_.maxCoeff() > kLargestGrid) {
    const int wrong = size_.minCoeff() < 1 ? size_.minCoeff() : size_.maxCoeff();
    throw std::invalid_argument("grid size must be in [1, " + std::to_string(kLargestGrid) + "], got " +
                                std::to_string(wrong));
  }
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw std::invalid_argument("grid spacing must be positive, got " + std::to_string(spacing));
  words_per_row_ = (size_.x() + 63) / 64;
  words_.resize(static_cast<std::size_t>(size_.z()) * size_.y() * words_per_row_);
  if (fill == Fill::undefined) return;
  std::ranges::fill(words_, fill == Fill::full ? ~std::uint64_t{0} : 0);
  if (const int rest = size_.x() % 64; fill == Fill::full && rest)
    for (std::size_t last = words_per_row_ - 1; last < words_.size(); last += words_per_row_)
      words_[last] = (std::uint64_t{1} << rest) - 1;
}

std::int64_t VoxelGrid::count() const {
  std::int64_t sum = 0;
  for (std::uint64_t word : words_) sum += bits(word);
  return sum;
}

VoxelGrid grid_over(const Vec3& low, const Vec3& high, int resolution, Fill fill) {
  if (resolution < 1 || resolution > kLargestGrid)
    throw std::invalid_argument("grid must be in [1, " + std::to_string(kLargestGrid) + "], got " +
                                std::to_string(resolution));
  const Vec3 extent = high - low;
  if (!(extent.minCoeff() > 0) || !extent.allFinite()) throw std::invalid_argument("grid box must not be empty");
  const double spacing = extent.maxCoeff() / resolution;
  // An extent of a whole number of voxels but for rounding gets no further layer.
  const Vec3i size = (extent.array() / spacing - 1e-9).ceil().cast<int>().max(1);
  return VoxelGrid(size, (low + high) / 2 - spacing / 2 * size.cast<double>(), spacing, fill);
}

bool contains(const VoxelGrid& outer, const VoxelGrid& inner) {
  check_same_size(outer, inner);
  return std::ranges::equal(outer.words(), inner.words(), [](auto o, auto i) { return (i & ~o) == 0; });
}

double intersection_over_union(const VoxelGrid& a, const VoxelGrid& b) {
  check_same_size(a, b);
  std::int64_t both = 0, either = 0;
  for (std::size_t i = 0; i < a.words().size(); ++i) {
    both += bits(a.words()[i] & b.words()[i]);
    either += bits(a.words()[i] | b.words()[i]);
  }
  return either == 0 ? 1 : static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace carve
