#include "carve/carving/part_contours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr int kSteepestExponent = 40;  // from here on a superellipse is a rectangle
constexpr int kFewestSlices = 12;      // of a part: fewer do not tell a curve from a line
constexpr float kSlope = 0.4f;         // voxels a slice: an outline that certainly is not upright

/// Slices over which an outline's direction is measured.
int window(int longest) { return std::max(2, (longest + 16) / 32); }

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

/// Which way an end goes over the slices around it, in voxels a slice: the slope of the line through them, as far as
/// they hang together.
float drift(const Sections& all, int section, int end, int steps) {
  double n = 0, sum_i = 0, sum_ii = 0, sum_y = 0, sum_iy = 0;
  const auto add = [&](int i, int s) {
    const double y = all.sections[s].ends[end];
    n += 1, sum_i += i, sum_ii += i * i, sum_y += y, sum_iy += i * y;
  };
  add(0, section);
  for (const int step : {-1, 1})
    for (int s = section, i = step; std::abs(i) <= steps; i += step) {
      const int next = step > 0 ? all.sections[s].above : all.sections[s].below;
      if (next < 0 || std::abs(all.sections[next].ends[end] - all.sections[s].ends[end]) > 1.5f * Sections::kJump)
        break;
      add(i, s = next);
    }
  return n < 3 ? 0 : static_cast<float>(std::abs((n * sum_iy - sum_i * sum_y) / (n * sum_ii - sum_i * sum_i)));
}

}  // namespace

std::vector<Drift> drifts(const Sections& all, int longest) {
  std::vector<Drift> result(all.sections.size());
  const int steps = window(longest);
  parallel_ranges(0, static_cast<int>(result.size()), 256, [&](int first, int last) {
    for (int s = first; s < last; ++s)
      for (int end = 0; end < 4; ++end) result[s][end] = drift(all, s, end, steps);
  });
  return result;
}

double grown(std::span<const Sections> cuts, std::span<const std::vector<Drift>> ways) {
  constexpr float kDrifts = 0.13f, kStands = 0.03f;  // voxels a slice
  double area = 0, drifting = 0, standing = 0;
  for (std::size_t axis = 0; axis < cuts.size(); ++axis)
    for (std::size_t s = 0; s < ways[axis].size(); ++s) {
      const double corner = cuts[axis].sections[s].area / 4.0;
      area += 4 * corner;
      for (const int c : {0, 1, 2, 3}) {
        const auto [u, v] = at_corner(ways[axis][s], c);
        if (std::min(u, v) > kDrifts) drifting += corner;
        if (std::max(u, v) < kStands) standing += corner;
      }
    }
  return area > 0 ? (drifting - standing) / area : 0;
}

double superellipse_fill(double exponent) {
  return std::exp(2 * std::lgamma(1 + 1 / exponent) - std::lgamma(1 + 2 / exponent));
}

std::vector<int> part_exponents(const Sections& all, int longest, const ConvexOptions& options) {
  std::vector<int> exponents(all.parts.size(), kRectangle);
  const int steps = window(longest);
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

}  // namespace carve
