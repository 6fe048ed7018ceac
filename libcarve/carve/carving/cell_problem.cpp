#include "carve/carving/cell_problem.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <unordered_map>

#include "carve/carving/stroke_score.h"

namespace carve {
namespace {

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

std::vector<CellProblem::Pay> CellProblem::jump_costs(int longest, double side, const CellWeights& weights) {
  // In the order of Border.
  const double stroke[] = {0, 0, 1, weights.open, 0}, jump[] = {weights.unexplained, 0, 0, 0, weights.colour};
  std::vector<Pay> out;
  for (std::size_t b = 0; b < std::size(stroke); ++b) {
    for (int depth = 0; depth < longest; ++depth) {
      const double size = static_cast<double>(depth) / longest;
      out.push_back({static_cast<std::int32_t>(std::lround(side * stroke[b] * (1 - kStrokeJump(size)))),
                     static_cast<std::int32_t>(std::lround(side * jump[b] * kUnexplainedJump(size)))});
    }
    out.emplace_back();
  }
  return out;
}

CellProblem::CellProblem(const Cells& cells, std::span<const RegionMap> views, const CellWeights& weights)
    : keep_(cells.count, 1), volume_(cells.volume), sight_(cells.count) {
  const double side = kUnit * 128 / cells.size.maxCoeff(), face = side * side / kUnit, voxel = face * side / kUnit;
  buried_ = voxel * weights.buried;
  auto costs = std::make_shared<Costs>();
  costs->longest = cells.size.maxCoeff();
  costs->jumps = jump_costs(costs->longest, side, weights);
  std::vector<std::pair<int, PixelPair>> pairs;  // by group
  for (int v = 0; v < static_cast<int>(views.size()); ++v) {
    const RegionMap& view = views[v];
    const Rays& rays = cells.rays[v];
    const std::vector<int> at = add_classes(rays, v, std::llround(face * weights.silhouette));
    // The depths along each pixel's ray, and -1 where it meets nothing any more.
    const std::size_t depths = costs->depths.size();
    for (std::size_t p = 0; p < at.size(); ++p) {
      for (int k = rays.begin[p]; k < rays.begin[p + 1]; ++k)
        costs->depths.push_back(static_cast<std::int16_t>(rays.entries[k].depth));
      costs->depths.push_back(-1);
    }
    const auto depths_at = [&](std::size_t p) { return static_cast<int>(depths + rays.begin[p] + p); };
    std::unordered_map<std::uint64_t, int> group_of;
    int recent[2] = {-1, -1};  // most pixels are in the group of the one before them
    const auto pair = [&](std::size_t p, std::size_t q, Border border, int& group) {
      const int a = at[p], b = at[q];
      if (border == Border::near || a < 0 || b < 0) return;
      if (group < 0 || groups_[group].a != a || groups_[group].b != b) {
        const auto [found, fresh] =
            group_of.emplace(static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b), groups_.size());
        group = found->second;
        if (fresh) groups_.push_back({a, b});
      }
      pairs.push_back({group, {depths_at(p), depths_at(q), border}});
    };
    for (int j = 0; j < rays.height; ++j)
      for (int i = 0; i < rays.width; ++i) {
        const std::size_t p = static_cast<std::size_t>(j) * rays.width + i;
        if (i + 1 < rays.width) pair(p, p + 1, view.right(i, j), recent[0]);
        if (j + 1 < rays.height) pair(p, p + rays.width, view.below(i, j), recent[1]);
      }
  }
  std::vector<std::pair<int, Member>> members;
  members.reserve(order_.size());
  for (int k = 0; k < static_cast<int>(classes_.size()); ++k)
    for (int n = 0; n < classes_[k].length; ++n) members.push_back({order_[classes_[k].begin + n], {k, n}});
  members_ = {cells.count, members};

  std::vector<std::pair<int, Contact>> touching;
  for (const CellContact& c : contacts(cells)) {
    const std::int64_t area = std::llround(face * weights.area * c.faces);
    touching.push_back({c.a, {c.b, area}});
    if (c.b >= 0)
      touching.push_back({c.b, {c.a, area}});
    else
      energy_ += area;
  }
  contacts_ = {cells.count, touching};
  for (const std::int64_t v : cells.volume) volume_cost_.push_back(std::llround(voxel * weights.volume * v));
  const Lists<PixelPair> pairs_of(static_cast<int>(groups_.size()), pairs);
  for (std::size_t g = 0; g < groups_.size(); ++g) tabulate(groups_[g], pairs_of[static_cast<int>(g)], *costs);
  costs_ = std::move(costs);
  drop_free_groups();
  std::vector<std::pair<int, int>> groups_of;  // by class
  for (int g = 0; g < static_cast<int>(groups_.size()); ++g) {
    groups_of.emplace_back(groups_[g].a, g);
    if (groups_[g].a != groups_[g].b) groups_of.emplace_back(groups_[g].b, g);
  }
  groups_of_ = {static_cast<int>(classes_.size()), groups_of};
  first_.assign(classes_.size(), 0);  // all is kept
  was_ = first_;
  for (const Class& c : classes_) set_open(c, 0, 1, 1);
  for (Group& g : groups_) {
    g.value = value_of(g, first_[g.a], first_[g.b]);
    strokes_ += g.value.stroke, jumps_ += g.value.jump;
  }
  energy_ += misfit();
  class_mark_.assign(classes_.size(), 0);
  touch_mark_.assign(cells.count, 0);
  clash_ = clashes(cells, views, face * weights.agreement);
  for (const auto& clash : clash_) clashes_.push_back(std::ranges::any_of(clash, [](auto cost) { return cost != 0; }));
  symmetry_ = voxel * weights.symmetry;
  mirror_ = weights.symmetry > 0 ? mirror_images(cells) : std::vector<int>(cells.count, -1);
  touched_.clear();
  for (int c = 0; c < cells.count; ++c) {
    own_now_.push_back(own_cost(c));
    energy_ += own_now_.back();
  }
}

/// Finds the classes of a view's rays. \return each pixel's, -1: its ray meets nothing
std::vector<int> CellProblem::add_classes(const Rays& rays, int view, std::int64_t empty) {
  const auto cells_of = [&](int p) {
    return std::span(rays.entries).subspan(rays.begin[p], rays.begin[p + 1] - rays.begin[p]);
  };
  const auto alike = [](const RayEntry& a, const RayEntry& b) { return a.cell == b.cell; };
  const auto equal = [&](int p, int q) { return std::ranges::equal(cells_of(p), cells_of(q), alike); };
  const auto hash = [&](int p) {
    std::uint64_t h = 1469598103934665603ULL;
    for (const RayEntry& e : cells_of(p)) h = (h ^ static_cast<std::uint64_t>(e.cell)) * 1099511628211ULL;
    return static_cast<std::size_t>(h ^ h >> 32);
  };
  std::unordered_map<int, int, decltype(hash), decltype(equal)> class_of(64, hash, equal);  // by its first pixel
  std::vector<int> at(rays.begin.size() - 1, -1);
  for (int p = 0; p < static_cast<int>(at.size()); ++p) {
    const auto ray = cells_of(p);
    if (ray.empty()) continue;
    if (p > 0 && equal(p - 1, p)) {
      at[p] = at[p - 1];
    } else {
      const auto [found, fresh] = class_of.try_emplace(p, static_cast<int>(classes_.size()));
      at[p] = found->second;
      if (fresh) {
        classes_.push_back({static_cast<int>(order_.size()), static_cast<int>(ray.size()), view});
        for (const RayEntry& e : ray) order_.push_back(e.cell);
      }
    }
    ++classes_[at[p]].pixels;
  }
  for (auto c = classes_.end() - static_cast<std::ptrdiff_t>(class_of.size()); c != classes_.end(); ++c) {
    c->empty = empty * c->pixels;
    for (int k = c->begin; k < c->begin + c->length; ++k) sight_[order_[k]][view].pixels += c->pixels;
  }
  return at;
}

int CellProblem::first_of(const Class& c, int k) const {
  while (k < c.length && !keep_[order_[c.begin + k]]) ++k;
  return k;
}

void CellProblem::move_first(int ray, int position) {
  if (class_mark_[ray] != stamp_) {
    class_mark_[ray] = stamp_;
    was_[ray] = first_[ray];
    changed_.push_back(ray);
  }
  first_[ray] = position;
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

/// Within most classes pixels never pay anything: neighbours that see the same cell see it about as deep.
void CellProblem::drop_free_groups() {
  std::erase_if(groups_, [&](const Group& group) {
    if (group.a != group.b) return false;
    for (int k = 0; k < classes_[group.a].length; ++k) {
      const Pay pay = value_of(group, k, k);
      if (pay.stroke != 0 || pay.jump != 0) return false;
    }
    return true;
  });
}

/// If its pixels see the a-th and the b-th cell of their rays.
CellProblem::Pay CellProblem::value_of(const Group& g, int a, int b) const {
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
  if (!clashes_[cell]) return 0;
  std::int64_t cost = 0;
  for (int v = 1, pair = 0; v < 6; ++v)
    for (int w = 0; w < v; ++w, ++pair)
      if (clash_[cell][pair]) cost += clash_[cell][pair] * std::min(sight[v].open, sight[w].open);
  return cost;
}

std::int64_t CellProblem::flip(std::span<const int> cells) {
  ++stamp_;
  const std::int64_t before = energy_, misfit_before = misfit();
  for (const int c : cells) {
    keep_[c] ^= 1;
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
    if (keep_[c])
      for (const Member& m : members_[c])
        if (m.position < first_[m.ray]) move_first(m.ray, m.position);
  for (const int c : cells)
    if (!keep_[c])
      for (const Member& m : members_[c])
        if (m.position == first_[m.ray]) move_first(m.ray, first_of(classes_[m.ray], m.position + 1));
  for (const int k : changed_) {
    const Class& ray = classes_[k];
    const int old = was_[k], first = first_[k];
    if (old == ray.length) uncovered_ -= ray.empty;
    if (first == ray.length) uncovered_ += ray.empty;
    // A cell is open to a ray as long as nothing is kept before it: up to and with the first kept one.
    const int was = std::min(old + 1, ray.length), now = std::min(first + 1, ray.length);
    if (now > was) set_open(ray, was, now, 1);
    if (now < was) set_open(ray, now, was, -1);
  }
  std::int64_t strokes = 0, jumps = 0, looks = 0;
  for (const int k : changed_)
    for (const int g : groups_of_[k]) {
      Group& group = groups_[g];
      if (group.a != k && class_mark_[group.a] == stamp_) continue;  // it is looked at as one of that class
      ++looks;
      const Pay value = value_of(group, first_[group.a], first_[group.b]);
      strokes += value.stroke - group.value.stroke;
      jumps += value.jump - group.value.jump;
      group.value = value;
    }
  strokes_ += strokes;
  jumps_ += jumps;
  looks_ += looks;
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
