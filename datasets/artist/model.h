#pragma once
#include <array>
#include <string>
#include <vector>

#include "carve/core/vector.h"

namespace carve::artist {

struct Material {
  std::string name;
  Vec3 colour = Vec3::Constant(0.75);  // sRGB, 0..1, as the source gives it; white where a texture says more
  std::string texture = {};            // file name beside the source; empty: none
};

struct Corner {
  int position = 0;
  int texcoord = -1;  // -1: none
};

struct Face {
  std::array<Corner, 3> corners;  // counter-clockwise seen from outside
  int material = 0;
};

/// A model as its source has it: any axes, any unit, often several shells that pass through each other.
struct Model {
  std::vector<Vec3> positions;
  std::vector<Vec2> texcoords;  // (0, 0) = the picture's bottom left; outside [0, 1] the picture repeats
  std::vector<Face> faces;
  std::vector<Material> materials;
};

}  // namespace carve::artist
