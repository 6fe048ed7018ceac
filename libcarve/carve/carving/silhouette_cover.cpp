#include "carve/carving/silhouette_cover.h"

#include <vector>

#include "carve/grid/shadow.h"

namespace carve {
namespace {

class Cover {
 public:
  Cover(VoxelGrid solid, const VoxelGrid& hull, std::span<const View> views) : solid_(std::move(solid)), hull_(hull) {
    for (const View view : views) {
      layouts_.emplace_back(hull.size(), view);
      const Mask wanted = shadow(hull, view), seen = shadow(solid_, view);
      open_.push_back(wanted);
      for (std::size_t i = 0; i < seen.pixels.size(); ++i) open_.back().pixels[i] &= !seen.pixels[i];
    }
  }

  VoxelGrid run() {
    for (std::size_t v = 0; v < layouts_.size(); ++v)
      for (int j = 0; j < layouts_[v].height; ++j)
        for (int i = 0; i < layouts_[v].width; ++i)
          if (open_[v](i, j)) close(layouts_[v], i, j);
    return std::move(solid_);
  }

 private:
  void close(const ShadowLayout& layout, int i, int j) {
    Vec3i at = Vec3i::Zero(), best = Vec3i::Zero();
    at[layout.frame.right.axis] = layout.right_index(i);
    at[layout.frame.up.axis] = layout.up_index(j);
    int best_worth = -1;
    const int axis = layout.frame.toward.axis;
    for (at[axis] = 0; at[axis] < layout.depth; ++at[axis]) {
      if (!hull_(at.x(), at.y(), at.z())) continue;
      if (const int worth = worth_of(at); worth > best_worth) {
        best_worth = worth;
        best = at;
      }
    }
    solid_.set(best.x(), best.y(), best.z(), true);
    for (std::size_t v = 0; v < layouts_.size(); ++v) pixel(v, best) = 0;
  }

  std::uint8_t& pixel(std::size_t v, const Vec3i& at) {
    const ShadowLayout& l = layouts_[v];
    return open_[v](l.right_index(at[l.frame.right.axis]), l.up_index(at[l.frame.up.axis]));
  }

  int worth_of(const Vec3i& at) {
    int worth = 0;
    for (std::size_t v = 0; v < layouts_.size(); ++v) worth += 8 * pixel(v, at);
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Vec3i n = at;
        n[axis] += step;
        worth += solid_.contains(n.x(), n.y(), n.z()) && solid_(n.x(), n.y(), n.z());
      }
    return worth;
  }

  VoxelGrid solid_;
  const VoxelGrid& hull_;
  std::vector<ShadowLayout> layouts_;
  std::vector<Mask> open_;
};

}  // namespace

VoxelGrid cover_silhouettes(VoxelGrid solid, const VoxelGrid& hull, std::span<const View> views) {
  return Cover(std::move(solid), hull, views).run();
}

}  // namespace carve
