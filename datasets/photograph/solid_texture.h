#pragma once
#include "carve/core/vector.h"

namespace carve {

struct SolidTextureOptions {
  double grain = 0.8;  // % of the longest side
  int octaves = 4;
  int seed = 1;
};
template <class Visitor>
void visit_fields(SolidTextureOptions& o, Visitor&& field) {
  field("grain", o.grain, 0.01, 100.0, "size of the finest detail in % of the object's longest side");
  field("octaves", o.octaves, 1, 12, "sizes of detail, each twice as large as the one before");
  field("seed", o.seed, 0, 2147483647, "which texture");
}

/// A colour that tells places apart: solid value noise \cite peachey_1985, three independent channels in [0, 1] of
/// `octaves` sizes with equal amplitude, its contrast stretched so that most of the range is used. Needs no texture
/// coordinates; continuous; the same place and seed give the same colour. `side` is the object's longest side.
Vec3 noise_colour(const Vec3& place, double side, const SolidTextureOptions& options);

}  // namespace carve
