#include "carve/image/outline_loops.h"

#include <compare>
#include <map>

#include "carve/image/outline.h"

namespace carve {
namespace {

struct Line {
  int x, y;
  bool along_row;
  auto operator<=>(const Line&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 sees its zero
};

bool in(const Mask& coverage, int x, int y) { return coverage.contains(x, y) && coverage(x, y) >= 128; }

/// The next crossing along the outline.
std::map<Line, Line> link_cells(const Mask& coverage) {
  std::map<Line, Line> next;
  for (int y = -1; y < coverage.height; ++y)
    for (int x = -1; x < coverage.width; ++x) {
      // Corners and edges counter-clockwise as seen: edge k lies between corner k and k + 1.
      const bool corner[4] = {in(coverage, x, y), in(coverage, x, y + 1), in(coverage, x + 1, y + 1),
                              in(coverage, x + 1, y)};
      if (corner[0] == corner[1] && corner[1] == corner[2] && corner[2] == corner[3]) continue;
      const Line edge[4] = {{x, y, false}, {x, y + 1, true}, {x + 1, y, false}, {x, y, true}};
      for (int k = 0; k < 4; ++k) {
        // Each run of inside corners is cut off on its own, as the surface does it on faces.
        if (corner[k] || !corner[(k + 1) % 4]) continue;
        int end = (k + 1) % 4;
        while (corner[(end + 1) % 4]) end = (end + 1) % 4;
        next.emplace(edge[end], edge[k]);
      }
    }
  return next;
}

Vec2 place(const Mask& coverage, const Outline& outline, const Line& line) {
  double column = line.x + 0.5, row = line.y + 0.5;
  const bool first = in(coverage, line.x, line.y);
  if (line.along_row)
    column = outline.leave_along_row(first ? column : column + 1, first ? column + 1 : column, row);
  else
    row = outline.leave_along_column(first ? row : row + 1, first ? row + 1 : row, column);
  return {column, row};
}

}  // namespace

std::vector<std::vector<OutlineCrossing>> outline_loops(const Mask& coverage) {
  const Outline outline(coverage);
  std::map<Line, Line> next = link_cells(coverage);
  std::vector<std::vector<OutlineCrossing>> loops;
  while (!next.empty()) {
    std::vector<OutlineCrossing>& loop = loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      const Line line = at->first, following = at->second;
      loop.push_back({line.x, line.y, line.along_row, place(coverage, outline, line)});
      next.erase(at);
      at = next.find(following);
    }
  }
  return loops;
}

}  // namespace carve
