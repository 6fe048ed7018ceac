#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "carve/carving/convex_refinement.h"
#include "carve/carving/sections.h"

namespace carve {

inline constexpr int kRectangle = 0;  // instead of an exponent
inline constexpr int kEllipse = 2;
inline constexpr std::uint8_t kAllCorners = 15;

/// |distance of a voxel's centre from the middle / half the way to the ends| ^ exponent; the sum of both axes' is below
/// 1 inside the superellipse.
inline float way_out(int index, float low, float high, int exponent) {
  float base = std::abs((2 * index + 1 - low - high) / (high - low)), result = 1;
  for (; exponent; exponent >>= 1, base *= base)
    if (exponent & 1) result *= base;
  return result;
}

/// The share of its box that the superellipse |u|^exponent + |v|^exponent = 1 fills.
double superellipse_fill(double exponent);

/// The corner of its section that voxel (u, v) lies nearest: bit 0 is the upper end of u, bit 1 that of v.
inline int corner_of(const Section& section, int u, int v) {
  const std::array<float, 4>& ends = section.ends;
  return (2 * u + 1 > ends[0] + ends[1]) + 2 * (2 * v + 1 > ends[2] + ends[3]);
}

/// How fast each of a section's ends moves over the slices around it, in voxels a slice: the slope of the line through
/// them, as far as they hang together.
using Drift = std::array<float, 4>;
/// \param longest  voxels along the solid's longest side
std::vector<Drift> drifts(const Sections& all, int longest);

/// Of the two ends that meet in corner 0 .. 3.
inline std::pair<float, float> at_corner(const Drift& drift, int corner) {
  return {drift[corner & 1], drift[2 + (corner >> 1)]};
}

/// How far a solid looks grown and not built, in [-1, 1]: the share of its sections' corners that lie between two ends
/// which both drift, less the share between two that both stand. \param cuts, ways  across the three axes
double grown(std::span<const Sections> cuts, std::span<const std::vector<Drift>> ways);

/// What rounds a part's sections: an exponent of at least 2, or kRectangle where the drawings do not show that it is
/// round; and a bit for each corner that it rounds.
struct PartContour {
  int exponent = kRectangle;
  std::uint8_t corners = kAllCorners;
};
/// \param built  does not look grown: corners beside straight outlines stay, and straight tapers from an ellipse are
/// round
std::vector<PartContour> part_contours(const Sections& all, int longest, const ConvexOptions& options, bool built);

}  // namespace carve
