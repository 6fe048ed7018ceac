#pragma once
#include <map>
#include <vector>

#include "carve/views/view_set.h"

namespace carve {

/// A solid that is a union of boxes, each in its own flat colour, in a box of `size` units.
struct BoxWorld {
  struct Part {
    Vec3i low, high;
    Rgba colour = {150, 150, 150, 255};
  };
  Vec3i size;
  std::vector<Part> parts;
  bool inside(const Vec3& p) const;  // p in units from the low corner
};

struct BoxDrawing {
  int scale = 6;   // pixels a unit
  int stroke = 3;  // pixels
  int broken = 0;  // pixels rubbed out of every 24 along inner strokes
};

/// A clean drawing: flat colours, outline inside the silhouette, strokes centred on depth jumps of one unit and more.
Drawing draw(const BoxWorld& world, View view, const BoxDrawing& options = {});
ViewSet views_of(const BoxWorld& world, std::span<const View> views, const BoxDrawing& options = {});

/// A couch, an armchair without a back wall's colour, and stairs between walls, in units.
BoxWorld couch();
BoxWorld walled_stairs_world(int steps);
/// A tray without a front wall, divided by up to two ribs that are lower than its walls: each silhouette is full.
BoxWorld random_pockets(unsigned seed);

}  // namespace carve
