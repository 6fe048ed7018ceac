#pragma once
#include <string>
#include <utility>
#include <vector>

#include "artist/model.h"

namespace carve::artist {

/// How a source's axes lie. The turns, right-handed rotations in degrees about a source axis, come first, one after
/// the other; then `up` becomes +Y and `front`, what faces the viewer, +Z.
struct Placement {
  std::string up = "+y", front = "+z";                // "+x", "-x", ... "-z"
  std::vector<std::pair<std::string, double>> turns;  // axis "x", "y" or "z", degrees
};

/// The model in world axes (views/frame.h): up +Y, front +Z, the longest side of its bounding box 1, centred on x and
/// z, standing on y = 0. Positions closer than 1e-6 of the longest side become one (texture coordinates stay with the
/// corners); triangles that collapse by that and positions, materials without a triangle are dropped. A connected part
/// that is inside out (negative volume) is turned: some modellers draw theirs clockwise.
/// \throws std::invalid_argument: unknown axis, up along front, or a model without extent
Model place(const Model& model, const Placement& placement);

}  // namespace carve::artist
