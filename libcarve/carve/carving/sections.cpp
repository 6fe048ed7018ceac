#include "carve/carving/sections.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"
#include "carve/image/outline.h"

namespace carve {
namespace {

/// Rows of bits along u for one slice: of the grid itself, or of its transposition where u is y.
class SliceRows {
 public:
  SliceRows(const VoxelGrid& solid, int axis) : solid_(solid), axis_(axis) {
    if (axis != 0) return;
    words_ = (solid.size().y() + 63) / 64;
    bits_.resize(static_cast<std::size_t>(solid.size().x()) * solid.size().z() * words_);
    parallel_ranges(0, solid.size().z(), 4, [&](int begin, int end) {
      for (int z = begin; z < end; ++z) transpose_layer(z);
    });
  }
  const std::uint64_t* row(int slice, int v) const {
    if (axis_ == 0) return &bits_[(static_cast<std::size_t>(v) * solid_.size().x() + slice) * words_];
    return axis_ == 1 ? solid_.row(slice, v) : solid_.row(v, slice);
  }
  int words() const { return axis_ == 0 ? words_ : solid_.words_per_row(); }

 private:
  void transpose_layer(int z) {
    for (int y = 0; y < solid_.size().y(); ++y)
      for (int w = 0; w < solid_.words_per_row(); ++w)
        for (std::uint64_t rest = solid_.row(y, z)[w]; rest; rest &= rest - 1) {
          const int x = 64 * w + std::countr_zero(rest);
          bits_[(static_cast<std::size_t>(z) * solid_.size().x() + x) * words_ + (y >> 6)] |= std::uint64_t{1}
                                                                                              << (y & 63);
        }
  }
  const VoxelGrid& solid_;
  int axis_, words_ = 0;
  std::vector<std::uint64_t> bits_;
};

/// Calls found(begin, end) for every run of set bits.
template <class Found>
void each_run(const std::uint64_t* row, int words, Found&& found) {
  int begin = -1;
  for (int w = 0; w < words; ++w) {
    std::uint64_t changes = row[w] ^ (row[w] << 1 | (begin >= 0 ? 1 : 0));
    for (; changes; changes &= changes - 1) {
      const int at = 64 * w + std::countr_zero(changes);
      if (begin < 0) {
        begin = at;
      } else {
        found(begin, at);
        begin = -1;
      }
    }
  }
  if (begin >= 0) found(begin, 64 * words);
}

struct Slice {
  std::vector<SectionRun> runs;
  std::vector<int> first_run;
  std::vector<Section> sections;
};

Slice label(const SliceRows& rows, int slice, int height) {
  Slice out;
  std::vector<int> parent;
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  int before = 0;
  for (int v = 0; v < height; ++v) {
    const int begin = static_cast<int>(out.runs.size());
    out.first_run.push_back(begin);
    each_run(rows.row(slice, v), rows.words(), [&](int u0, int u1) {
      const int run = static_cast<int>(out.runs.size());
      out.runs.push_back({u0, u1, run});
      parent.push_back(run);
      while (before < begin && out.runs[before].u1 <= u0) ++before;
      for (int other = before; other < begin && out.runs[other].u0 < u1; ++other) {
        const int a = root(other), b = root(run);
        parent[std::max(a, b)] = std::min(a, b);
      }
    });
    before = begin;
  }
  std::vector<int> name(parent.size(), -1);
  for (int v = 0, r = 0; v < height; ++v)
    for (const int end = v + 1 < height ? out.first_run[v + 1] : static_cast<int>(out.runs.size()); r < end; ++r) {
      SectionRun& run = out.runs[r];
      int& section = name[root(r)];
      if (section < 0) {
        section = static_cast<int>(out.sections.size());
        out.sections.push_back({.slice = slice, .box = {run.u0, run.u1, v, v + 1}});
      }
      run.section = section;
      auto& [u0, u1, v0, v1] = out.sections[section].box;
      u0 = std::min(u0, run.u0), u1 = std::max(u1, run.u1), v1 = v + 1;
      out.sections[section].area += run.u1 - run.u0;
    }
  return out;
}

/// Puts a box's end where a drawing that shows it has its outline.
class Ends {
 public:
  Ends(const VoxelGrid& grid, const ViewSet& views) : grid_(grid) {
    for (const AlignedView& view : views.views) views_.push_back({&view, Outline(view.drawing.coverage)});
  }

  /// \param inside  last voxel inside along `along`; \param step  +1 or -1: where outside is
  float end(int along, int across, int across_index, int inside, int step) const {
    double nearest = 1;
    for (const auto& [view, outline] : views_) {
      const Frame axes = frame(view->view);
      const bool right = axes.right.axis == along;
      if ((right ? axes.up.axis : axes.right.axis) != across || (!right && axes.up.axis != along)) continue;
      const double line = pixel(*view, !right, across, across_index);
      const double from = pixel(*view, right, along, inside), to = pixel(*view, right, along, inside + step);
      const double left = right ? outline.leave_along_row(from, to, line) : outline.leave_along_column(from, to, line);
      const double share = (left - from) / (to - from);
      if (share > 0) nearest = std::min(nearest, share);
    }
    return static_cast<float>(inside + 0.5 + step * (nearest < 1 ? nearest : 0.5));
  }

 private:
  double pixel(const AlignedView& view, bool right, int axis, int index) const {
    const double place = grid_.low()[axis] + grid_.spacing() * (index + 0.5);
    return right ? view.column(place) : view.row(place);
  }
  const VoxelGrid& grid_;
  std::vector<std::pair<const AlignedView*, Outline>> views_;
};

void place_ends(Section& s, const Ends& ends, int axis) {
  const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  s.ends = {ends.end(u, axis, s.slice, s.box[0], -1), ends.end(u, axis, s.slice, s.box[1] - 1, 1),
            ends.end(v, axis, s.slice, s.box[2], -1), ends.end(v, axis, s.slice, s.box[3] - 1, 1)};
}

/// Voxels that sections of slice k share with those of the next one: [a * sections of k + 1 + b].
std::vector<int> overlaps(const Sections& all, int k) {
  const int a0 = all.first_section[k], b0 = all.first_section[k + 1], columns = all.first_section[k + 2] - b0;
  std::vector<int> shared(static_cast<std::size_t>(b0 - a0) * columns, 0);
  if (shared.empty()) return shared;
  for (int v = 0; v < all.height; ++v) {
    const int row = k * all.height + v;
    int i = all.first_run[row], j = all.first_run[row + all.height];
    while (i < all.first_run[row + 1] && j < all.first_run[row + all.height + 1]) {
      const SectionRun &a = all.runs[i], &b = all.runs[j];
      const int both = std::min(a.u1, b.u1) - std::max(a.u0, b.u0);
      if (both > 0) shared[static_cast<std::size_t>(a.section - a0) * columns + b.section - b0] += both;
      a.u1 < b.u1 ? ++i : ++j;
    }
  }
  return shared;
}

/// The index of the largest of count values, -1 if none is positive or two are the largest.
template <class Value>
int largest(int count, Value&& value) {
  int best = -1, most = 0;
  for (int i = 0; i < count; ++i) {
    if (value(i) == most) best = -1;
    if (value(i) > most) best = i, most = value(i);
  }
  return best;
}

void link(Sections& all) {
  parallel_ranges(0, all.slices - 1, 4, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const int a0 = all.first_section[k], b0 = all.first_section[k + 1];
      const int rows = b0 - a0, columns = all.first_section[k + 2] - b0;
      const std::vector<int> shared = overlaps(all, k);
      const auto at = [&](int a, int b) { return shared[static_cast<std::size_t>(a) * columns + b]; };
      for (int a = 0; a < rows; ++a) {
        const int b = largest(columns, [&](int i) { return at(a, i); });
        if (b >= 0) all.sections[a0 + a].above = b0 + b;
      }
      for (int b = 0; b < columns; ++b) {
        const int a = largest(rows, [&](int i) { return at(i, b); });
        if (a >= 0) all.sections[b0 + b].below = a0 + a;
      }
    }
  });
}

void find_parts(Sections& all) {
  for (int s = 0; s < static_cast<int>(all.sections.size()); ++s) {
    Section& section = all.sections[s];
    bool goes_on = section.below >= 0 && all.sections[section.below].above == s;
    for (int c = 0; goes_on && c < 4; ++c)
      goes_on = std::abs(all.sections[section.below].ends[c] - section.ends[c]) <= Sections::kJump;
    section.part = goes_on ? all.sections[section.below].part : static_cast<int>(all.parts.size());
    if (!goes_on) all.parts.emplace_back();
    all.parts[section.part].push_back(s);
  }
}

}  // namespace

Sections cut(const VoxelGrid& solid, int axis, const ViewSet& views) {
  Sections all{.axis = axis, .slices = solid.size()[axis]};
  all.width = solid.size()[axis == 0 ? 1 : 0];
  all.height = solid.size()[axis == 2 ? 1 : 2];
  const SliceRows rows(solid, axis);
  const Ends ends(solid, views);
  std::vector<Slice> slices(all.slices);
  parallel_ranges(0, all.slices, 4, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      slices[k] = label(rows, k, all.height);
      for (Section& section : slices[k].sections) place_ends(section, ends, axis);
    }
  });
  for (Slice& slice : slices) {
    const int run = static_cast<int>(all.runs.size()), section = static_cast<int>(all.sections.size());
    for (const int first : slice.first_run) all.first_run.push_back(run + first);
    for (SectionRun& each : slice.runs) each.section += section;
    all.runs.insert(all.runs.end(), slice.runs.begin(), slice.runs.end());
    all.first_section.push_back(section);
    all.sections.insert(all.sections.end(), slice.sections.begin(), slice.sections.end());
  }
  all.first_run.push_back(static_cast<int>(all.runs.size()));
  all.first_section.push_back(static_cast<int>(all.sections.size()));
  link(all);
  find_parts(all);
  return all;
}

}  // namespace carve
