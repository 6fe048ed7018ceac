#include "carve/photo/space_carving.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "carve/photo/plane_sweep.h"

namespace carve {
namespace {

// What one photo says of a voxel: the range of its colours.
struct Sight {
  int voxel = 0, photo = 0;  // the voxel's place in its slice
  int pixels = 0, hidden = 0;
  std::array<std::uint8_t, 3> low{255, 255, 255}, high{0, 0, 0};

  void add(const Rgba& least, const Rgba& most) {
    const std::array<std::uint8_t, 3> a{least.r, least.g, least.b}, b{most.r, most.g, most.b};
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], a[k]), high[k] = std::max(high[k], b[k]);
    ++pixels;
  }
};
using Sights = std::vector<Sight>;

struct Seen {
  Vec3i voxel;
  Sight sight;
};

bool consistent(const Sights& sights, const SpaceCarvingOptions& options) {
  const std::size_t count = sights.size(),
                    odd = static_cast<std::size_t>(options.outliers * static_cast<double>(count));
  if (count < 2) return true;
  std::vector<int> low(count), high(count);
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < count; ++i) low[i] = sights[i].low[k], high[i] = -sights[i].high[k];
    std::nth_element(low.begin(), low.end() - 1 - static_cast<std::ptrdiff_t>(odd), low.end());
    std::nth_element(high.begin(), high.end() - 1 - static_cast<std::ptrdiff_t>(odd), high.end());
    if (low[count - 1 - odd] + high[count - 1 - odd] > 2 * options.threshold) return false;
  }
  return true;
}

class Carver {
 public:
  // \param open  the voxels that may go; null: all
  Carver(std::span<const Photo> photos, VoxelGrid start, const VoxelGrid* open, const SpaceCarvingOptions& options)
      : options_(options), grid_(std::move(start)), open_(open) {
    const Vec3 middle = grid_.low() + grid_.spacing() / 2 * grid_.size().cast<double>();
    for (const Photo& photo : photos) eyes_.push_back(eye_of(photo, middle, options.margin * grid_.spacing()));
  }

  SpaceCarving run(const Monitor& monitor) {
    const std::int64_t before = grid_.count();
    SpaceCarving result;
    while (result.rounds < options_.rounds && !result.converged) {
      monitor.at("space carving", static_cast<double>(result.rounds) / options_.rounds);
      const std::int64_t count = grid_.count();
      seen_.clear();
      for (int axis = 0; axis < 3; ++axis)
        for (const int sign : {+1, -1}) sweep({axis, sign});
      test_all_sights();
      ++result.rounds;
      result.converged = grid_.count() == count;
    }
    result.carved = before - grid_.count();
    result.grid = std::move(grid_);
    return result;
  }

 private:
  bool stays(const Vec3i& v, const Sights& sights) const {
    return (open_ && !(*open_)(v.x(), v.y(), v.z())) || consistent(sights, options_);
  }

  // A voxel with six neighbours inside is hidden from everywhere.
  bool on_surface(const Vec3i& v) const {
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {+1, -1}) {
        Vec3i n = v;
        n[axis] += step;
        if (!grid_.contains(n.x(), n.y(), n.z()) || !grid_(n.x(), n.y(), n.z())) return true;
      }
    return false;
  }

  std::vector<Vec3i> surface_of_slice(int axis, int at) const {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    std::vector<Vec3i> found;
    Vec3i v;
    v[axis] = at;
    for (v[b] = 0; v[b] < grid_.size()[b]; ++v[b])
      for (v[a] = 0; v[a] < grid_.size()[a]; ++v[a])
        if (grid_(v.x(), v.y(), v.z()) && on_surface(v)) found.push_back(v);
    return found;
  }

  void sweep(const Way& way) {
    for (Eye& eye : eyes_) {
      eye.taken = eye.photo->mask;
      for (std::uint8_t& pixel : eye.taken.pixels) pixel = !pixel;
    }
    const int n = grid_.size()[way.axis];
    for (int k = 0; k < n; ++k) {
      const int at = way.sign > 0 ? k : n - 1 - k;
      const double face = grid_.low()[way.axis] + grid_.spacing() * (way.sign > 0 ? at : at + 1);
      std::vector<int> active;
      for (int e = 0; e < static_cast<int>(eyes_.size()); ++e)
        if (way.sign * (face - eyes_[e].centre[way.axis]) > 0) active.push_back(e);
      if (!active.empty()) slice(way, surface_of_slice(way.axis, at), active);
    }
  }

  // All voxels of a slice are tested before any of them hides what lies behind it.
  void slice(const Way& way, const std::vector<Vec3i>& surface, const std::vector<int>& active) {
    const int eyes = static_cast<int>(active.size()), count = static_cast<int>(surface.size());
    std::vector<Sights> by_eye(eyes), sights(count);
    parallel_ranges(0, eyes, 1, [&](int first, int last) {
      for (int i = first; i < last; ++i) by_eye[i] = look(eyes_[active[i]], active[i], way, surface);
    });
    for (const Sights& all : by_eye)
      for (const Sight& s : all)
        if (s.pixels > 0 && s.pixels >= options_.visible * (s.pixels + s.hidden)) sights[s.voxel].push_back(s);
    std::vector<char> keeps(count);
    for (int i = 0; i < count; ++i) {
      keeps[i] = stays(surface[i], sights[i]);
      if (!keeps[i])
        grid_.set(surface[i].x(), surface[i].y(), surface[i].z(), false);
      else
        for (const Sight& s : sights[i]) seen_.push_back({surface[i], s});
    }
    parallel_ranges(0, eyes, 1, [&](int first, int last) {
      for (int i = first; i < last; ++i) {
        Eye& eye = eyes_[active[i]];
        for (const Hit& hit : eye.hits) {
          if (eye.owner.pixels[hit.pixel] == hit.voxel && keeps[hit.voxel]) eye.taken.pixels[hit.pixel] = 1;
        }
        for (const Hit& hit : eye.hits) eye.near.pixels[hit.pixel] = INFINITY;
      }
    });
  }

  // What one photo sees of a slice: a sight for each voxel whose pixels are not all hidden by other slices.
  Sights look(Eye& eye, int index, const Way& way, const std::vector<Vec3i>& surface) const {
    Sights found;
    eye.hits.clear();
    for (int v = 0; v < static_cast<int>(surface.size()); ++v) {
      Sight s{v, index};
      const std::size_t before = eye.hits.size();
      for_footprint(eye, way, grid_.centre(surface[v].x(), surface[v].y(), surface[v].z()), grid_.spacing(),
                    [&](int i, int j, float depth) {
                      const int pixel = j * eye.taken.width + i;
                      if (eye.taken.pixels[pixel]) return void(++s.hidden);
                      eye.hits.push_back({v, pixel});
                      if (depth < eye.near.pixels[pixel]) eye.near.pixels[pixel] = depth, eye.owner.pixels[pixel] = v;
                    });
      if (eye.hits.size() > before) found.push_back(s);
    }
    std::size_t at = 0;
    for (Sight& s : found)
      for (; at < eye.hits.size() && eye.hits[at].voxel == s.voxel; ++at) {
        const int pixel = eye.hits[at].pixel;
        if (eye.owner.pixels[pixel] == s.voxel)
          s.add(eye.low.pixels[pixel], eye.high.pixels[pixel]);
        else
          ++s.hidden;
      }
    return found;
  }

  // A photo that saw a voxel in several sweeps counts once, by the sweep that showed most of it.
  void test_all_sights() {
    const auto place = [](const Seen& s) { return std::array{s.voxel.z(), s.voxel.y(), s.voxel.x(), s.sight.photo}; };
    std::stable_sort(seen_.begin(), seen_.end(), [&](const Seen& a, const Seen& b) {
      return place(a) != place(b) ? place(a) < place(b) : a.sight.pixels > b.sight.pixels;
    });
    const auto same = [&](const Seen& a, const Seen& b) { return place(a) == place(b); };
    seen_.erase(std::unique(seen_.begin(), seen_.end(), same), seen_.end());
    Sights sights;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const Vec3i& v = seen_[i].voxel;
      sights.push_back(seen_[i].sight);
      if (i + 1 < seen_.size() && seen_[i + 1].voxel == v) continue;
      if (!stays(v, sights)) grid_.set(v.x(), v.y(), v.z(), false);
      sights.clear();
    }
  }

  const SpaceCarvingOptions& options_;
  VoxelGrid grid_;
  const VoxelGrid* open_;
  std::vector<Eye> eyes_;
  std::vector<Seen> seen_;  // in this round, by voxels that may have gone since
};

}  // namespace

SpaceCarving space_carving(std::span<const Photo> photos, VoxelGrid start, const SpaceCarvingOptions& options,
                           const Monitor& monitor) {
  check("space_carving", options);
  check_photos(photos);
  return Carver(photos, std::move(start), nullptr, options).run(monitor);
}

SpaceCarving space_carving_within(std::span<const Photo> photos, VoxelGrid start, const VoxelGrid& open,
                                  const SpaceCarvingOptions& options, const Monitor& monitor) {
  check("space_carving", options);
  check_photos(photos);
  if (open.size() != start.size()) throw std::invalid_argument("Space Carving: the grids' sizes differ");
  return Carver(photos, std::move(start), &open, options).run(monitor);
}

}  // namespace carve
