#include "carve/photo/patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "carve/photo/patch_photometry.h"

namespace carve {
namespace {

constexpr int kTries = 2;                // of a cell in a round
constexpr double kNear = 2;              // cells that a neighbour may lie off the other's plane
constexpr double kFewNeighbours = 0.25;  // of the patches around

struct Cell {
  int view, x, y;
};

// Patches, and by the photos that agree on them the cells that they fill.
class Organisation {
 public:
  explicit Organisation(const Photometry& photometry) : photometry_(photometry) {
    for (const PatchView& view : photometry.views())
      filled_.emplace_back(cells(view.camera.width), cells(view.camera.height));
  }

  const std::vector<Patch>& patches() const { return patches_; }

  void grow(int rounds, const Monitor& monitor) {
    for (int round = 0; round < rounds; ++round) {
      monitor.at("patches", (1 + round) / (1.0 + rounds));
      expand(monitor);
      keep(visible_consistently());
      keep(seen_by_enough());
      keep(among_neighbours());
    }
  }

  // Adds a patch if it fills an empty cell.
  bool add(Patch patch) {
    bool fills = false;
    for (const int v : patch.views) fills |= at(cell_of(v, patch.centre)).empty();
    if (!fills) return false;
    for (const int v : patch.views) at(cell_of(v, patch.centre)).push_back(static_cast<int>(patches_.size()));
    patches_.push_back(std::move(patch));
    return true;
  }

 private:
  struct Candidate {
    Cell cell;
    int parent;
  };

  int cells(int pixels) const { return (pixels + photometry_.options().csize - 1) / photometry_.options().csize; }
  bool contains(const Cell& c) const { return filled_[c.view].contains(c.x, c.y); }
  std::vector<int>& at(const Cell& c) { return filled_[c.view](c.x, c.y); }
  const std::vector<int>& at(const Cell& c) const { return filled_[c.view](c.x, c.y); }
  const Camera& camera(int view) const { return photometry_.views()[view].camera; }

  Cell cell_of(int view, const Vec3& point) const {
    const Vec2 p = project(camera(view), point) / photometry_.options().csize;
    return {view, static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y()))};
  }

  // Generation by generation: the patches of one spread at once, and what they made spreads in the next.
  void expand(const Monitor& monitor) {
    std::vector<Raster<std::uint8_t>> tries;
    for (const auto& raster : filled_) tries.emplace_back(raster.width, raster.height);
    std::vector<int> front(patches_.size());
    for (std::size_t i = 0; i < front.size(); ++i) front[i] = static_cast<int>(i);
    while (!front.empty()) {
      monitor.at("patches", 0.5);
      std::vector<int> next;
      const std::vector<Candidate> candidates = candidates_around(front, tries, next);
      std::vector<std::optional<Patch>> made(candidates.size());
      parallel_ranges(0, static_cast<int>(made.size()), 16, [&](int first, int last) {
        for (int i = first; i < last; ++i) made[i] = spread(candidates[i]);
      });
      for (auto& patch : made)
        if (patch && add(std::move(*patch))) next.push_back(static_cast<int>(patches_.size()) - 1);
      front = std::move(next);
    }
  }

  // The empty cells beside those of the patches, each once; patches that another was before come again.
  std::vector<Candidate> candidates_around(const std::vector<int>& front, std::vector<Raster<std::uint8_t>>& tries,
                                           std::vector<int>& again) const {
    std::vector<Candidate> found;
    std::vector<Raster<std::uint8_t>> taken;
    for (const auto& raster : filled_) taken.emplace_back(raster.width, raster.height);
    for (const int p : front) {
      bool late = false;
      for (const int v : patches_[p].views) {
        const Cell own = cell_of(v, patches_[p].centre);
        for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
          const Cell cell{v, own.x + dx, own.y + dy};
          if (!contains(cell) || !at(cell).empty() || tries[v](cell.x, cell.y) >= kTries) continue;
          if (taken[v](cell.x, cell.y)) {
            late = true;
            continue;
          }
          taken[v](cell.x, cell.y) = 1, ++tries[v](cell.x, cell.y);
          found.push_back({cell, p});
        }
      }
      if (late) again.push_back(p);
    }
    return found;
  }

  // The parent's plane under a cell's middle, refined against the photo of the parent's that faces it most.
  std::optional<Patch> spread(const Candidate& candidate) const {
    const Patch& parent = patches_[candidate.parent];
    const Camera& c = camera(candidate.cell.view);
    const double size = photometry_.options().csize;
    const Vec3 eye = c.centre(),
               towards = ray(c, Vec2((candidate.cell.x + 0.5) * size, (candidate.cell.y + 0.5) * size));
    const double steep = parent.normal.dot(towards);
    if (steep >= 0) return {};
    Patch patch{eye + parent.normal.dot(parent.centre - eye) / steep * towards, parent.normal};
    if (!photometry_.in_box(patch.centre)) return {};
    const auto facing = [&](int v) { return parent.normal.dot((camera(v).centre() - patch.centre).normalized()); };
    const int reference = *std::max_element(parent.views.begin(), parent.views.end(),
                                            [&](int a, int b) { return facing(a) < facing(b); });
    return photometry_.refined(std::move(patch), reference);
  }

  bool neighbours(const Patch& a, const Patch& b, double tolerance) const {
    const Vec3 d = a.centre - b.centre;
    const double size = photometry_.cell_size(a.views.front(), (a.centre + b.centre) / 2);
    return std::abs(d.dot(a.normal)) + std::abs(d.dot(b.normal)) < tolerance * size;
  }

  template <class Test>
  std::vector<char> test(Test&& passes) const {
    std::vector<char> keeps(patches_.size());
    parallel_ranges(0, static_cast<int>(patches_.size()), 64, [&](int first, int last) {
      for (int i = first; i < last; ++i) keeps[i] = passes(i);
    });
    return keeps;
  }

  // Where patches of one cell are not of one surface, those with the better evidence stay.
  std::vector<char> visible_consistently() const {
    return test([&](int i) {
      const Patch& p = patches_[i];
      std::vector<int> rivals;
      for (const int v : p.views)
        for (const int q : at(cell_of(v, p.centre)))
          if (q != i && !neighbours(p, patches_[q], kNear)) rivals.push_back(q);
      std::sort(rivals.begin(), rivals.end());
      rivals.erase(std::unique(rivals.begin(), rivals.end()), rivals.end());
      double against = 0;
      for (const int q : rivals) against += patches_[q].score;
      return static_cast<double>(p.views.size()) * p.score >= against;
    });
  }

  // Enough of the photos that agree on it see it before all other patches of its cell.
  std::vector<char> seen_by_enough() const {
    return test([&](int i) {
      const Patch& p = patches_[i];
      int sees = 0;
      for (const int v : p.views) {
        const double depth = camera(v).in_camera(p.centre).z();
        bool hidden = false;
        for (const int q : at(cell_of(v, p.centre)))
          hidden |= camera(v).in_camera(patches_[q].centre).z() < depth && !neighbours(p, patches_[q], kNear);
        sees += !hidden;
      }
      return sees >= photometry_.options().min_image_num;
    });
  }

  // Enough of the patches in the cells around it continue it.
  std::vector<char> among_neighbours() const {
    return test([&](int i) {
      const Patch& p = patches_[i];
      int all = 0, near = 0;
      for (const int v : p.views) {
        const Cell own = cell_of(v, p.centre);
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            if (const Cell cell{v, own.x + dx, own.y + dy}; contains(cell))
              for (const int q : at(cell))
                if (q != i) ++all, near += neighbours(p, patches_[q], 2 * kNear);
      }
      return near > 0 && near >= kFewNeighbours * all;
    });
  }

  void keep(const std::vector<char>& keeps) {
    std::vector<Patch> old = std::move(patches_);
    patches_.clear();
    for (auto& raster : filled_)
      for (auto& cell : raster.pixels) cell.clear();
    for (std::size_t i = 0; i < old.size(); ++i) {
      if (!keeps[i]) continue;
      for (const int v : old[i].views) at(cell_of(v, old[i].centre)).push_back(static_cast<int>(patches_.size()));
      patches_.push_back(std::move(old[i]));
    }
  }

  const Photometry& photometry_;
  std::vector<Patch> patches_;
  std::vector<Raster<std::vector<int>>> filled_;
};

void check_input(std::span<const Photo> photos, const PatchOptions& options) {
  check("patches", options);
  check_photos(photos);
  if (options.wsize % 2 == 0)
    throw std::invalid_argument("patches.wsize must be odd, got " + std::to_string(options.wsize));
  for (const Photo& photo : photos)
    if (std::min(photo.camera.width, photo.camera.height) >> options.level <= options.wsize)
      throw std::invalid_argument("patches.level leaves of a photo of " + std::to_string(photo.camera.width) + " x " +
                                  std::to_string(photo.camera.height) + " less than a window of patches.wsize " +
                                  std::to_string(options.wsize));
}

}  // namespace

OrientedPoints patches(std::span<const Photo> photos, const Vec3& low, const Vec3& high, const PatchOptions& options,
                       const Monitor& monitor) {
  check_input(photos, options);
  monitor.at("patches", 0);
  const Photometry photometry(photos, low, high, options);
  Organisation organisation(photometry);
  for (Patch& seed : match_features(photometry)) organisation.add(std::move(seed));
  organisation.grow(options.rounds, monitor);
  OrientedPoints points;
  for (const Patch& patch : organisation.patches()) {
    points.positions.push_back(patch.centre);
    points.normals.push_back(patch.normal);
  }
  return points;
}

std::vector<SeenPoint> matched_features(std::span<const Photo> photos, const Vec3& low, const Vec3& high,
                                        const PatchOptions& options) {
  check_input(photos, options);
  std::vector<SeenPoint> points;
  for (Patch& seed : match_features(Photometry(photos, low, high, options)))
    points.push_back({seed.centre, std::move(seed.views)});
  return points;
}

}  // namespace carve
