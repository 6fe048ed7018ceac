#include <carve/grid/voxel_grid.h>
#include <carve/mesh/topology.h>
#include <carve/surface/marching_cubes.h>

// A program outside the project: one voxel's surface is a solid.
int main() {
  const carve::VoxelGrid voxel({1, 1, 1}, carve::Vec3::Zero(), 1.0, carve::Fill::full);
  return carve::topology(carve::marching_cubes(voxel)).solid() ? 0 : 1;
}
