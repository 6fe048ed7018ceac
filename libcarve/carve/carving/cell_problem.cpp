#include "carve/carving/cell_problem.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <unordered_map>

#include "carve/carving/stroke_score.h"

namespace carve {
namespace {

struct SequenceHash {
  std::size_t operator()(const std::vector<int>& s) const {
    std::uint64_t h = 1469598103934665603ULL;
    for (const int v : s) h = (h ^ static_cast<std::uint64_t>(v)) * 1099511628211ULL;
    return h;
  }
};

/// What a pixel costs in which two views show a cell in colours that differ for certain.
std::vector<std::array<std::int64_t, 15>> clashes(const Cells& cells, std::span<const RegionMap> views, double weight) {
  constexpr JumpRamp kOther{30, 90};  // largest difference of a channel, of 255
  std::vector<std::array<std::int64_t, 15>> out(cells.count);
  for (int c = 0; c < cells.count; ++c) {
    out[c].fill(0);
    for (std::size_t v = 1, pair = 0; v < views.size(); ++v)
      for (std::size_t w = 0; w < v; ++w, ++pair) {
        const Vec3 difference = views[v].colour[cells.regions[c][v]] - views[w].colour[cells.regions[c][w]];
        out[c][pair] = std::llround(weight * kOther(difference.cwiseAbs().maxCoeff()));
      }
  }
  return out;
}

/// Per cell, the one that takes its place when the solid is mirrored left-right: they cover each other all but for a
/// voxel at their borders. -1: none, or itself. A drawing that is not symmetric cuts cells that have none.
std::vector<int> mirror_images(const Cells& cells) {
  const Vec3i& size = cells.size;
  std::vector<std::size_t> begin(static_cast<std::size_t>(size.y()) * size.z() + 1, 0);
  for (const CellRun& run : cells.runs) ++begin[static_cast<std::size_t>(run.z) * size.y() + run.y + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::unordered_map<int, std::int64_t>> shared(cells.count);
  for (const CellRun& run : cells.runs) {
    const std::size_t row = static_cast<std::size_t>(run.z) * size.y() + run.y;
    const int x0 = size.x() - run.x1, x1 = size.x() - run.x0;
    for (std::size_t k = begin[row]; k < begin[row + 1]; ++k) {
      const CellRun& other = cells.runs[k];
      if (const int both = std::min(x1, other.x1) - std::max(x0, other.x0); both > 0)
        shared[run.cell][other.cell] += both;
    }
  }
  std::vector<int> image(cells.count, -1);
  for (int c = 0; c < cells.count; ++c)
    for (const auto& [other, voxels] : shared[c])
      if (other != c && voxels > 0.7 * std::max(cells.volume[c], cells.volume[other])) image[c] = other;
  return image;
}

}  // namespace

std::array<std::vector<CellProblem::Pay>, 5> CellProblem::jump_costs(int resolution, double side,
                                                                     const CellWeights& weights) {
  // In the order of Border.
  const double stroke[] = {0, 0, 1, weights.open, 0}, jump[] = {weights.unexplained, 0, 0, 0, weights.colour};
  std::array<std::vector<Pay>, 5> out;
  for (std::size_t b = 0; b < out.size(); ++b)
    for (int depth = 0; depth < resolution; ++depth) {
      const double size = static_cast<double>(depth) / resolution;
      out[b].push_back({static_cast<std::int32_t>(std::lround(side * stroke[b] * (1 - kStrokeJump(size)))),
                        static_cast<std::int32_t>(std::lround(side * jump[b] * kUnexplainedJump(size)))});
    }
  return out;
}

CellProblem::CellProblem(const Cells& cells, std::span<const RegionMap> views, const CellWeights& weights)
    : keep_(cells.count, 1), classes_of_(cells.count), contacts_(cells.count) {
  const double side = kUnit * 128 / cells.size.maxCoeff(), face = side * side / kUnit, voxel = face * side / kUnit;
  sight_.resize(cells.count);
  buried_ = voxel * weights.buried;
  volume_ = cells.volume;
  auto costs = std::make_shared<Costs>();
  costs->jumps = jump_costs(cells.size.maxCoeff(), side, weights);
  std::vector<std::vector<PixelPair>> pairs;  // per group
  for (int v = 0; v < static_cast<int>(views.size()); ++v) {
    const RegionMap& view = views[v];
    const Rays& rays = cells.rays[v];
    std::unordered_map<std::vector<int>, int, SequenceHash> class_of;
    std::vector<int> at(static_cast<std::size_t>(rays.width) * rays.height, -1);
    std::vector<int> sequence;
    for (int j = 0; j < rays.height; ++j)
      for (int i = 0; i < rays.width; ++i) {
        const auto ray = rays(i, j);
        if (ray.empty()) continue;
        sequence.clear();
        for (const RayEntry& e : ray) sequence.push_back(e.cell);
        const auto [found, fresh] = class_of.try_emplace(sequence, static_cast<int>(classes_.size()));
        if (fresh) {
          classes_.push_back({static_cast<int>(order_.size()), static_cast<int>(ray.size()), 0, v, 0, {}});
          for (const RayEntry& e : ray) {
            order_.push_back(e.cell);
            classes_of_[e.cell].push_back(found->second);
          }
        }
        ++classes_[found->second].pixels;
        for (const RayEntry& e : ray) ++sight_[e.cell][v].pixels;
        classes_[found->second].empty += std::llround(face * weights.silhouette);
        at[static_cast<std::size_t>(j) * rays.width + i] = found->second;
      }
    // The depths along each pixel's ray, and -1 where it meets nothing any more.
    std::vector<int> depths_at(at.size(), -1);
    for (int j = 0; j < rays.height; ++j)
      for (int i = 0; i < rays.width; ++i) {
        depths_at[static_cast<std::size_t>(j) * rays.width + i] = static_cast<int>(costs->depths.size());
        for (const RayEntry& e : rays(i, j)) costs->depths.push_back(static_cast<std::int16_t>(e.depth));
        costs->depths.push_back(-1);
      }
    std::unordered_map<std::uint64_t, int> group_of;
    const auto pair = [&](std::size_t p, std::size_t q, Border border) {
      const int a = at[p], b = at[q];
      if (border == Border::near || a < 0 || b < 0) return;
      const auto [found, fresh] =
          group_of.emplace(static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b), groups_.size());
      if (fresh) {
        groups_.push_back({a, b});
        pairs.emplace_back();
        classes_[a].groups.push_back(found->second);
        if (a != b) classes_[b].groups.push_back(found->second);
      }
      pairs[found->second].push_back({depths_at[p], depths_at[q], border});
    };
    for (int j = 0; j < rays.height; ++j)
      for (int i = 0; i < rays.width; ++i) {
        const std::size_t p = static_cast<std::size_t>(j) * rays.width + i;
        if (i + 1 < rays.width) pair(p, p + 1, view.right(i, j));
        if (j + 1 < rays.height) pair(p, p + rays.width, view.below(i, j));
      }
  }
  for (const CellContact& c : contacts(cells)) {
    const std::int64_t area = std::llround(face * weights.area * c.faces);
    contacts_[c.a].push_back({c.b, area});
    if (c.b >= 0)
      contacts_[c.b].push_back({c.a, area});
    else
      energy_ += area;
  }
  for (const std::int64_t v : cells.volume) volume_cost_.push_back(std::llround(voxel * weights.volume * v));
  for (std::size_t g = 0; g < groups_.size(); ++g) tabulate(groups_[g], pairs[g], *costs);
  costs_ = std::move(costs);
  first_.assign(classes_.size(), 0);  // all is kept
  for (const Class& c : classes_) set_open(c, 0, 1, 1);
  for (Group& g : groups_) {
    g.value = value_of(g);
    strokes_ += g.value.stroke, jumps_ += g.value.jump;
  }
  energy_ += misfit();
  class_mark_.assign(classes_.size(), 0);
  group_mark_.assign(groups_.size(), 0);
  touch_mark_.assign(cells.count, 0);
  clash_ = clashes(cells, views, face * weights.agreement);
  symmetry_ = voxel * weights.symmetry;
  mirror_ = weights.symmetry > 0 ? mirror_images(cells) : std::vector<int>(cells.count, -1);
  touched_.clear();
  for (int c = 0; c < cells.count; ++c) {
    own_now_.push_back(own_cost(c));
    energy_ += own_now_.back();
  }
}

int CellProblem::first_of(const Class& c, int k) const {
  while (k < c.length && !keep_[order_[c.begin + k]]) ++k;
  return k;
}

/// Few pairs are added up when they are asked for: what is in the cache already is faster than a table that is not.
void CellProblem::tabulate(Group& group, std::span<const PixelPair> pairs, Costs& costs) const {
  constexpr std::size_t kFew = 6;
  if (pairs.size() <= kFew) {
    group.begin = static_cast<int>(costs.pairs.size());
    group.pairs = static_cast<int>(pairs.size());
    costs.pairs.insert(costs.pairs.end(), pairs.begin(), pairs.end());
    return;
  }
  const int rows = classes_[group.a].length, columns = classes_[group.b].length;
  group.begin = static_cast<int>(costs.tables.size());
  group.columns = group.a == group.b ? 1 : columns + 1;
  costs.tables.resize(costs.tables.size() + (rows + 1) * group.columns);
  for (const PixelPair& pair : pairs) {
    const auto add = [&](int k, int l, int place) {
      const Pay pay = costs.of(pair, k, l);
      costs.tables[group.begin + place].stroke += pay.stroke;
      costs.tables[group.begin + place].jump += pay.jump;
    };
    for (int k = 0; k < rows; ++k) {
      if (group.a == group.b)  // both meet the same cell first
        add(k, k, k);
      else
        for (int l = 0; l < columns; ++l) add(k, l, k * group.columns + l);
    }
  }
}

CellProblem::Pay CellProblem::value_of(const Group& g) const {
  const int a = first_[g.a], b = first_[g.b];
  if (g.columns > 0) return costs_->tables[g.begin + a * g.columns + (g.a == g.b ? 0 : b)];
  Pay sum;
  for (int k = g.begin; k < g.begin + g.pairs; ++k) {
    const Pay pay = costs_->of(costs_->pairs[k], a, b);
    sum.stroke += pay.stroke, sum.jump += pay.jump;
  }
  return sum;
}

void CellProblem::set_open(const Class& c, int from, int to, int sign) {
  for (int k = from; k < to; ++k) {
    const int cell = order_[c.begin + k];
    sight_[cell][c.view].open += sign * c.pixels;
    touched_.push_back(cell);
  }
}

/// Of a dropped cell: how far it is from being seen empty in two views. Of a kept one: colours that disagree.
std::int64_t CellProblem::own_cost(int cell) const {
  const auto& sight = sight_[cell];
  if (!keep_[cell]) {
    double seen = 0;
    for (const Sight& s : sight)
      if (s.pixels > 0) seen += static_cast<double>(s.open) / s.pixels;
    return std::llround(buried_ * volume_[cell] * std::max(0.0, 2 - seen));
  }
  std::int64_t cost = 0;
  for (int v = 1, pair = 0; v < 6; ++v)
    for (int w = 0; w < v; ++w, ++pair)
      if (clash_[cell][pair]) cost += clash_[cell][pair] * std::min(sight[v].open, sight[w].open);
  return cost;
}

std::int64_t CellProblem::flip(std::span<const int> cells) {
  ++stamp_;
  const std::int64_t before = energy_, misfit_before = misfit();
  bool added = false;
  for (const int c : cells) {
    keep_[c] ^= 1;
    added |= keep_[c] != 0;
    energy_ += keep_[c] ? -volume_cost_[c] : volume_cost_[c];
    if (const int m = mirror_[c]; m >= 0) {
      const std::int64_t cost = std::llround(symmetry_ * std::min(volume_[c], volume_[m]));
      energy_ += keep_[c] != keep_[m] ? cost : -cost;
    }
    for (const Contact& contact : contacts_[c]) {
      const bool other = contact.other >= 0 && keep_[contact.other];
      energy_ += (keep_[c] != other) ? contact.cost : -contact.cost;
    }
  }
  changed_.clear();
  for (const int c : cells)
    for (const int k : classes_of_[c]) {
      if (class_mark_[k] == stamp_) continue;
      class_mark_[k] = stamp_;
      const Class& ray = classes_[k];
      const int old = first_[k], first = first_of(ray, added ? 0 : old);
      if (first == old) continue;
      if (old == ray.length) uncovered_ -= ray.empty;
      if (first == ray.length) uncovered_ += ray.empty;
      // A cell is open to a ray as long as nothing is kept before it: up to and with the first kept one.
      const int was = std::min(old + 1, ray.length), now = std::min(first + 1, ray.length);
      if (now > was) set_open(ray, was, now, 1);
      if (now < was) set_open(ray, now, was, -1);
      first_[k] = first;
      changed_.push_back(k);
    }
  for (const int k : changed_)
    for (const int g : classes_[k].groups) {
      if (group_mark_[g] == stamp_) continue;
      group_mark_[g] = stamp_;
      ++looks_;
      Pay& value = groups_[g].value;
      strokes_ -= value.stroke, jumps_ -= value.jump;
      value = value_of(groups_[g]);
      strokes_ += value.stroke, jumps_ += value.jump;
    }
  energy_ += misfit() - misfit_before;
  for (const int c : cells) touched_.push_back(c);
  for (const int c : touched_) {
    if (touch_mark_[c] == stamp_) continue;
    touch_mark_[c] = stamp_;
    energy_ -= own_now_[c];
    energy_ += own_now_[c] = own_cost(c);
  }
  touched_.clear();
  return energy_ - before;
}

}  // namespace carve
