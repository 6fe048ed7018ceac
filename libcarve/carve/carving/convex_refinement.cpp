#include "carve/carving/convex_refinement.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <span>

#include "carve/carving/contour_field.h"
#include "carve/carving/convex_as_printed.h"
#include "carve/carving/scale_axis.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr float kTolerance = 1e-4f;  // a mirrored solid gives the mirrored result
constexpr float kClearance = 0.02f;  // voxels between a crossing and the centres

/// How far out voxels lie: 1 on the rounded surface. Layer z: values[y * nx + x].
using Layer = std::function<void(int z, std::vector<float>& values)>;

/// The same layer by layer, or worked out once where that takes little memory: it is asked three times.
Layer remembered(Layer layer, const Vec3i& size) {
  constexpr std::size_t kMost = std::size_t{1} << 24;  // voxels, of 4 bytes
  if (static_cast<std::size_t>(size.x()) * size.y() * size.z() > kMost) return layer;
  std::vector<std::vector<float>> layers(size.z());
  parallel_ranges(0, size.z(), 4, [&](int first, int last) {
    for (int z = first; z < last; ++z) layer(z, layers[z]);
  });
  return [layers = std::move(layers)](int z, std::vector<float>& values) { values = layers[z]; };
}

/// The least value on the rays of each view: voxels up to it stay, so that every shadow does.
class RayMinima {
 public:
  /// \param reach  how far around a ray what it keeps is to be kept too, in voxels
  RayMinima(const VoxelGrid& solid, const Layer& layer, int reach) : size_(solid.size()) {
    xy_.assign(static_cast<std::size_t>(size_.x()) * size_.y(), kNone);
    zy_.assign(static_cast<std::size_t>(size_.z()) * size_.y(), kNone);
    xz_.assign(static_cast<std::size_t>(size_.x()) * size_.z(), kNone);
    std::mutex mutex;
    parallel_ranges(0, size_.z(), 8, [&](int first, int last) {
      std::vector<float> values, xy(xy_.size(), std::numeric_limits<float>::max());
      for (int z = first; z < last; ++z) {
        layer(z, values);
        each_voxel(solid, z, [&](int x, int y, std::size_t pixel) {
          for (float* least : {&xy[pixel], &zy_[index(z, y)], &xz_[static_cast<std::size_t>(z) * size_.x() + x]})
            *least = std::min(*least, values[pixel]);
        });
      }
      const std::lock_guard lock(mutex);
      for (std::size_t i = 0; i < xy.size(); ++i) xy_[i] = std::min(xy_[i], xy[i]);
    });
    soften(xy_, size_.x(), reach);
    soften(zy_, size_.z(), reach);
    soften(xz_, size_.x(), reach);
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

/// One step of rounding.
struct Rounding {
  Layer layer;
  RayMinima minima;
};

/// The solid's voxels that do not lie outside.
VoxelGrid rounded(const VoxelGrid& solid, const Rounding& by) {
  VoxelGrid result = solid;
  parallel_ranges(0, solid.size().z(), 4, [&](int first, int last) {
    std::vector<float> values;
    for (int z = first; z < last; ++z) {
      by.layer(z, values);
      RayMinima::each_voxel(solid, z, [&](int x, int y, std::size_t pixel) {
        if (values[pixel] > by.minima.level(x, y, z) + kTolerance) result.set(x, y, z, false);
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
  CutEdges(const VoxelGrid& solid, const VoxelGrid& result, std::span<const Rounding> steps)
      : solid_(solid), result_(result), steps_(steps), rows_(solid.size().z()) {
    parallel_ranges(0, solid.size().z(), 8, [&](int first, int last) {
      Values values(steps.size()), before(steps.size());
      for (std::size_t k = 0; first > 0 && k < steps.size(); ++k) steps[k].layer(first - 1, before[k]);
      for (int z = first; z < last; ++z) {
        for (std::size_t k = 0; k < steps.size(); ++k) steps[k].layer(z, values[k]);
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
      for (const auto& rows : rows_) {
        const std::uint32_t begin = static_cast<std::uint32_t>(all.entries.size());
        for (const std::uint32_t end : rows[axis].ends) all.first.push_back(begin + end);
        all.entries.insert(all.entries.end(), rows[axis].entries.begin(), rows[axis].entries.end());
      }
    }
    return result;
  }

 private:
  using Values = std::vector<std::vector<float>>;  // of a layer, by each step
  struct Rows {
    std::vector<std::uint32_t> ends;
    std::vector<EdgeCrossings::Entry> entries;
  };

  void find(int y, int z, const Values& values, const Values& before) {
    const int nx = solid_.size().x();
    const std::size_t row = static_cast<std::size_t>(y) * nx;
    for (int axis = 0; axis < 3; ++axis) {
      Rows& rows = rows_[z][axis];
      const Vec3i down = Vec3i::Unit(axis);
      if (axis == 0 || (axis == 1 ? y : z) > 0)
        each_cut(y, z, axis, [&](int x) {
          const bool inside = result_(x, y, z);  // the upper one
          const Vec3i in = inside ? Vec3i(x, y, z) : Vec3i(Vec3i(x, y, z) - down);
          float nearest = 0;
          for (std::size_t k = 0; k < steps_.size(); ++k) {
            const float upper = values[k][row + x];
            const float lower = axis == 2 ? before[k][row + x] : values[k][row + x - (axis == 0 ? 1 : nx)];
            const float level = steps_[k].minima.level(in.x(), in.y(), in.z());
            const float share = inside ? crossing(upper, lower, level) : crossing(lower, upper, level);
            if (share > 0 && (nearest == 0 || share < nearest)) nearest = share;
          }
          if (nearest > 0) rows.entries.push_back({x, inside ? -nearest : nearest});
        });
      rows.ends.push_back(static_cast<std::uint32_t>(rows.entries.size()));
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
  std::span<const Rounding> steps_;
  std::vector<std::array<Rows, 3>> rows_;  // by z
};

}  // namespace

Refinement refine_convex(const VoxelGrid& solid, const ViewSet& views, const ConvexOptions& options) {
  check("convex", options);
  if (!options.arm) return {solid, {}};
  if (options.rule == ConvexRule::as_printed) return {refine_convex_as_printed(solid, views), {}};
  const ContourField field(solid, views, options);
  if (!field.rounds()) return {solid, {}};
  std::vector<Rounding> steps;
  VoxelGrid result = solid;
  const auto step = [&](Layer from) {
    Layer layer = remembered(std::move(from), solid.size());
    RayMinima minima(result, layer, field.soften());
    steps.push_back({std::move(layer), std::move(minima)});
    result = rounded(result, steps.back());
  };
  step([&field](int z, std::vector<float>& values) { field.layer(z, values); });
  std::optional<ScaleAxis> balls;
  if (field.looks_grown() && options.scale > 1) {
    balls.emplace(result, options.scale);
    step([&balls](int z, std::vector<float>& values) { balls->layer(z, values); });
  }
  AxisCrossings crossings = CutEdges(solid, result, steps).collect();
  return {std::move(result), std::move(crossings)};
}

}  // namespace carve
