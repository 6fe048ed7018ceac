#include "carve/carving/stroke_score.h"

#include <cstdlib>
#include <iomanip>
#include <ostream>

#include "carve/grid/shadow.h"

namespace carve {

std::ostream& operator<<(std::ostream& out, const StrokeScore& score) {
  const auto line = [&](const char* name, double value) {
    out << std::left << std::setw(14) << name << std::right << std::setw(12) << value << '\n';
  };
  line("drawn", score.drawn);
  line("explained", score.explained);
  line("unexplained", score.unexplained);
  line("uncovered", score.uncovered);
  line("recall", score.recall());
  line("precision", score.precision());
  return out;
}

StrokeScore score_strokes(const VoxelGrid& solid, std::span<const RegionMap> views) {
  StrokeScore score;
  const double longest = solid.size().maxCoeff();
  for (const RegionMap& view : views) {
    const Raster<int> depths = depth(solid, view.view);
    const auto compare = [&](Border border, int a, int b) {
      if (a < 0 || b < 0 || border == Border::near) return;
      const double share = std::abs(a - b) / longest;
      if (border == Border::stroke || border == Border::open) {
        ++score.drawn;
        score.explained += kStrokeJump(share);
      } else {
        score.unexplained += kUnexplainedJump(share);
      }
    };
    for (int j = 0; j < depths.height; ++j)
      for (int i = 0; i < depths.width; ++i) {
        if (view.region(i, j) >= 0 && depths(i, j) < 0) ++score.uncovered;
        if (i + 1 < depths.width) compare(view.right(i, j), depths(i, j), depths(i + 1, j));
        if (j + 1 < depths.height) compare(view.below(i, j), depths(i, j), depths(i, j + 1));
      }
  }
  return score;
}

}  // namespace carve
