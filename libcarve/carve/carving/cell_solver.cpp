#include "carve/carving/cell_solver.h"

#include <algorithm>
#include <cmath>

namespace carve {
namespace {

/// The cells behind one region of a view, nearest first.
struct Column {
  std::vector<int> cells;
};

std::vector<Column> columns_of(const Cells& cells, const Vec3i& size, std::span<const RegionMap> views) {
  std::vector<Column> out;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Rays rays = trace(cells, size, views[v].view);
    std::vector<double> sum(cells.count, 0);
    std::vector<int> seen(cells.count, 0);
    for (const RayEntry& e : rays.entries) {
      sum[e.cell] += e.depth;
      ++seen[e.cell];
    }
    std::vector<Column> of_region(views[v].count);
    for (int c = 0; c < cells.count; ++c) of_region[cells.regions[c][v]].cells.push_back(c);
    for (Column& column : of_region) {
      std::ranges::stable_sort(column.cells, [&](int a, int b) { return sum[a] * seen[b] < sum[b] * seen[a]; });
      if (!column.cells.empty()) out.push_back(std::move(column));
    }
  }
  return out;
}

class Descent {
 public:
  Descent(CellProblem& problem, std::vector<Column> columns, std::int64_t limit)
      : problem_(problem), columns_(std::move(columns)), limit_(limit) {}

  CellSearch run() {
    while (step()) {
    }
    anneal();
    while (step()) {
    }
    return search_;
  }

 private:
  void consider(const std::vector<int>& flips) {
    if (flips.empty() || search_.nodes >= limit_) return;
    ++search_.nodes;
    const std::int64_t change = problem_.flip(flips);
    problem_.flip(flips);
    if (change < best_change_) {
      best_change_ = change;
      best_ = flips;
    }
  }

  std::uint64_t random() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  void anneal() {
    constexpr long steps = 20000;
    constexpr double t0 = 100;
    std::vector<std::uint8_t> best(problem_.keep().begin(), problem_.keep().end());
    std::int64_t best_energy = problem_.energy();
    for (long k = 0; k < steps && search_.nodes < limit_; ++k) {
      const double t = 1024 * t0 * std::pow(0.005, static_cast<double>(k) / steps);
      std::vector<int> set;
      if (random() % 2) {
        set.push_back(random() % problem_.cells());
      } else {
        const Column& column = columns_[random() % columns_.size()];
        const std::size_t level = random() % column.cells.size();
        for (std::size_t i = 0; i < column.cells.size(); ++i)
          if (problem_.keep()[column.cells[i]] != (i >= level)) set.push_back(column.cells[i]);
      }
      if (set.empty()) continue;
      ++search_.nodes;
      const std::int64_t change = problem_.flip(set);
      if (change > 0 && (random() >> 11) * 0x1p-53 >= std::exp(-change / t)) {
        problem_.flip(set);
        continue;
      }
      if (problem_.energy() < best_energy) {
        best_energy = problem_.energy();
        best.assign(problem_.keep().begin(), problem_.keep().end());
      }
    }
    std::vector<int> back;
    for (int c = 0; c < problem_.cells(); ++c)
      if (problem_.keep()[c] != best[c]) back.push_back(c);
    problem_.flip(back);
  }
  std::uint64_t state_ = 1;

  bool step() {
    best_change_ = 0;
    best_.clear();
    for (int c = 0; c < problem_.cells(); ++c) consider({c});
    for (const Column& column : columns_) {
      std::vector<int> drop;
      for (const int c : column.cells) {
        if (!problem_.keep()[c]) continue;
        drop.push_back(c);
        if (drop.size() > 1) consider(drop);
      }
      std::vector<int> restore;
      for (auto c = column.cells.rbegin(); c != column.cells.rend(); ++c) {
        if (problem_.keep()[*c]) continue;
        restore.push_back(*c);
        if (restore.size() > 1) consider(restore);
      }
      for (std::size_t level = 0; level < column.cells.size(); ++level) {
        std::vector<int> set;
        for (std::size_t k = 0; k < column.cells.size(); ++k)
          if (problem_.keep()[column.cells[k]] != (k >= level)) set.push_back(column.cells[k]);
        consider(set);
      }
    }
    if (best_.empty()) return false;
    problem_.flip(best_);
    if (search_.nodes > limit_) search_.finished = false;
    return search_.finished;
  }

  CellProblem& problem_;
  std::vector<Column> columns_;
  std::int64_t limit_;
  CellSearch search_;
  std::int64_t best_change_ = 0;
  std::vector<int> best_;
};

}  // namespace

std::int64_t drop_in_one_pass(CellProblem& problem) {
  std::vector<std::pair<std::int64_t, int>> gains;
  for (int c = 0; c < problem.cells(); ++c) {
    const std::int64_t change = problem.flip(std::span(&c, 1));
    problem.flip(std::span(&c, 1));
    if (change < 0) gains.emplace_back(change, c);
  }
  std::ranges::sort(gains);
  for (const auto& [gain, c] : gains)
    if (problem.flip(std::span(&c, 1)) >= 0) problem.flip(std::span(&c, 1));
  return problem.cells() + static_cast<std::int64_t>(gains.size());
}

CellSearch descend(CellProblem& problem, const Cells& cells, const Vec3i& size, std::span<const RegionMap> views,
                   std::int64_t node_limit) {
  return Descent(problem, columns_of(cells, size, views), node_limit).run();
}

}  // namespace carve
