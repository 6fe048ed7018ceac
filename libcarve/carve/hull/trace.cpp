#include "carve/hull/trace.h"

namespace carve::hull {
namespace {

constexpr int kStepX[] = {1, 0, -1, 0}, kStepY[] = {0, 1, 0, -1};  // counter-clockwise

struct Tracer {
  const Mask& mask;
  std::span<const std::int32_t> columns, rows;
  Mask seen;  // lower sides that belong to a loop already

  bool inside(int x, int y) const { return mask.contains(x, y) && mask(x, y) != 0; }
  // The pixel ahead of a corner of pixels, to the left or right of the way.
  bool ahead(int x, int y, int direction, bool left) const {
    static constexpr int dx[] = {0, -1, -1, 0}, dy[] = {0, 0, -1, -1};
    const int quadrant = (direction + (left ? 0 : 3)) % 4;
    return inside(x + dx[quadrant], y + dy[quadrant]);
  }

  LatticeLoop loop(int x, int y) {
    LatticeLoop points;
    int direction = 0;
    do {
      if (direction == 0) seen(x, y) = 1;
      x += kStepX[direction];
      y += kStepY[direction];
      const bool left = ahead(x, y, direction, true), right = ahead(x, y, direction, false);
      if (left && !right) continue;
      const int turned = (direction + (left ? 3 : 1)) % 4;
      const LatticePoint corner{columns[x], rows[y]};
      if (!left && right) {  // two pixels meet here
        points.push_back({corner[0] - kStepX[direction], corner[1] - kStepY[direction]});
        points.push_back({corner[0] + kStepX[turned], corner[1] + kStepY[turned]});
      } else {
        points.push_back(corner);
      }
      direction = turned;
    } while (direction != 0 || seen(x, y) == 0);
    return points;
  }
};

}  // namespace

std::vector<LatticeLoop> trace(const Mask& mask, std::span<const std::int32_t> columns,
                               std::span<const std::int32_t> rows) {
  Tracer tracer{mask, columns, rows, Mask(mask.width, mask.height)};
  std::vector<LatticeLoop> loops;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (tracer.inside(x, y) && !tracer.inside(x, y - 1) && !tracer.seen(x, y)) loops.push_back(tracer.loop(x, y));
  return loops;
}

}  // namespace carve::hull
