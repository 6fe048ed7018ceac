#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

/// Voxels u0 <= u < u1 of row v of a slice.
struct SectionRun {
  int u0, u1, section;
};

/// A connected set of voxels of one slice (by their edges, not their corners), in its box.
struct Section {
  int slice = 0;
  int part = -1;
  int area = 0;                 // voxels
  int above = -1, below = -1;   // the section of the next and the last slice that overlaps it most; -1: none, or a tie
  std::array<int, 4> box{};     // u0, u1, v0, v1: voxels u0 <= u < u1, v0 <= v < v1
  std::array<float, 4> ends{};  // the same to a fraction of a voxel, where a drawing shows the outline there
  float width() const { return ends[1] - ends[0]; }
  float height() const { return ends[3] - ends[2]; }
};

/// A solid cut into slices across one axis. u and v are the two other axes, in the order of x, y, z.
///
/// A part is a pile of sections, each in the next slice and overlapping it most both ways, whose ends nowhere move by
/// more than kJump voxels from slice to slice.
struct Sections {
  static constexpr float kJump = 2;
  int axis = 0, slices = 0, width = 0, height = 0;  // along the axis, u and v
  std::vector<SectionRun> runs = {};                // by slice, then v, then u
  std::vector<int> first_run = {};                  // of slice * height + v; one more at the end
  std::vector<Section> sections = {};               // by slice
  std::vector<int> first_section = {};              // of a slice; one more at the end
  std::vector<std::vector<int>> parts = {};         // sections, by slice
};

/// \param views  drawings that `solid` was carved from: they give the ends of sections to a fraction of a voxel
Sections cut(const VoxelGrid& solid, int axis, const ViewSet& views);

}  // namespace carve
