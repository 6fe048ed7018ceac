#pragma once
#include <cstdint>
#include <vector>

#include "carve/core/raster.h"
#include "carve/core/vector.h"

namespace carve {

/// Drawings made in code: shapes painted over each other, later ones on top, sampled `samples` x `samples` times a
/// pixel (1 = hard borders). Coordinates are pixels; pixel (i, j) covers [i, i+1) x [j, j+1).

struct Shape {
  std::vector<Vec2> points;  // a closed polygon
  Rgba colour;
  double stroke = 0;  // width of a line along the polygon; 0 = the polygon's inside
};

using Sketch = std::vector<Shape>;

Shape polygon(std::vector<Vec2> points, Rgba colour);
Shape rectangle(double x0, double y0, double x1, double y1, Rgba colour);
Shape disc(Vec2 centre, double radius, Rgba colour);
Shape line(Vec2 from, Vec2 to, double width, Rgba colour);
Shape outline(Shape shape, double width, Rgba colour = {0, 0, 0, 255});
/// A smooth closed curve around the centre whose radius wanders between 60 % and 100 % of `radius`.
Shape blob(Vec2 centre, double radius, Rgba colour, unsigned seed);
/// A random simple polygon around the centre: alternately far and near corners.
Shape star(Vec2 centre, double radius, int corners, Rgba colour, unsigned seed);

/// On nothing: alpha is what the shapes cover. A shape of alpha 0 erases.
Picture drawn(const Sketch& sketch, int width, int height, int samples = 4);
Picture on_paper(const Picture& picture, Rgba paper);
/// The sketch with every coordinate and stroke multiplied.
Sketch scaled(Sketch sketch, double factor);

template <class T>
Raster<T> rotated(const Raster<T>& raster) {  // by 90 degrees
  Raster<T> out(raster.height, raster.width);
  for (int y = 0; y < raster.height; ++y)
    for (int x = 0; x < raster.width; ++x) out(raster.height - 1 - y, x) = raster(x, y);
  return out;
}
template <class T>
Raster<T> enlarged(const Raster<T>& raster, int factor) {
  Raster<T> out(raster.width * factor, raster.height * factor);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) out(x, y) = raster(x / factor, y / factor);
  return out;
}

}  // namespace carve
