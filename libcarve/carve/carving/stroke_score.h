#pragma once
#include <iosfwd>
#include <span>

#include "carve/carving/regions.h"

namespace carve {

/// What depth jumps between neighbouring grid pixels say about the drawn strokes, in shares of the object's longest
/// side: a jump below `low` is none, above `high` it is one, in between in proportion.
struct JumpRamp {
  double low, high;
  double operator()(double share) const { return share <= low ? 0 : share >= high ? 1 : (share - low) / (high - low); }
};
inline constexpr JumpRamp kStrokeJump{0.004, 0.02};      // enough to explain a stroke
inline constexpr JumpRamp kUnexplainedJump{0.02, 0.06};  // more than a steep surface has between two grid pixels

/// How well a solid explains the inner strokes and the silhouettes of the drawings it was carved from; no ground truth
/// is needed. Counts are sides of grid pixels, summed over the views.
struct StrokeScore {
  double drawn = 0;        // that a stroke crosses
  double explained = 0;    // of those: with a depth jump
  double unexplained = 0;  // depth jumps away from strokes
  double uncovered = 0;    // pixels of the hull's shadows that no voxel reaches any more

  double recall() const { return drawn > 0 ? explained / drawn : 1; }
  double precision() const { return explained + unexplained > 0 ? explained / (explained + unexplained) : 1; }
  /// Larger is better: explained strokes less what is wrong.
  double value() const { return explained - unexplained - 50 * uncovered; }
  /// It is better, and not at the price of jumps elsewhere: for four strokes it explains at most one side is added.
  bool explains_more_than(const StrokeScore& other) const {
    return value() > other.value() && unexplained - other.unexplained <= (explained - other.explained) / 4;
  }
};
std::ostream& operator<<(std::ostream& out, const StrokeScore& score);  // one aligned line a field

/// Re-renders the depth of `solid` in every view and compares its jumps with the drawings'.
StrokeScore score_strokes(const VoxelGrid& solid, std::span<const RegionMap> views);

}  // namespace carve
