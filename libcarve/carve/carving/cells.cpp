#include "carve/carving/cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
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

class Partition {
 public:
  Partition(const VoxelGrid& hull, std::span<const RegionMap> views) : hull_(hull), views_(views) {
    if (views.size() > 6) throw std::invalid_argument("views must be at most 6, got " + std::to_string(views.size()));
    for (const RegionMap& view : views) layouts_.emplace_back(hull.size(), view.view);
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
  Tuple tuple(int x, int y, int z) const {
    Tuple t;
    t.fill(-1);
    const int at[3] = {x, y, z};
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const ShadowLayout& l = layouts_[v];
      t[v] = views_[v].region(l.right_index(at[l.frame.right.axis]), l.up_index(at[l.frame.up.axis]));
    }
    return t;
  }

  void cut_row(int y, int z) {
    const std::uint64_t* words = hull_.row(y, z);
    for (int w = 0; w < hull_.words_per_row(); ++w)
      for (std::uint64_t bits = words[w]; bits; bits &= bits - 1) {
        const int x = w * 64 + std::countr_zero(bits);
        const Tuple t = tuple(x, y, z);
        if (!cells_.runs.empty()) {
          CellRun& last = cells_.runs.back();
          if (last.z == z && last.y == y && last.x1 == x && tuples_.back() == t) {
            ++last.x1;
            continue;
          }
        }
        cells_.runs.push_back({y, z, x, x + 1, -1});
        tuples_.push_back(t);
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
  std::span<const RegionMap> views_;
  std::vector<ShadowLayout> layouts_;
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
  const auto visit_row = [&](int y, int z, int depth) {
    const std::size_t r = static_cast<std::size_t>(z) * size.y() + y;
    const int at[3] = {0, y, z};
    if (axis == 0) {
      const int i = layout.right_index(at[layout.frame.right.axis]), j = layout.up_index(at[layout.frame.up.axis]);
      for (int k = 0; k < begin[r + 1] - begin[r]; ++k) {
        const CellRun& run = cells.runs[from_high ? begin[r + 1] - 1 - k : begin[r] + k];
        meet(i, j, run.cell, from_high ? size.x() - run.x1 : run.x0);
      }
      return;
    }
    for (int k = begin[r]; k < begin[r + 1]; ++k)
      for (int x = cells.runs[k].x0; x < cells.runs[k].x1; ++x) {
        const int here[3] = {x, y, z};
        meet(layout.right_index(here[layout.frame.right.axis]), layout.up_index(here[layout.frame.up.axis]),
             cells.runs[k].cell, depth);
      }
  };
  if (axis == 1) {
    for (int d = 0; d < size.y(); ++d)
      for (int z = 0; z < size.z(); ++z) visit_row(from_high ? size.y() - 1 - d : d, z, d);
  } else {
    for (int d = 0; d < size.z(); ++d)
      for (int y = 0; y < size.y(); ++y) visit_row(y, from_high ? size.z() - 1 - d : d, d);
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

std::vector<int> counterparts(const Cells& own, const VoxelGrid& own_grid, const Cells& other,
                              const VoxelGrid& other_grid) {
  const Vec3i& size = other.size;
  Raster<int> cell_at(size.x(), size.y() * size.z(), -1);
  for (const CellRun& run : other.runs)
    std::fill_n(&cell_at(run.x0, run.z * size.y() + run.y), run.x1 - run.x0, run.cell);
  const auto index = [&](int axis, int i) {
    const double at = own_grid.low()[axis] + (i + 0.5) * own_grid.spacing() - other_grid.low()[axis];
    return std::clamp(static_cast<int>(std::floor(at / other_grid.spacing())), 0, size[axis] - 1);
  };
  std::vector<int> column(own.size.x());
  for (int x = 0; x < own.size.x(); ++x) column[x] = index(0, x);

  std::vector<std::map<int, std::int64_t>> shared(own.count);
  for (const CellRun& run : own.runs) {
    const int row = index(2, run.z) * size.y() + index(1, run.y);
    for (int x = run.x0; x < run.x1;) {
      const int cell = cell_at(column[x], row), first = x;
      while (x < run.x1 && cell_at(column[x], row) == cell) ++x;
      if (cell >= 0) shared[run.cell][cell] += x - first;
    }
  }
  std::vector<int> out(own.count, -1);
  for (int c = 0; c < own.count; ++c)
    if (!shared[c].empty())
      out[c] = std::ranges::max_element(shared[c], {}, [](const auto& part) { return part.second; })->first;
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
