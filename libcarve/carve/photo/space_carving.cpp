#include "carve/photo/space_carving.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

// A pixel whose ray passes through a voxel of the slice.
struct Hit {
  int voxel, pixel;
};

// One photo, as the sweeps need it: the ray of pixel (i, j) is base + i * right + j * down.
struct Eye {
  const Photo* photo;
  Vec3 centre, base, right, down;
  Picture low, high;  // least and largest channels around each pixel
  Mask taken;         // pixels that this sweep has given to a voxel, or that do not show the object
  // Of the slice at hand: its pixels, and for each of them the voxel that its ray enters first.
  std::vector<Hit> hits;
  Raster<float> near;
  Raster<int> owner;
};

// Every pixel's least or largest channels among the object's pixels up to `reach` away along x and along y.
template <class Choose>
Picture spread(const Photo& photo, int reach, Rgba none, Choose&& choose) {
  const auto pass = [&](const Picture& from, int dx, int dy) {
    Picture to(from.width, from.height, none);
    parallel_ranges(0, from.height, 16, [&](int first, int last) {
      for (int y = first; y < last; ++y)
        for (int x = 0; x < from.width; ++x) {
          Rgba& p = to(x, y);
          for (int k = -reach; k <= reach; ++k)
            if (from.contains(x + k * dx, y + k * dy)) {
              const Rgba& q = from(x + k * dx, y + k * dy);
              p = {choose(p.r, q.r), choose(p.g, q.g), choose(p.b, q.b), 255};
            }
        }
    });
    return to;
  };
  Picture object = photo.picture;
  for (std::size_t i = 0; i < object.pixels.size(); ++i)
    if (!photo.mask.pixels[i]) object.pixels[i] = none;
  return pass(pass(object, 1, 0), 0, 1);
}

// \param margin  how far the surface may be off, in world units, near `middle`
Eye eye_of(const Photo& photo, const Vec3& middle, double margin) {
  const Camera& camera = photo.camera;
  const double depth = camera.in_camera(middle).z();
  const int reach = depth > 0 ? static_cast<int>(std::lround(std::min(64.0, margin * camera.focal / depth))) : 0;
  const Vec3 base = ray(camera, {0.5, 0.5});
  return {.photo = &photo,
          .centre = camera.centre(),
          .base = base,
          .right = ray(camera, {1.5, 0.5}) - base,
          .down = ray(camera, {0.5, 1.5}) - base,
          .low = spread(photo, reach, {255, 255, 255, 255}, [](auto a, auto b) { return std::min(a, b); }),
          .high = spread(photo, reach, {0, 0, 0, 255}, [](auto a, auto b) { return std::max(a, b); }),
          .taken = {},
          .hits = {},
          .near = Raster<float>(camera.width, camera.height, INFINITY),
          .owner = Raster<int>(camera.width, camera.height, -1)};
}

// The direction that a sweep goes in.
struct Way {
  int axis, sign;
  // Each ray belongs to one sweep, the one along its largest component: it crosses the slices steeply there.
  bool leads(const Vec3& d) const {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double along = sign * d[axis];
    return along > 0 && (along > std::abs(d[a]) || (along == std::abs(d[a]) && axis < a)) &&
           (along > std::abs(d[b]) || (along == std::abs(d[b]) && axis < b));
  }
  bool may_lead(const Vec3& d, double margin) const {
    const double along = sign * d[axis] + margin;
    return along > std::abs(d[(axis + 1) % 3]) && along > std::abs(d[(axis + 2) % 3]);
  }
};

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

// Where the ray from the origin enters the cube of half side h about c, as a multiple of its direction; negative if it
// passes by.
double entry(const Vec3& c, double h, const Vec3& direction) {
  double near = 0, far = INFINITY;
  for (int k = 0; k < 3; ++k) {
    const double inverse = 1 / direction[k];
    const double a = (c[k] - h) * inverse, b = (c[k] + h) * inverse;
    near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
  }
  return near < far ? near : -1;
}

// Calls visit(i, j, depth) for the pixels whose rays pass through the voxel and belong to the sweep; for the pixel of
// its centre if the voxel lies between the rays.
template <class Visit>
void for_footprint(const Eye& eye, const Way& way, const Vec3& centre, double spacing, Visit&& visit) {
  const Vec3 from_eye = centre - eye.centre;
  if (!way.may_lead(from_eye, 2 * spacing)) return;
  const Camera& camera = eye.photo->camera;
  const Vec3 p = camera.rotation * from_eye;
  if (p.z() <= spacing) return;
  const double x = p.x() / p.z(), y = p.y() / p.z();
  double wide = 0, high = 0;
  for (int k = 0; k < 3; ++k) {
    wide += std::abs(camera.rotation(0, k) - x * camera.rotation(2, k));
    high += std::abs(camera.rotation(1, k) - y * camera.rotation(2, k));
  }
  // A little more than the first-order extent: the cube's near corners look larger.
  const double half = camera.focal / p.z() * spacing / 2 * (1 + spacing / p.z());
  const double u = camera.focal * x + camera.principal.x(), v = camera.focal * y + camera.principal.y();
  const auto first = [](double at, int n) { return static_cast<int>(std::ceil(std::clamp(at - 0.5, 0.0, 1.0 * n))); };
  const int i1 = first(u + half * wide + 1e-9, camera.width), j1 = first(v + half * high + 1e-9, camera.height);
  bool any = false;
  for (int j = first(v - half * high, camera.height); j < j1; ++j)
    for (int i = first(u - half * wide, camera.width); i < i1; ++i) {
      const Vec3 direction = eye.base + i * eye.right + j * eye.down;
      const double depth = entry(from_eye, spacing / 2, direction);
      if (depth < 0) continue;
      any = true;
      if (way.leads(direction)) visit(i, j, static_cast<float>(depth));
    }
  if (any || !(u >= 0 && v >= 0 && u < camera.width && v < camera.height)) return;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  if (way.leads(eye.base + i * eye.right + j * eye.down)) visit(i, j, static_cast<float>(p.z()));
}

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
  Carver(std::span<const Photo> photos, VoxelGrid start, const SpaceCarvingOptions& options)
      : options_(options), grid_(std::move(start)) {
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
      keeps[i] = consistent(sights[i], options_);
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
      if (!consistent(sights, options_)) grid_.set(v.x(), v.y(), v.z(), false);
      sights.clear();
    }
  }

  const SpaceCarvingOptions& options_;
  VoxelGrid grid_;
  std::vector<Eye> eyes_;
  std::vector<Seen> seen_;  // in this round, by voxels that may have gone since
};

}  // namespace

SpaceCarving space_carving(std::span<const Photo> photos, VoxelGrid start, const SpaceCarvingOptions& options,
                           const Monitor& monitor) {
  check("space_carving", options);
  check_photos(photos);
  return Carver(photos, std::move(start), options).run(monitor);
}

}  // namespace carve
