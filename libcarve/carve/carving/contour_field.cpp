#include "carve/carving/contour_field.h"

#include <cmath>

#include "carve/carving/row_hull.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr double kFilled = 0.95;         // share of its contour that a section fills, if its box is what bounds it
constexpr double kFilledGrown = 0.7;     // the same in a solid that looks grown
constexpr std::size_t kFewestGrown = 3;  // slices of a part whose outlines have a direction
constexpr double kBlend = 0.12;          // of the longest side: how far apart sections that look grown are alike
constexpr double kSoften = 0.04;         // of the longest side: how far apart the ends of what is kept are alike
constexpr int kFarthest = 16;            // voxels, of both: work stays in bounds

/// A bit for each corner that lies between two ends which drift.
std::uint8_t drifting_corners(const Drift& drift) {
  constexpr float kDrifts = 0.06f;  // voxels a slice
  std::uint8_t corners = 0;
  for (const int c : {0, 1, 2, 3}) {
    const auto [u, v] = at_corner(drift, c);
    corners |= (std::min(u, v) > kDrifts) << c;
  }
  return corners;
}

}  // namespace

ContourField::ContourField(const VoxelGrid& solid, const ViewSet& views, const ConvexOptions& options)
    : size_(solid.size()) {
  for (int axis = 0; axis < 3; ++axis) cuts_[axis] = cut(solid, axis, views);
  std::array<std::vector<Drift>, 3> ways;
  for (int axis = 0; axis < 3; ++axis) ways[axis] = drifts(cuts_[axis], size_.maxCoeff());
  const bool all = grown(cuts_, ways) >= options.grown;
  soften_ = all ? voxels(kSoften) : 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<PartContour> contours = part_contours(cuts_[axis], size_.maxCoeff(), options, !all);
    std::vector<std::uint8_t> corners;  // of each section, a bit for each corner that is rounded
    for (std::size_t s = 0; s < ways[axis].size(); ++s) {
      const int part = cuts_[axis].sections[s].part;
      const bool by_corners =
          all && contours[part].exponent == kRectangle && cuts_[axis].parts[part].size() >= kFewestGrown;
      exponents_[axis].push_back(by_corners ? kEllipse : contours[part].exponent);
      corners.push_back(by_corners ? drifting_corners(ways[axis][s]) : contours[part].corners);
    }
    keep_unfilled(axis, all ? kFilledGrown : kFilled, all ? 0 : kConvex);
    weigh_corners(axis, corners, all ? voxels(kBlend) : 0);
    rounds_[axis] = std::ranges::any_of(exponents_[axis], [](int e) { return e != kRectangle; });
  }
}

void ContourField::layer(int z, std::vector<float>& field) const {
  const int nx = size_.x(), ny = size_.y();
  field.assign(static_cast<std::size_t>(nx) * ny, 0);
  for (int x = 0; rounds_[0] && x < nx; ++x) row(0, x, z, &field[x], nx);
  for (int y = 0; rounds_[1] && y < ny; ++y) row(1, y, z, &field[static_cast<std::size_t>(y) * nx], 1);
  for (int y = 0; rounds_[2] && y < ny; ++y) row(2, z, y, &field[static_cast<std::size_t>(y) * nx], 1);
}

/// Calls use(section, exponent, u, value) for the voxels of row v of a slice that lie in rounded sections.
template <class Use>
void ContourField::each_value(int axis, int slice, int v, Use&& use) const {
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
void ContourField::keep_unfilled(int axis, double filled, double convex) {
  const Sections& all = cuts_[axis];
  parallel_ranges(0, all.slices, 4, [&](int first, int last) {
    for (int slice = first; slice < last; ++slice) {
      const int begin = all.first_section[slice], end = all.first_section[slice + 1];
      std::vector<RowHull> hulls(end - begin);
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

int ContourField::voxels(double share) const {
  return std::clamp(static_cast<int>(std::lround(share * size_.maxCoeff())), 1, kFarthest);
}

/// How much each section's corners are rounded: the share of the sections up to `reach` slices away whose corner is,
/// since slices that are decided one by one would stand out as fins.
void ContourField::weigh_corners(int axis, const std::vector<std::uint8_t>& corners, int reach) {
  const std::vector<Section>& sections = cuts_[axis].sections;
  const auto rounded = [&](int s, int corner) {
    return exponents_[axis][s] != kRectangle && (corners[s] >> corner & 1);
  };
  std::vector<std::array<float, 4>>& weights = weights_[axis];
  weights.resize(sections.size());
  parallel_ranges(0, static_cast<int>(sections.size()), 256, [&](int first, int last) {
    for (int s = first; s < last; ++s) {
      std::array<int, 4> with{};
      int count = 0;
      const auto add = [&](int other) {
        for (const int c : {0, 1, 2, 3}) with[c] += rounded(other, c);
        ++count;
      };
      add(s);
      for (int t = sections[s].above, i = 0; t >= 0 && i < reach; ++i, t = sections[t].above) add(t);
      for (int t = sections[s].below, i = 0; t >= 0 && i < reach; ++i, t = sections[t].below) add(t);
      for (const int c : {0, 1, 2, 3}) weights[s][c] = static_cast<float>(with[c]) / static_cast<float>(count);
    }
  });
  for (std::size_t s = 0; s < sections.size(); ++s)
    if (exponents_[axis][s] == kRectangle && std::ranges::max(weights[s]) > 0) exponents_[axis][s] = kEllipse;
}

/// Row v of a slice; voxel u's value is field[u * step].
void ContourField::row(int axis, int slice, int v, float* field, int step) const {
  each_value(axis, slice, v, [&](int section, int u, float value) {
    const float weight = weights_[axis][section][corner_of(cuts_[axis].sections[section], u, v)];
    if (weight == 0) return;
    float& largest = field[static_cast<std::size_t>(u) * step];
    largest = std::max(largest, value * (1 + weight) / 2);  // half of it is a box's
  });
}

}  // namespace carve
