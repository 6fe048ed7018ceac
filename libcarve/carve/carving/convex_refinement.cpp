#include "carve/carving/convex_refinement.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

#include "carve/carving/part_contours.h"
#include "carve/carving/sections.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr std::uint8_t kAllCorners = 15;
constexpr double kFilled = 0.95;         // share of its contour that a section fills, if its box is what bounds it
constexpr std::size_t kFewestGrown = 3;  // slices of a part whose outlines have a direction
constexpr double kFilledGrown = 0.7;     // the same in a solid that looks grown
constexpr double kConvex = 0.97;     // share of its convex hull that a convex section fills, for its voxels' corners
constexpr float kTolerance = 1e-4f;  // a mirrored solid gives the mirrored result
constexpr float kClearance = 0.02f;  // voxels between a crossing and the centres

float power(float base, int exponent) {
  float result = 1;
  for (; exponent; exponent >>= 1, base *= base)
    if (exponent & 1) result *= base;
  return result;
}

/// |distance from the middle / half the way to the ends| ^ exponent, of a voxel's centre.
float way_out(int index, float low, float high, int exponent) {
  return power(std::abs((2 * index + 1 - low - high) / (high - low)), exponent);
}

/// Of voxels that are added row by row, the rows upwards.
class ConvexHull {
 public:
  /// Voxels u0 <= u < u1 of row v.
  void add(int v, int u0, int u1) {
    for (const int corner : {v, v + 1}) {
      extend(low_, {corner, u0}, 1);
      extend(high_, {corner, u1}, -1);
    }
  }
  double area() const { return under(high_) - under(low_); }

 private:
  struct Corner {
    int v, u;
  };
  static int turn(const Corner& a, const Corner& b, const Corner& c) {
    return (b.v - a.v) * (c.u - a.u) - (b.u - a.u) * (c.v - a.v);
  }
  static void extend(std::vector<Corner>& chain, const Corner& next, int side) {
    if (!chain.empty() && chain.back().v == next.v) {
      if (side * (next.u - chain.back().u) >= 0) return;
      chain.pop_back();
    }
    while (chain.size() > 1 && side * turn(chain[chain.size() - 2], chain.back(), next) <= 0) chain.pop_back();
    chain.push_back(next);
  }
  static double under(const std::vector<Corner>& chain) {
    double area = 0;
    for (std::size_t i = 1; i < chain.size(); ++i)
      area += (chain[i].v - chain[i - 1].v) * (chain[i].u + chain[i - 1].u) / 2.0;
    return area;
  }
  std::vector<Corner> low_, high_;
};

/// How far out in its sections' contours a voxel lies: below 1 inside, above 1 outside, 0 where none is rounded.
class ContourField {
 public:
  ContourField(const VoxelGrid& solid, const ViewSet& views, const ConvexOptions& options) : size_(solid.size()) {
    for (int axis = 0; axis < 3; ++axis) cuts_[axis] = cut(solid, axis, views);
    std::array<std::vector<Drift>, 3> ways;
    for (int axis = 0; axis < 3; ++axis) ways[axis] = drifts(cuts_[axis], size_.maxCoeff());
    const bool all = grown(cuts_, ways) >= options.grown;
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<int> exponents = part_exponents(cuts_[axis], size_.maxCoeff(), options);
      for (std::size_t s = 0; s < ways[axis].size(); ++s) {
        const int part = cuts_[axis].sections[s].part, exponent = exponents[part];
        const bool by_corners = all && exponent == kRectangle && cuts_[axis].parts[part].size() >= kFewestGrown;
        exponents_[axis].push_back(by_corners ? kEllipse : exponent);
        corners_[axis].push_back(by_corners ? drifting_corners(ways[axis][s]) : kAllCorners);
      }
      keep_unfilled(axis, all ? kFilledGrown : kFilled, all ? 0 : kConvex);
      rounds_[axis] = std::ranges::any_of(exponents_[axis], [](int e) { return e != kRectangle; });
    }
  }
  bool rounds() const { return rounds_[0] || rounds_[1] || rounds_[2]; }

  /// The values of layer z: field[y * nx + x].
  void layer(int z, std::vector<float>& field) const {
    const int nx = size_.x(), ny = size_.y();
    field.assign(static_cast<std::size_t>(nx) * ny, 0);
    for (int x = 0; rounds_[0] && x < nx; ++x) row(0, x, z, &field[x], nx);
    for (int y = 0; rounds_[1] && y < ny; ++y) row(1, y, z, &field[static_cast<std::size_t>(y) * nx], 1);
    for (int y = 0; rounds_[2] && y < ny; ++y) row(2, z, y, &field[static_cast<std::size_t>(y) * nx], 1);
  }

 private:
  /// Calls use(section, exponent, u, value) for the voxels of row v of a slice that lie in rounded sections.
  template <class Use>
  void each_value(int axis, int slice, int v, Use&& use) const {
    const Sections& all = cuts_[axis];
    const int at = slice * all.height + v;
    for (int r = all.first_run[at]; r < all.first_run[at + 1]; ++r) {
      const SectionRun& run = all.runs[r];
      const int exponent = exponents_[axis][run.section];
      if (exponent == kRectangle) continue;
      const std::array<float, 4>& ends = all.sections[run.section].ends;
      const float across = way_out(v, ends[2], ends[3], exponent);
      for (int u = run.u0; u < run.u1; ++u) use(run.section, u, across + way_out(u, ends[0], ends[1], exponent));
    }
  }

  /// Sections that are not convex, or miss a good part of the contour's inside, are not what their boxes say: they stay
  /// as they are.
  void keep_unfilled(int axis, double filled, double convex) {
    const Sections& all = cuts_[axis];
    parallel_ranges(0, all.slices, 4, [&](int first, int last) {
      for (int slice = first; slice < last; ++slice) {
        const int begin = all.first_section[slice], end = all.first_section[slice + 1];
        std::vector<ConvexHull> hulls(end - begin);
        std::vector<int> inside(end - begin, 0);
        for (int v = 0; v < all.height; ++v) {
          const int at = slice * all.height + v;
          for (int r = all.first_run[at]; r < all.first_run[at + 1]; ++r)
            if (exponents_[axis][all.runs[r].section] != kRectangle)
              hulls[all.runs[r].section - begin].add(v, all.runs[r].u0, all.runs[r].u1);
          each_value(axis, slice, v, [&](int section, int, float value) { inside[section - begin] += value <= 1; });
        }
        for (int s = begin; s < end; ++s) {
          int& exponent = exponents_[axis][s];
          if (exponent == kRectangle) continue;
          const Section& section = all.sections[s];
          const double contour = section.width() * section.height() * superellipse_fill(exponent);
          if (inside[s - begin] < filled * contour || section.area < convex * hulls[s - begin].area())
            exponent = kRectangle;
        }
      }
    });
  }

  /// A bit for each corner that lies between two ends which drift.
  static std::uint8_t drifting_corners(const Drift& drift) {
    constexpr float kDrifts = 0.06f;  // voxels a slice
    std::uint8_t corners = 0;
    for (const int c : {0, 1, 2, 3}) {
      const auto [u, v] = at_corner(drift, c);
      corners |= (std::min(u, v) > kDrifts) << c;
    }
    return corners;
  }

  /// Row v of a slice; voxel u's value is field[u * step].
  void row(int axis, int slice, int v, float* field, int step) const {
    each_value(axis, slice, v, [&](int section, int u, float value) {
      const std::array<float, 4>& ends = cuts_[axis].sections[section].ends;
      const int corner = (2 * u + 1 > ends[0] + ends[1]) + 2 * (2 * v + 1 > ends[2] + ends[3]);
      if (!(corners_[axis][section] >> corner & 1)) return;
      float& largest = field[static_cast<std::size_t>(u) * step];
      largest = std::max(largest, value);
    });
  }

  Vec3i size_;
  std::array<Sections, 3> cuts_;
  std::array<std::vector<int>, 3> exponents_;         // of each section
  std::array<std::vector<std::uint8_t>, 3> corners_;  // of each section, a bit for each corner that is rounded
  std::array<bool, 3> rounds_{};
};

/// The least value on the rays of each view: voxels up to it stay, so that every shadow does.
class RayMinima {
 public:
  explicit RayMinima(const Vec3i& size) : size_(size) {
    constexpr float kNone = std::numeric_limits<float>::max();
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
  std::size_t index(int z, int y) const { return static_cast<std::size_t>(z) * size_.y() + y; }
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
  const ContourField field(solid, views, options);
  if (!field.rounds()) return {solid, {}};
  RayMinima minima(solid.size());
  minima.find(solid, field);
  VoxelGrid result = rounded(solid, field, minima);
  AxisCrossings crossings = CutEdges(solid, result, field, minima).collect();
  return {std::move(result), std::move(crossings)};
}

}  // namespace carve
