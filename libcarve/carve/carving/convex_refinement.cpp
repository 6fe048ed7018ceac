#include "carve/carving/convex_refinement.h"

#include <algorithm>
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
#include "carve/grid/cut_edges.h"

namespace carve {
namespace {

constexpr float kTolerance = 1e-4f;  // a mirrored solid gives the mirrored result

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

/// Where the rounded surface crosses the edges between voxels that stay and voxels of the solid that do not.
class RoundedPlaces {
 public:
  RoundedPlaces(std::span<const Rounding> steps, const Vec3i& size, int z)
      : steps_(steps), size_(size), values_(steps.size()), before_(steps.size()) {
    if (z > 0) enter(z - 1);
  }

  void enter(int z) {
    values_.swap(before_);
    for (std::size_t k = 0; k < steps_.size(); ++k) steps_[k].layer(z, values_[k]);
  }

  float operator()(int axis, const Vec3i& upper, bool upper_inside) const {
    const Vec3i in = upper_inside ? upper : Vec3i(upper - Vec3i::Unit(axis));
    const std::size_t at = static_cast<std::size_t>(upper.y()) * size_.x() + upper.x();
    float nearest = 0;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const float high = values_[k][at];
      const float low = axis == 2 ? before_[k][at] : values_[k][at - (axis == 0 ? 1 : size_.x())];
      const float level = steps_[k].minima.level(in.x(), in.y(), in.z());
      const float share = upper_inside ? crossing(high, low, level) : crossing(low, high, level);
      if (share > 0 && (nearest == 0 || share < nearest)) nearest = share;
    }
    return nearest;
  }

 private:
  std::span<const Rounding> steps_;
  Vec3i size_;
  std::vector<std::vector<float>> values_, before_;  // of a layer, by each step
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
  AxisCrossings crossings = cut_edges(solid, result, [&](int z) { return RoundedPlaces(steps, solid.size(), z); });
  return {std::move(result), std::move(crossings)};
}

}  // namespace carve
