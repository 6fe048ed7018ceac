#include "carve/carving/as_printed.h"

#include <array>
#include <bit>

#include "carve/grid/shadow.h"

namespace carve {
namespace {

constexpr int kFewestEdges = 2;  // epsilon of Equation 3.5

class Printed {
 public:
  explicit Printed(const Carving& hull) : hull_(hull), grid_(hull.grid) {
    for (const PatchLabels& view : hull.views) {
      layouts_.emplace_back(grid_.size(), view.view);
      depths_.push_back(depth(grid_, view.view));
    }
  }

  /// Algorithm 3.3. Visibility is that of the hull; carving goes into a copy.
  VoxelGrid run() {
    for (int z = 0; z < grid_.size().z(); ++z)
      for (int y = 0; y < grid_.size().y(); ++y)
        for (int w = 0; w < grid_.words_per_row(); ++w)
          for (std::uint64_t bits = hull_.grid.row(y, z)[w]; bits; bits &= bits - 1) {
            const Vec3i voxel(w * 64 + std::countr_zero(bits), y, z);
            if (!consistent(voxel)) clear_the_way(voxel);
          }
    return std::move(grid_);
  }

 private:
  std::uint8_t label(std::size_t v, const Vec3i& at) const {
    const ShadowLayout& l = layouts_[v];
    return hull_.views[v].labels(l.right_index(at[l.frame.right.axis]), l.up_index(at[l.frame.up.axis]));
  }
  bool edge(std::size_t v, const Vec3i& at) const { return label(v, at) & kEdge; }

  bool visible(std::size_t v, const Vec3i& at) const {
    const ShadowLayout& l = layouts_[v];
    const int behind_face = l.toward_index(at[l.frame.toward.axis]);
    return depths_[v](l.right_index(at[l.frame.right.axis]), l.up_index(at[l.frame.up.axis])) == behind_face;
  }

  /// All four neighbours in the view's picture are edges.
  bool amid_edges(std::size_t v, const Vec3i& at) const {
    const Frame& f = layouts_[v].frame;
    for (const int axis : {f.right.axis, f.up.axis})
      for (const int step : {-1, 1}) {
        Vec3i n = at;
        n[axis] += step;
        if (!grid_.contains(n.x(), n.y(), n.z()) || !edge(v, n)) return false;
      }
    return true;
  }

  /// Equations 3.3 to 3.5: a voxel on edges of two views is seen in each of them, or lies amid other edges.
  bool consistent(const Vec3i& at) const {
    int edges = 0;
    bool all = true;
    for (std::size_t v = 0; v < layouts_.size(); ++v) {
      if (!edge(v, at)) continue;
      ++edges;
      all = all && (visible(v, at) || amid_edges(v, at));
    }
    return all || edges < kFewestEdges;
  }

  void clear_the_way(const Vec3i& from) {
    for (std::size_t v = 0; v < layouts_.size(); ++v) {
      const int axis = layouts_[v].frame.toward.axis;
      for (const int step : {-1, 1}) {
        Vec3i next = from;
        next[axis] += step;
        if (!grid_.contains(next.x(), next.y(), next.z())) continue;
        if (flat_around(v, next)) carve_from(next, axis, step);
      }
    }
  }

  /// A neighbour in the picture across the direction is surface without an edge: "a neighbor that does not project to
  /// an edge pixel".
  bool flat_around(std::size_t v, const Vec3i& at) const {
    const Frame& f = layouts_[v].frame;
    for (int du = -1; du <= 1; ++du)
      for (int dv = -1; dv <= 1; ++dv) {
        Vec3i n = at;
        n[f.right.axis] += du;
        n[f.up.axis] += dv;
        if (grid_.contains(n.x(), n.y(), n.z()) && label(v, n) == kSurface) return true;
      }
    return false;
  }

  /// Algorithm 3.4.
  void carve_from(Vec3i at, int axis, int step) {
    for (; grid_.contains(at.x(), at.y(), at.z()); at[axis] += step) grid_.set(at.x(), at.y(), at.z(), false);
  }

  const Carving& hull_;
  VoxelGrid grid_;
  std::vector<ShadowLayout> layouts_;
  std::vector<Raster<int>> depths_;
};

}  // namespace

VoxelGrid carve_as_printed(const Carving& hull) { return Printed(hull).run(); }

}  // namespace carve
