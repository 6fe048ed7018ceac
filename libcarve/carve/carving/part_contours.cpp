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

/// Sum of an end's squared distances, in voxels, from the straight line that fits it best over sections [first, last).
double off_line(const Sections& all, const std::vector<int>& part, int end, std::size_t first, std::size_t last) {
  const double n = static_cast<double>(last - first), middle = (n - 1) / 2;
  double mean = 0, rise = 0, squares = 0;
  for (std::size_t i = first; i < last; ++i) mean += all.sections[part[i]].ends[end] / n;
  for (std::size_t i = first; n > 1 && i < last; ++i)
    rise += (i - first - middle) * (all.sections[part[i]].ends[end] - mean) * 12 / (n * (n * n - 1));
  for (std::size_t i = first; i < last; ++i)
    squares += std::pow(all.sections[part[i]].ends[end] - mean - rise * (i - first - middle), 2);
  return squares;
}

/// Whether an end is curved: `least` voxels (root mean square) off a straight line, and not because of one kink.
bool is_curved(const Sections& all, const std::vector<int>& part, int end, double least) {
  constexpr double kKink = 0.1;  // of the distance from one line is left to two; to a parabola's halves a quarter
  const double one = off_line(all, part, end, 0, part.size());
  if (one < least * least * part.size()) return false;
  for (std::size_t kink = 2; kink + 2 <= part.size(); ++kink)
    if (off_line(all, part, end, 0, kink) + off_line(all, part, end, kink, part.size()) < kKink * kKink * one)
      return false;
  return true;
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

/// The superellipse that a section is, by its area; kRectangle if it is none, hardly less than its box, or too small.
int exponent_of(const Sections& all, int number) {
  constexpr int kSmallest = 8, kSquarest = 3;            // voxels across; exponent
  constexpr double kAlike = 0.94, kCornersAlike = 0.85;  // intersection over union
  const Section& section = all.sections[number];
  if (std::min(section.width(), section.height()) < kSmallest) return kRectangle;
  const double box = section.width() * section.height();
  int exponent = 2;
  while (superellipse_fill(exponent + 0.5) <= section.area / box)
    if (++exponent > kSquarest) return kRectangle;
  std::array<int, 4> area{}, both{};  // of the corners
  for (int v = section.box[2]; v < section.box[3]; ++v) {
    const int at = section.slice * all.height + v;
    const float across = way_out(v, section.ends[2], section.ends[3], exponent);
    for (int r = all.first_run[at]; r < all.first_run[at + 1]; ++r)
      for (int u = all.runs[r].u0; all.runs[r].section == number && u < all.runs[r].u1; ++u) {
        const int corner = corner_of(section, u, v);
        ++area[corner];
        both[corner] += across + way_out(u, section.ends[0], section.ends[1], exponent) <= 1;
      }
  }
  const double quarter = box * superellipse_fill(exponent) / 4;
  const auto alike = [](double common, double area, double contour) { return common / (area + contour - common); };
  double common = 0;
  for (const int c : {0, 1, 2, 3}) {
    if (alike(both[c], area[c], quarter) < kCornersAlike) return kRectangle;
    common += both[c];
  }
  return alike(common, section.area, 4 * quarter) < kAlike ? kRectangle : exponent;
}

/// Of a part that tapers from its largest section: what the drawing along the axis shows is round there.
PartContour tapering(const Sections& all, const std::vector<int>& part) {
  constexpr std::size_t kFewestTapering = 6;  // slices: fewer do not tell a taper from a step
  if (part.size() < kFewestTapering) return {};
  int largest = 0, exponent = kRectangle;
  for (const int s : part) largest = std::max(largest, all.sections[s].area);
  for (const int s : part)
    if (all.sections[s].area == largest) exponent = std::max(exponent, exponent_of(all, s));
  return {exponent};
}

/// Of a part whose outlines are curved: its corners between two that are.
PartContour curved(const Sections& all, const std::vector<int>& part, double least_bend) {
  if (static_cast<int>(part.size()) < kFewestSlices) return {};
  std::array<bool, 4> bent;
  for (int end = 0; end < 4; ++end) bent[end] = is_curved(all, part, end, least_bend);
  PartContour contour{kRectangle, 0};
  for (const int c : {0, 1, 2, 3}) contour.corners |= (bent[c & 1] && bent[2 + (c >> 1)]) << c;
  if (!contour.corners) return {};
  float widest = 0, highest = 0, width = 0, height = 0;
  for (const int s : part) {
    const Section& section = all.sections[s];
    widest = std::max(widest, section.width()), highest = std::max(highest, section.height());
    width += section.width() / part.size(), height += section.height() / part.size();
  }
  contour.exponent = contour_exponent(std::max(width / widest, height / highest));
  return contour;
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
  const double quarter = std::tgamma(1 + 1 / exponent);  // lgamma writes a global, and threads come here at once
  return quarter * quarter / std::tgamma(1 + 2 / exponent);
}

std::vector<PartContour> part_contours(const Sections& all, int longest, const ConvexOptions& options, bool built) {
  std::vector<PartContour> contours(all.parts.size());
  const int steps = window(longest);
  parallel_ranges(0, static_cast<int>(all.parts.size()), 16, [&](int first, int last) {
    for (int p = first; p < last; ++p) {
      const std::vector<int>& part = all.parts[p];
      if (sloping_corners(all, part, steps) < options.evidence) continue;
      contours[p] = curved(all, part, options.bend / 100 * longest);
      if (!built)
        contours[p].corners = kAllCorners;
      else if (contours[p].exponent == kRectangle)
        contours[p] = tapering(all, part);
    }
  });
  return contours;
}

}  // namespace carve
