#pragma once
#include <cstdint>
#include <vector>

#include "carve/mesh/mesh.h"
#include "carve/surface/crossings.h"

namespace carve {

/// How a vertex may move without leaving what is drawn.
struct Guide {
  enum class Kind : std::uint8_t {
    free,   // no drawing shows where it lies
    plane,  // across `axis`, the surface's unit normal there
    line,   // along `axis`, the unit direction of an edge
    fixed   // not at all: a corner
  };
  Kind kind = Kind::free;
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();
};
using Guides = std::vector<Guide>;

/// The guides of marching cubes' vertices. Where an outline put a vertex the surface is the outline swept along the
/// view's direction, so the vertex has the outline's normal. Where nothing put it, carving left a face of voxels: the
/// vertex lies in that face's plane if the face ends at edges and not at small steps, as slanted and round ones do.
/// \param mesh  marching_cubes(grid, crossings)
Guides vertex_guides(const Mesh& mesh, const VoxelGrid& grid, const Crossings& crossings);

}  // namespace carve
