#pragma once
#include "carve/hull/silhouette.h"

namespace carve {

/// A polygon around the lattice's middle with one vertex in each of `vertices` equal sectors, at radii from low to high
/// (of half the lattice), all random.
LatticeLoop star(int vertices, double low, double high, unsigned seed);

/// The same on a coarse lattice of 16 x 16 nodes: edges in one plane, vertices on edges, three planes in a line are the
/// rule rather than the exception.
LatticeLoop coarse_star(unsigned seed);

/// A smooth outline with a few bays, sampled at `vertices` points.
LatticeLoop wave(int vertices, unsigned seed);

/// By turns: stars, smooth outlines, rings with an island in their hole, coarse stars, rings in coarse stars' places.
/// Three axes; the same seed gives the same silhouettes everywhere.
Silhouettes random_silhouettes(unsigned seed);

/// Rectangles of an axis-parallel box, low to high.
Silhouettes box_silhouettes(const std::array<std::int32_t, 3>& low, const std::array<std::int32_t, 3>& high);

LatticeLoop rectangle(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1);
LatticeLoop reversed(LatticeLoop loop);

}  // namespace carve
