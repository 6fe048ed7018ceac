#pragma once
#include <memory>
#include <vector>

#include "carve/core/raster.h"
#include "carve/core/vector.h"
#include "carve/grid/voxel_grid.h"
#include "carve/views/view_set.h"

namespace carve {

struct RegionOptions {
  double gap = 8;  // pixels
  bool colours = true;
  double ends = 10;  // %
};
template <class Visitor>
void visit_fields(RegionOptions& o, Visitor&& field) {
  field("gap", o.gap, 0.0, 64.0,
        "gaps in strokes up to this many pixels are closed; longer ones where the outline has some, as long as those");
  field("colours", o.colours, "colour boundaries separate regions too, not only strokes");
  field("ends", o.ends, 0.0, 100.0,
        "a stroke that ends in a region cuts it on to the nearest border within this % of the drawing's longest side");
}

/// What lies between a grid pixel and a neighbour in the drawing.
enum class Border : std::uint8_t {
  none,    // the same region and no stroke near: the surface goes on
  near,    // no border, but a stroke within the tolerance
  stroke,  // a stroke that separates two regions
  open,    // a stroke that does not (it ends inside the region)
  colour   // two colours without a stroke between them
};

/// One drawing cut into regions, at the grid's resolution, laid out as in grid/shadow.h.
///
/// A region is a connected part of the object between strokes, gaps closed, and of one colour or texture. Stroke pixels
/// belong to the nearest region.
struct RegionMap {
  View view;
  int count = 0;
  Raster<int> region;           // 0 .. count-1; -1 where the hull has no voxel
  Raster<Border> right, below;  // border to the pixel on the right / below
  std::vector<Vec3> colour;     // mean sRGB per region, 0..255
};

/// Where the borders between regions lie between a grid pixel's centre and its neighbour's on the right (below), in (0,
/// 1) of the way: in the middle of the stroke between them, to a fraction of a pixel, or where the colour changes. 0
/// where both are of one region, or others lie between them. Laid out as RegionMap.
struct RegionBorders {
  View view;
  Raster<float> right, below;
};

/// A drawing cut into regions once, to be sampled on several grids. \pre the view outlives it
class CutDrawing {
 public:
  /// \param longest  the object's longest side: regions of less than a few of its 128ths do not count
  CutDrawing(const AlignedView& view, double longest, const RegionOptions& options = {});
  /// \param hull  its shadow says which pixels are the object
  RegionMap on(const VoxelGrid& hull) const;
  /// \param map  of the same hull
  RegionBorders borders(const RegionMap& map, const VoxelGrid& hull) const;

 private:
  class Work;
  std::shared_ptr<const Work> work_;
};

/// A drawing cut for one grid. \param hull  its shadow says which pixels are the object
RegionMap find_regions(const AlignedView& view, const VoxelGrid& hull, const RegionOptions& options = {});

}  // namespace carve
