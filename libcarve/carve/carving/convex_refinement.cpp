#include "carve/carving/convex_refinement.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

#include "carve/carving/sections.h"
#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr int kRectangle = 0;          // instead of an exponent
constexpr int kSteepestExponent = 40;  // from here on a superellipse is a rectangle
constexpr int kFewestSlices = 12;      // of a part: fewer do not tell a curve from a line
constexpr double kFilled = 0.95;       // share of its contour that a section fills, if its box is what bounds it
constexpr double kConvex = 0.97;       // share of its convex hull that a convex section fills, for its voxels' corners
constexpr float kSlope = 0.4f;         // voxels a slice: an outline that certainly is not upright
constexpr float kTolerance = 1e-4f;    // a mirrored solid gives the mirrored result

/// How steeply an end moves over the next or the last `steps` slices, in voxels a slice; 0 past a jump or the part's
/// end.
float slope(const Sections& all, int section, int end, int Section::*next, int steps) {
  int other = section;
  for (int i = 0; i < steps && other >= 0; ++i) other = all.sections[other].*next;
  if (other < 0) return 0;
  const float rise = std::abs(all.sections[other].ends[end] - all.sections[section].ends[end]) / steps;
  return rise <= Sections::kJump ? rise : 0;
}

/// The share of a part's corners that lie between two ends which both move, so that a box's edge is none there.
float sloping_corners(const Sections& all, const std::vector<int>& part, int steps) {
  float corners = 0;
  for (const int s : part) {
    std::array<float, 4> side;
    for (int end = 0; end < 4; ++end)
      side[end] = std::max(slope(all, s, end, &Section::above, steps), slope(all, s, end, &Section::below, steps));
    for (const int u : {0, 1})
      for (const int v : {2, 3}) corners += std::min(1.f, std::min(side[u], side[v]) / kSlope) / 4;
  }
  return corners / part.size();
}

/// Root mean square distance of an end from its best straight line, in voxels.
double bend(const Sections& all, const std::vector<int>& part, int end) {
  const double n = static_cast<double>(part.size());
  double mean = 0, rise = 0, squares = 0;
  for (const int s : part) mean += all.sections[s].ends[end] / n;
  for (std::size_t i = 0; i < part.size(); ++i)
    rise += (i - (n - 1) / 2) * (all.sections[part[i]].ends[end] - mean) * 12 / (n * (n * n - 1));
  for (std::size_t i = 0; i < part.size(); ++i) {
    const double off = all.sections[part[i]].ends[end] - mean - rise * (i - (n - 1) / 2);
    squares += off * off / n;
  }
  return std::sqrt(squares);
}

/// The share of its box that a superellipse fills.
double superellipse_fill(double exponent) {
  return std::exp(2 * std::lgamma(1 + 1 / exponent) - std::lgamma(1 + 2 / exponent));
}

/// The exponent of the sections of a part whose outlines fill a share of their boxes. Outlines are cut off where the
/// part ends, so that they fill more than the contour they were cut from: an ellipse is meant up to kCutEllipse.
int contour_exponent(double outline_fill) {
  constexpr double kCutEllipse = 0.83, kCutRectangle = 1.02;
  const double ellipse = superellipse_fill(2);
  const double fill = ellipse + (outline_fill - kCutEllipse) * (1 - ellipse) / (kCutRectangle - kCutEllipse);
  int exponent = 2;
  while (exponent < kSteepestExponent && superellipse_fill(exponent + 0.5) <= fill) ++exponent;
  return exponent < kSteepestExponent ? exponent : kRectangle;
}

/// Each part's exponent.
std::vector<int> contours(const Sections& all, int longest, const ConvexOptions& options) {
  std::vector<int> exponents(all.parts.size(), kRectangle);
  const int steps = std::max(2, (longest + 16) / 32);
  parallel_ranges(0, static_cast<int>(all.parts.size()), 16, [&](int first, int last) {
    for (int p = first; p < last; ++p) {
      const std::vector<int>& part = all.parts[p];
      if (static_cast<int>(part.size()) < kFewestSlices || sloping_corners(all, part, steps) < options.evidence)
        continue;
      const auto bent = [&](int end) { return std::max(bend(all, part, end), bend(all, part, end + 1)); };
      if (std::min(bent(0), bent(2)) < options.bend / 100 * longest) continue;
      float widest = 0, highest = 0, width = 0, height = 0;
      for (const int s : part) {
        const Section& section = all.sections[s];
        widest = std::max(widest, section.width()), highest = std::max(highest, section.height());
        width += section.width() / part.size(), height += section.height() / part.size();
      }
      exponents[p] = contour_exponent(std::max(width / widest, height / highest));
    }
  });
  return exponents;
}

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
    for (int axis = 0; axis < 3; ++axis) {
      cuts_[axis] = cut(solid, axis, views);
      const std::vector<int> exponents = contours(cuts_[axis], size_.maxCoeff(), options);
      for (const Section& s : cuts_[axis].sections) exponents_[axis].push_back(exponents[s.part]);
      keep_unfilled(axis);
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
  void keep_unfilled(int axis) {
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
          if (inside[s - begin] < kFilled * contour || section.area < kConvex * hulls[s - begin].area())
            exponent = kRectangle;
        }
      }
    });
  }

  /// Row v of a slice; voxel u's value is field[u * step].
  void row(int axis, int slice, int v, float* field, int step) const {
    each_value(axis, slice, v, [&](int, int u, float value) {
      float& largest = field[static_cast<std::size_t>(u) * step];
      largest = std::max(largest, value);
    });
  }

  Vec3i size_;
  std::array<Sections, 3> cuts_;
  std::array<std::vector<int>, 3> exponents_;  // of each section
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

}  // namespace

VoxelGrid refine_convex(const VoxelGrid& solid, const ViewSet& views, const ConvexOptions& options) {
  check("convex", options);
  if (!options.arm) return solid;
  const ContourField field(solid, views, options);
  if (!field.rounds()) return solid;
  RayMinima minima(solid.size());
  minima.find(solid, field);
  VoxelGrid result = solid;
  parallel_ranges(0, solid.size().z(), 4, [&](int first, int last) {
    std::vector<float> values;
    for (int z = first; z < last; ++z) {
      field.layer(z, values);
      RayMinima::each_voxel(solid, z, [&](int x, int y, std::size_t pixel) {
        if (values[pixel] > 1 + kTolerance && values[pixel] > minima.level(x, y, z) + kTolerance)
          result.set(x, y, z, false);
      });
    }
  });
  return result;
}

}  // namespace carve
