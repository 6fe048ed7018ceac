#include "carve/carving/cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "carve/grid/shadow.h"

namespace carve {
namespace {

using Tuple = std::array<int, 6>;

/// First run of each (y, z) row, in the order z * ny + y, and the end.
std::vector<int> row_offsets(const std::vector<CellRun>& runs, const Vec3i& size) {
  std::vector<int> begin(static_cast<std::size_t>(size.y()) * size.z() + 1, 0);
  for (const CellRun& run : runs) ++begin[static_cast<std::size_t>(run.z) * size.y() + run.y + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  return begin;
}

/// Calls visit(i, j) for all runs i of row a and j of row b that overlap in x.
template <class Visit>
void overlaps(const std::vector<CellRun>& runs, std::pair<int, int> a, std::pair<int, int> b, Visit&& visit) {
  for (int i = a.first, j = b.first; i < a.second && j < b.second;) {
    if (std::max(runs[i].x0, runs[j].x0) < std::min(runs[i].x1, runs[j].x1)) visit(i, j);
    if (runs[i].x1 < runs[j].x1)
      ++i;
    else
      ++j;
  }
}

/// A view's regions, by the rows of voxels that they lie before.
class RegionRows {
 public:
  RegionRows(const RegionMap& map, const Vec3i& size, int words_per_row) : words_(words_per_row) {
    const ShadowLayout layout(size, map.view);
    Vec3i picture = size;
    picture[layout.frame.toward.axis] = 1;
    step_ = Vec3i(picture.x() > 1, picture.y() > 1, picture.z() > 1 ? picture.y() : 0);
    region_ = Raster<int>(picture.x(), picture.y() * picture.z());
    changes_.assign(static_cast<std::size_t>(region_.height) * words_, 0);
    for (int row = 0; row < region_.height; ++row)
      for (int x = 0; x < region_.width; ++x) {
        const int at[3] = {x, row % picture.y(), row / picture.y()};
        region_(x, row) =
            map.region(layout.right_index(at[layout.frame.right.axis]), layout.up_index(at[layout.frame.up.axis]));
        if (x > 0 && region_(x, row) != region_(x - 1, row))
          changes_[static_cast<std::size_t>(row) * words_ + x / 64] |= std::uint64_t{1} << x % 64;
      }
  }
  int operator()(int x, int y, int z) const { return region_(step_.x() * x, row(y, z)); }
  /// Of a row of voxels, the bits where the region is another one than at x - 1.
  const std::uint64_t* changes(int y, int z) const {
    return changes_.data() + static_cast<std::size_t>(row(y, z)) * words_;
  }

 private:
  int row(int y, int z) const { return step_.y() * y + step_.z() * z; }

  int words_;
  Vec3i step_;  // in the picture, for a step along each axis
  Raster<int> region_;
  std::vector<std::uint64_t> changes_;
};

class Partition {
 public:
  Partition(const VoxelGrid& hull, std::span<const RegionMap> views) : hull_(hull) {
    if (views.size() > 6) throw std::invalid_argument("views must be at most 6, got " + std::to_string(views.size()));
    for (const RegionMap& view : views) views_.emplace_back(view, hull.size(), hull.words_per_row());
  }

  Cells run() {
    cells_.size = hull_.size();
    for (int z = 0; z < hull_.size().z(); ++z)
      for (int y = 0; y < hull_.size().y(); ++y) cut_row(y, z);
    parent_.resize(cells_.runs.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    connect();
    number();
    return std::move(cells_);
  }

 private:
  /// A run goes on as long as voxels follow each other before the same regions.
  void cut_row(int y, int z) {
    const std::uint64_t* words = hull_.row(y, z);
    std::uint64_t before = 0;  // whether the voxel before the word is inside
    for (int w = 0; w < hull_.words_per_row(); ++w) {
      const std::uint64_t inside = words[w];
      std::uint64_t goes_on = inside & (inside << 1 | before);
      for (const RegionRows& view : views_) goes_on &= ~view.changes(y, z)[w];
      before = inside >> 63;
      if (goes_on & 1) cells_.runs.back().x1 += std::countr_one(goes_on);
      for (std::uint64_t begins = inside & ~goes_on; begins; begins &= begins - 1) {
        const int bit = std::countr_zero(begins), x = w * 64 + bit;
        cells_.runs.push_back({y, z, x, x + 1 + std::countr_one(goes_on >> bit >> 1), -1});
        Tuple& tuple = tuples_.emplace_back();
        tuple.fill(-1);
        for (std::size_t v = 0; v < views_.size(); ++v) tuple[v] = views_[v](x, y, z);
      }
    }
  }

  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void connect() {
    const Vec3i size = hull_.size();
    const std::vector<int> begin = row_offsets(cells_.runs, size);
    const auto row = [&](int y, int z) {
      const std::size_t r = static_cast<std::size_t>(z) * size.y() + y;
      return std::pair(begin[r], begin[r + 1]);
    };
    const auto join = [&](int i, int j) {
      if (tuples_[i] != tuples_[j]) return;
      const int a = find(i), b = find(j);
      parent_[std::max(a, b)] = std::min(a, b);
    };
    for (int z = 0; z < size.z(); ++z)
      for (int y = 0; y < size.y(); ++y) {
        if (y > 0) overlaps(cells_.runs, row(y, z), row(y - 1, z), join);
        if (z > 0) overlaps(cells_.runs, row(y, z), row(y, z - 1), join);
      }
  }

  void number() {
    std::vector<int> name(parent_.size(), -1);
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      int& cell = name[find(static_cast<int>(i))];
      if (cell < 0) {
        cell = cells_.count++;
        cells_.volume.push_back(0);
        cells_.regions.push_back(tuples_[i]);
      }
      cells_.runs[i].cell = cell;
      cells_.volume[cell] += cells_.runs[i].x1 - cells_.runs[i].x0;
    }
  }

  const VoxelGrid& hull_;
  std::vector<RegionRows> views_;
  Cells cells_;
  std::vector<Tuple> tuples_;
  std::vector<int> parent_;
};

Rays trace(const Cells& cells, View view) {
  const Vec3i& size = cells.size;
  const ShadowLayout layout(size, view);
  struct Met {
    RayEntry entry;
    int before;  // in met; -1: the first
  };
  std::vector<Met> met;
  std::vector<int> last(static_cast<std::size_t>(layout.width) * layout.height, -1);  // per pixel, in met
  const auto meet = [&](int i, int j, int cell, int depth) {
    int& newest = last[static_cast<std::size_t>(j) * layout.width + i];
    for (int k = newest; k >= 0; k = met[k].before)
      if (met[k].entry.cell == cell) return;
    met.push_back({{cell, depth}, newest});
    newest = static_cast<int>(met.size()) - 1;
  };
  const std::vector<int> begin = row_offsets(cells.runs, size);
  const int axis = layout.frame.toward.axis;
  const bool from_high = layout.frame.toward.sign > 0;
  const auto row = [&](int y, int z) {
    const std::size_t r = static_cast<std::size_t>(z) * size.y() + y;
    return std::span(cells.runs).subspan(begin[r], begin[r + 1] - begin[r]);
  };
  const auto across = [&](int y, int z) {
    const auto runs = row(y, z);
    const int at[3] = {0, y, z};
    const int i = layout.right_index(at[layout.frame.right.axis]), j = layout.up_index(at[layout.frame.up.axis]);
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const CellRun& run = from_high ? runs[runs.size() - 1 - k] : runs[k];
      meet(i, j, run.cell, from_high ? size.x() - run.x1 : run.x0);
    }
  };
  // A row of voxels that are met one after the row before them: where both are of one cell, that was met already.
  const auto along = [&](int y, int z, std::span<const CellRun> before, int depth) {
    std::size_t k = 0;
    for (const CellRun& run : row(y, z))
      for (int x = run.x0; x < run.x1; ++x) {
        while (k < before.size() && before[k].x1 <= x) ++k;
        if (k < before.size() && before[k].x0 <= x && before[k].cell == run.cell) {
          x = before[k].x1 - 1;
          continue;
        }
        const int at[3] = {x, y, z};
        meet(layout.right_index(at[layout.frame.right.axis]), layout.up_index(at[layout.frame.up.axis]), run.cell,
             depth);
      }
  };
  if (axis == 0) {
    for (int z = 0; z < size.z(); ++z)
      for (int y = 0; y < size.y(); ++y) across(y, z);
  } else {
    const int other = 3 - axis, step = from_high ? 1 : -1;  // to the row before
    for (int d = 0; d < size[axis]; ++d)
      for (int n = 0; n < size[other]; ++n) {
        int at[3];
        at[axis] = from_high ? size[axis] - 1 - d : d;
        at[other] = n;
        int before[3] = {0, at[1], at[2]};
        before[axis] += step;
        along(at[1], at[2], d > 0 ? row(before[1], before[2]) : std::span<const CellRun>{}, d);
      }
  }
  Rays rays{layout.width, layout.height, {0}, {}};
  rays.begin.reserve(last.size() + 1);
  rays.entries.reserve(met.size());
  for (const int newest : last) {
    for (int k = newest; k >= 0; k = met[k].before) rays.entries.push_back(met[k].entry);
    std::reverse(rays.entries.begin() + rays.begin.back(), rays.entries.end());
    rays.begin.push_back(static_cast<int>(rays.entries.size()));
  }
  return rays;
}

}  // namespace

Cells partition(const VoxelGrid& hull, std::span<const RegionMap> views) { return Partition(hull, views).run(); }

std::vector<Rays> trace(const Cells& cells, std::span<const RegionMap> views) {
  std::vector<Rays> rays;
  for (const RegionMap& view : views) rays.push_back(trace(cells, view.view));
  return rays;
}

std::vector<SharedSpace> shared_space(const Cells& own, const VoxelGrid& own_grid, const Cells& other,
                                      const VoxelGrid& other_grid) {
  // Along each axis, where the centres of own voxels lie in the other grid; along x, also the first in each of its
  // voxels or beyond.
  std::array<std::vector<int>, 3> places;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < own.size[axis]; ++i) {
      const double at = own_grid.low()[axis] + (i + 0.5) * own_grid.spacing() - other_grid.low()[axis];
      places[axis].push_back(
          std::clamp(static_cast<int>(std::floor(at / other_grid.spacing())), 0, other.size[axis] - 1));
    }
  std::vector<int> first_in;
  for (int x = 0; x <= other.size.x(); ++x)
    first_in.push_back(static_cast<int>(std::ranges::lower_bound(places[0], x) - places[0].begin()));
  const std::vector<int> begin = row_offsets(other.runs, other.size);

  struct Share {
    int other = -1;
    std::int64_t voxels = 0;
  };
  std::vector<Share> recent(own.count);  // most runs lie in the same cell as the one before them
  std::unordered_map<std::uint64_t, std::int64_t> shared;
  const auto add = [&](int cell) {
    if (const Share& share = recent[cell]; share.other >= 0)
      shared[static_cast<std::uint64_t>(cell) << 32 | static_cast<std::uint32_t>(share.other)] += share.voxels;
  };
  for (std::size_t i = 0, j = 0; i < own.runs.size(); ++i) {
    const CellRun& run = own.runs[i];
    const std::size_t row = static_cast<std::size_t>(places[2][run.z]) * other.size.y() + places[1][run.y];
    const std::size_t first = begin[row], last = begin[row + 1];
    if (i == 0 || run.y != own.runs[i - 1].y || run.z != own.runs[i - 1].z) j = first;
    while (j < last && first_in[other.runs[j].x1] <= run.x0) ++j;
    for (std::size_t k = j; k < last && first_in[other.runs[k].x0] < run.x1; ++k) {
      const CellRun& there = other.runs[k];
      const int voxels = std::min(run.x1, first_in[there.x1]) - std::max(run.x0, first_in[there.x0]);
      if (voxels <= 0) continue;
      if (recent[run.cell].other != there.cell) {
        add(run.cell);
        recent[run.cell] = {there.cell, 0};
      }
      recent[run.cell].voxels += voxels;
    }
  }
  for (int c = 0; c < own.count; ++c) add(c);

  std::vector<SharedSpace> out;
  out.reserve(shared.size());
  for (const auto& [pair, voxels] : shared)
    out.push_back({static_cast<int>(pair >> 32), static_cast<int>(pair & 0xffffffff), voxels});
  std::ranges::sort(out, [](const SharedSpace& p, const SharedSpace& q) {
    return std::pair(p.own, p.other) < std::pair(q.own, q.other);
  });
  return out;
}

std::vector<std::uint8_t> mostly(std::span<const SharedSpace> shared, int own_count,
                                 std::span<const std::uint8_t> marked) {
  std::vector<std::int64_t> more(own_count, 0);  // voxels in marked cells over those in others
  for (const SharedSpace& share : shared) more[share.own] += marked[share.other] ? share.voxels : -share.voxels;
  std::vector<std::uint8_t> out;
  out.reserve(own_count);
  for (const std::int64_t voxels : more) out.push_back(voxels > 0);
  return out;
}

std::vector<CellContact> contacts(const Cells& cells) {
  const Vec3i& size = cells.size;
  std::unordered_map<std::uint64_t, std::int64_t> faces;
  std::vector<std::int64_t> outside(cells.count, 0);
  for (int c = 0; c < cells.count; ++c) outside[c] = 6 * cells.volume[c];
  const auto touch = [&](int a, int b, std::int64_t n) {
    outside[a] -= n;
    outside[b] -= n;
    if (a != b)
      faces[static_cast<std::uint64_t>(std::max(a, b)) << 32 | static_cast<std::uint32_t>(std::min(a, b))] += n;
  };
  const auto& runs = cells.runs;
  const std::vector<int> begin = row_offsets(runs, size);
  const auto row = [&](int y, int z) {
    const std::size_t r = static_cast<std::size_t>(z) * size.y() + y;
    return std::pair(begin[r], begin[r + 1]);
  };
  const auto across = [&](int i, int j) {
    touch(runs[i].cell, runs[j].cell, std::min(runs[i].x1, runs[j].x1) - std::max(runs[i].x0, runs[j].x0));
  };
  for (const CellRun& run : runs) touch(run.cell, run.cell, run.x1 - run.x0 - 1);
  for (std::size_t k = 1; k < runs.size(); ++k)
    if (runs[k - 1].z == runs[k].z && runs[k - 1].y == runs[k].y && runs[k - 1].x1 == runs[k].x0)
      touch(runs[k - 1].cell, runs[k].cell, 1);
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y) {
      if (y > 0) overlaps(runs, row(y, z), row(y - 1, z), across);
      if (z > 0) overlaps(runs, row(y, z), row(y, z - 1), across);
    }
  std::vector<CellContact> out;
  out.reserve(faces.size());
  for (const auto& [pair, n] : faces)
    out.push_back({static_cast<int>(pair >> 32), static_cast<int>(pair & 0xffffffff), n});
  for (int c = 0; c < cells.count; ++c)
    if (outside[c] > 0) out.push_back({c, -1, outside[c]});
  std::ranges::sort(
      out, [](const CellContact& p, const CellContact& q) { return std::pair(p.a, p.b) < std::pair(q.a, q.b); });
  return out;
}

VoxelGrid assemble(const VoxelGrid& hull, const Cells& cells, std::span<const std::uint8_t> keep) {
  VoxelGrid out(hull.size(), hull.low(), hull.spacing());
  for (const CellRun& run : cells.runs)
    if (keep[run.cell])
      for (int x = run.x0; x < run.x1; ++x) out.set(x, run.y, run.z, true);
  return out;
}

}  // namespace carve
