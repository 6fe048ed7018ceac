#include "carve/carving/convex_refinement.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

#include "carve/carving/contour_field.h"
#include "carve/carving/convex_as_printed.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr float kTolerance = 1e-4f;  // a mirrored solid gives the mirrored result
constexpr float kClearance = 0.02f;  // voxels between a crossing and the centres

/// The least value on the rays of each view: voxels up to it stay, so that every shadow does.
class RayMinima {
 public:
  explicit RayMinima(const Vec3i& size) : size_(size) {
    xy_.assign(static_cast<std::size_t>(size.x()) * size.y(), kNone);
    zy_.assign(static_cast<std::size_t>(size.z()) * size.y(), kNone);
    xz_.assign(static_cast<std::size_t>(size.x()) * size.z(), kNone);
  }

  void find(const VoxelGrid& solid, const ContourField& field) {
    std::mutex mutex;
    parallel_ranges(0, size_.z(), 8, [&](int first, int last) {
      std::vector<float> values, xy(xy_.size(), std::numeric_limits<float>::max());
      for (int z = first; z < last; ++z) {
        field.layer(z, values);
        each_voxel(solid, z, [&](int x, int y, std::size_t pixel) {
          for (float* least : {&xy[pixel], &zy_[index(z, y)], &xz_[static_cast<std::size_t>(z) * size_.x() + x]})
            *least = std::min(*least, values[pixel]);
        });
      }
      const std::lock_guard lock(mutex);
      for (std::size_t i = 0; i < xy.size(); ++i) xy_[i] = std::min(xy_[i], xy[i]);
    });
    soften(xy_, size_.x(), field.soften());
    soften(zy_, size_.z(), field.soften());
    soften(xz_, size_.x(), field.soften());
  }

  /// Up to where voxels stay on the rays through (x, y, z).
  float level(int x, int y, int z) const {
    return std::max({1.f, xy_[static_cast<std::size_t>(y) * size_.x() + x], zy_[index(z, y)],
                     xz_[static_cast<std::size_t>(z) * size_.x() + x]});
  }

  template <class Use>
  static void each_voxel(const VoxelGrid& solid, int z, Use&& use) {
    for (int y = 0; y < solid.size().y(); ++y)
      for (int w = 0; w < solid.words_per_row(); ++w)
        for (std::uint64_t rest = solid.row(y, z)[w]; rest; rest &= rest - 1) {
          const int x = 64 * w + std::countr_zero(rest);
          use(x, y, static_cast<std::size_t>(y) * solid.size().x() + x);
        }
  }

 private:
  std::size_t index(int z, int y) const { return static_cast<std::size_t>(y) * size_.z() + z; }

  /// Raises values to those around them, so that what a single ray has to keep does not stand out as a needle: the
  /// largest within `reach`, averaged.
  static void soften(std::vector<float>& values, int width, int reach) {
    if (reach == 0) return;
    std::vector<float> around(values.size()), mean(values.size());
    window<true>(values, around, width, reach, 1);
    window<true>(around, mean, width, reach, width);
    window<false>(mean, around, width, reach, 1);
    window<false>(around, mean, width, reach, width);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] != kNone) values[i] = std::max(values[i], mean[i]);
  }

  /// The largest or the mean of the values up to `reach` away along a row (step 1) or a column (step = width). What
  /// lies inside its contours counts as 1, what no voxel has not at all.
  template <bool largest>
  static void window(const std::vector<float>& from, std::vector<float>& to, int width, int reach, int step) {
    const int height = static_cast<int>(from.size() / width);
    parallel_ranges(0, height, 16, [&](int first, int last) {
      for (int y = first; y < last; ++y)
        for (int x = 0; x < width; ++x) {
          const int at = y * width + x, place = step == 1 ? x : y, end = step == 1 ? width : height;
          float most = 1, sum = 0;
          int count = 0;
          for (int k = std::max(-reach, -place); k <= std::min(reach, end - 1 - place); ++k) {
            const float value = from[at + k * step];
            if (value == kNone) continue;
            most = std::max(most, value), sum += std::max(1.f, value), ++count;
          }
          to[at] = largest ? most : count ? sum / static_cast<float>(count) : 1;
        }
    });
  }

  static constexpr float kNone = std::numeric_limits<float>::max();
  Vec3i size_;
  std::vector<float> xy_, zy_, xz_;
};

/// The solid's voxels that do not lie outside their contours.
VoxelGrid rounded(const VoxelGrid& solid, const ContourField& field, const RayMinima& minima) {
  VoxelGrid result = solid;
  parallel_ranges(0, solid.size().z(), 4, [&](int first, int last) {
    std::vector<float> values;
    for (int z = first; z < last; ++z) {
      field.layer(z, values);
      RayMinima::each_voxel(solid, z, [&](int x, int y, std::size_t pixel) {
        if (values[pixel] > minima.level(x, y, z) + kTolerance) result.set(x, y, z, false);
      });
    }
  });
  return result;
}

/// From a voxel that stays to one that does not, where the field passes the level; 0 where it does not say.
float crossing(float inside, float outside, float level) {
  if (inside == 0 || outside <= level) return 0;
  const float from = std::sqrt(inside), share = (std::sqrt(level) - from) / (std::sqrt(outside) - from);
  return std::clamp(share, kClearance, 1 - kClearance);
}

/// The edges between voxels that stay and voxels of the solid that do not.
class CutEdges {
 public:
  CutEdges(const VoxelGrid& solid, const VoxelGrid& result, const ContourField& field, const RayMinima& minima)
      : solid_(solid), result_(result), minima_(minima), rows_(solid.size().z()) {
    parallel_ranges(0, solid.size().z(), 8, [&](int first, int last) {
      std::vector<float> values, before;
      if (first > 0) field.layer(first - 1, before);
      for (int z = first; z < last; ++z) {
        field.layer(z, values);
        for (int y = 0; y < solid.size().y(); ++y) find(y, z, values, before);
        values.swap(before);
      }
    });
  }

  AxisCrossings collect() const {
    AxisCrossings result;
    for (int axis = 0; axis < 3; ++axis) {
      EdgeCrossings& all = result[axis];
      all.size = solid_.size();
      all.first = {0};
      for (const auto& layer : rows_) {
        const std::uint32_t begin = static_cast<std::uint32_t>(all.entries.size());
        for (const std::uint32_t end : layer[axis].ends) all.first.push_back(begin + end);
        all.entries.insert(all.entries.end(), layer[axis].entries.begin(), layer[axis].entries.end());
      }
    }
    return result;
  }

 private:
  struct Layer {
    std::vector<std::uint32_t> ends;  // of the rows
    std::vector<EdgeCrossings::Entry> entries;
  };

  void find(int y, int z, const std::vector<float>& values, const std::vector<float>& before) {
    const int nx = solid_.size().x();
    const float* row = &values[static_cast<std::size_t>(y) * nx];
    for (int axis = 0; axis < 3; ++axis) {
      Layer& layer = rows_[z][axis];
      const Vec3i down = Vec3i::Unit(axis);
      if (axis == 0 || (axis == 1 ? y : z) > 0) {
        const float* lower = axis == 0 ? row - 1 : axis == 1 ? row - nx : &before[static_cast<std::size_t>(y) * nx];
        each_cut(y, z, axis, [&](int x) {
          const bool inside = result_(x, y, z);  // the upper one
          const Vec3i in = inside ? Vec3i(x, y, z) : Vec3i(Vec3i(x, y, z) - down);
          const float level = minima_.level(in.x(), in.y(), in.z());
          const float share = inside ? crossing(row[x], lower[x], level) : crossing(lower[x], row[x], level);
          if (share > 0) layer.entries.push_back({x, inside ? -share : share});
        });
      }
      layer.ends.push_back(static_cast<std::uint32_t>(layer.entries.size()));
    }
  }

  /// Calls use(x) for the edges that end in row (y, z), lie in the solid and are cut by the result's surface.
  template <class Use>
  void each_cut(int y, int z, int axis, Use&& use) const {
    const int dy = axis == 1, dz = axis == 2;
    const std::uint64_t *kept = result_.row(y, z), *below = result_.row(y - dy, z - dz);
    const std::uint64_t *solid = solid_.row(y, z), *under = solid_.row(y - dy, z - dz);
    for (int w = 0; w < solid_.words_per_row(); ++w) {
      std::uint64_t cut = kept[w] ^ below[w], both = solid[w] & under[w];
      if (axis == 0) {
        cut = kept[w] ^ (kept[w] << 1 | (w > 0 ? kept[w - 1] >> 63 : 0));
        both = solid[w] & (solid[w] << 1 | (w > 0 ? solid[w - 1] >> 63 : 0));
      }
      for (std::uint64_t rest = cut & both; rest; rest &= rest - 1) use(64 * w + std::countr_zero(rest));
    }
  }

  const VoxelGrid &solid_, &result_;
  const RayMinima& minima_;
  std::vector<std::array<Layer, 3>> rows_;  // by z
};

}  // namespace

Refinement refine_convex(const VoxelGrid& solid, const ViewSet& views, const ConvexOptions& options) {
  check("convex", options);
  if (!options.arm) return {solid, {}};
  if (options.rule == ConvexRule::as_printed) return {refine_convex_as_printed(solid, views), {}};
  const ContourField field(solid, views, options);
  if (!field.rounds()) return {solid, {}};
  RayMinima minima(solid.size());
  minima.find(solid, field);
  VoxelGrid result = rounded(solid, field, minima);
  AxisCrossings crossings = CutEdges(solid, result, field, minima).collect();
  return {std::move(result), std::move(crossings)};
}

}  // namespace carve
