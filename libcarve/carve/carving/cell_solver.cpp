#include "carve/carving/cell_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carve/core/random.h"

namespace carve {
namespace {

/// Which cells hide which, and the columns of cells that are decided together.
struct Arrangement {
  int views = 0;
  std::vector<std::vector<int>> columns;                        // behind one region of a view: nearest first
  std::array<std::vector<std::vector<int>>, 6> before, behind;  // per view and cell: met directly before, after it
};

Arrangement arrangement(const Cells& cells) {
  Arrangement out;
  out.views = static_cast<int>(cells.rays.size());
  for (std::size_t v = 0; v < cells.rays.size(); ++v) {
    const Rays& rays = cells.rays[v];
    std::vector<std::int64_t> sum(cells.count, 0), seen(cells.count, 0);
    for (const RayEntry& e : rays.entries) {
      sum[e.cell] += e.depth;
      ++seen[e.cell];
    }
    std::vector<std::vector<int>> of_region;
    for (int c = 0; c < cells.count; ++c) {
      const std::size_t region = cells.regions[c][v];
      if (region >= of_region.size()) of_region.resize(region + 1);
      of_region[region].push_back(c);
    }
    for (std::vector<int>& column : of_region) {
      std::ranges::stable_sort(column, [&](int a, int b) { return sum[a] * seen[b] < sum[b] * seen[a]; });
      if (column.size() > 1) out.columns.push_back(std::move(column));
    }
    out.before[v].resize(cells.count);
    out.behind[v].resize(cells.count);
    for (std::size_t p = 0; p + 1 < rays.begin.size(); ++p)
      for (int k = rays.begin[p] + 1; k < rays.begin[p + 1]; ++k) {
        const int front = rays.entries[k - 1].cell, back = rays.entries[k].cell;
        if (std::ranges::count(out.before[v][back], front)) continue;
        out.before[v][back].push_back(front);
        out.behind[v][front].push_back(back);
      }
  }
  return out;
}

/// Calls use(part) for each connected part of the chosen cells; mirror images are connected too.
template <class Use>
void each_part(const CellProblem& problem, std::vector<std::uint8_t> chosen, Use&& use) {
  std::vector<int> part;
  const auto add = [&](int c) {
    if (c < 0 || !chosen[c]) return;
    chosen[c] = 0;
    part.push_back(c);
  };
  for (int first = 0; first < problem.cells(); ++first) {
    part.clear();
    add(first);
    for (std::size_t k = 0; k < part.size(); ++k) {
      add(problem.mirror(part[k]));
      problem.each_neighbour(part[k], add);
    }
    if (!part.empty()) use(std::span<const int>(part));
  }
}

class Search {
 public:
  Search(CellProblem& problem, Arrangement arranged, const SearchLimit& limit)
      : problem_(problem),
        arranged_(std::move(arranged)),
        views_(arranged_.views),
        limit_(limit.nodes),
        until_(limit.until),
        mark_(problem.cells(), 0),
        changed_(problem.cells(), 0) {}

  SearchEnd run() {
    const std::vector<std::uint8_t> start = state();
    descend();
    if (enough_to_anneal()) {
      anneal();
      descend();
    } else if (2 * spent() < limit_) {
      start_again(start);
      descend();
    }
    return {nodes_, !late_, looked_at_all_};
  }

  /// Drops cells with all that hides them in two views, or alone.
  void drop_once() {
    constexpr std::size_t kMost = 60;  // cells
    Moves moves;
    std::vector<int> move;
    for (int c = 0; c < problem_.cells() && !ended(); ++c) {
      if (!problem_.keep()[c]) continue;
      for (int v = 0; v < views_; ++v)
        for (int w = 0; w < v; ++w)
          if (open_or_fill(c, v, w, true, kMost, move)) look_at(move, moves);
      move.assign(1, c);
      look_at(move, moves);
    }
    apply(moves);
  }

  /// Drops or restores single cells.
  void flip_once() {
    Moves moves;
    std::vector<int> move;
    for (int c = 0; c < problem_.cells(); ++c) {
      move.assign(1, c);
      look_at(move, moves);
    }
    apply(moves);
  }

  std::int64_t nodes() const { return nodes_; }

 private:
  using Moves = std::vector<std::pair<std::int64_t, std::vector<int>>>;  // by what each changes by itself

  /// The clock is asked now and then only; most searches have none to ask.
  bool ended() {
    if (until_ && !late_ && ++asked_ % 64 == 0) late_ = std::chrono::steady_clock::now() >= *until_;
    return late_ || spent() >= limit_;
  }
  /// Of the limit. A choice that many rays see counts for several, so that the time depends less on the drawing.
  std::int64_t spent() const {
    constexpr int kLooks = 32;
    return nodes_ + (problem_.looks() - looks_before_) / kLooks;
  }
  void flip(int cell) {
    ++nodes_;
    problem_.flip(std::span(&cell, 1));
  }

  /// The cell and all that hide it in two views, as far as they are kept: dropping them, it is seen empty in both. The
  /// other way round, the cell and all that it hides there, as far as they are dropped.
  bool open_or_fill(int cell, int v, int w, bool drop, std::size_t most, std::vector<int>& move) {
    move.clear();
    ++stamp_;
    queue_.assign(1, cell);
    mark_[cell] = stamp_;
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      if (move.size() > most || k > 8 * most) return false;
      const int c = queue_[k];
      if (problem_.keep()[c] == drop) move.push_back(c);
      for (const int view : {v, w})
        for (const int n : (drop ? arranged_.before : arranged_.behind)[view][c])
          if (mark_[n] != stamp_) {
            mark_[n] = stamp_;
            queue_.push_back(n);
          }
    }
    return true;
  }

  /// Adds the mirror images of the move's cells, as far as they stand as these do.
  void mirror(std::vector<int>& move) {
    ++stamp_;
    for (const int c : move) mark_[c] = stamp_;
    for (std::size_t k = 0, n = move.size(); k < n; ++k) {
      const int m = problem_.mirror(move[k]);
      if (m < 0 || mark_[m] == stamp_ || problem_.keep()[m] != problem_.keep()[move[k]]) continue;
      mark_[m] = stamp_;
      move.push_back(m);
    }
  }

  void look_at(std::vector<int>& move, Moves& moves) {
    mirror(move);
    nodes_ += static_cast<std::int64_t>(move.size());
    if (const std::int64_t change = problem_.flip(move); change < 0) moves.emplace_back(change, move);
    problem_.flip(move);
  }

  /// What lowers the energy most by itself first; cells that another move flipped already stay as they are, and what no
  /// longer lowers the energy is left.
  void apply(Moves& moves) {
    std::ranges::sort(moves);
    const std::vector<std::uint8_t> before = state();
    for (auto& [gain, move] : moves) {
      std::erase_if(move, [&](int c) { return problem_.keep()[c] != before[c]; });
      nodes_ += static_cast<std::int64_t>(move.size());
      if (!move.empty() && problem_.flip(move) >= 0) problem_.flip(move);
    }
  }

  void try_move(std::vector<int>& move) {
    mirror(move);
    nodes_ += static_cast<std::int64_t>(move.size());
    if (problem_.flip(move) >= 0)
      problem_.flip(move);
    else
      change(move);
  }

  /// What is next to the cells that were flipped is to be looked at again.
  void change(std::span<const int> cells) {
    ++time_;
    for (const int c : cells) {
      changed_[c] = time_;
      const auto touch = [&](int n) {
        if (n >= 0) changed_[n] = time_;
      };
      problem_.each_neighbour(c, touch);
      for (int v = 0; v < views_; ++v) {
        std::ranges::for_each(arranged_.before[v][c], touch);
        std::ranges::for_each(arranged_.behind[v][c], touch);
      }
    }
  }

  std::vector<std::uint8_t> state() const { return {problem_.keep().begin(), problem_.keep().end()}; }

  /// Until nothing changes any more; what nothing changed next to is not looked at again.
  void descend() {
    const std::vector<std::int64_t> never(problem_.cells(), -1);
    std::vector<std::int64_t> opened = never, flipped = never, levelled(arranged_.columns.size(), -1);
    for (std::int64_t before = problem_.energy() + 1; problem_.energy() < before && !ended();) {
      before = problem_.energy();
      level_each(levelled);
      flip_each(flipped);
      looked_at_all_ = looked_at_all_ || !ended();
      open_each(opened);
    }
  }

  void level_each(std::vector<std::int64_t>& levelled) {
    for (std::size_t k = 0; k < arranged_.columns.size() && !ended(); ++k) {
      const std::vector<int>& column = arranged_.columns[k];
      if (std::ranges::all_of(column, [&](int c) { return changed_[c] <= levelled[k]; })) continue;
      levelled[k] = time_;
      try_in_order(column, true);
      try_in_order(std::vector<int>(column.rbegin(), column.rend()), false);
      try_levels(column);
    }
  }

  void flip_each(std::vector<std::int64_t>& flipped) {
    std::vector<int> move;
    for (int c = 0; c < problem_.cells() && !ended(); ++c) {
      if (changed_[c] <= flipped[c]) continue;
      flipped[c] = time_;
      move.assign(1, c);
      try_move(move);
    }
  }

  void open_each(std::vector<std::int64_t>& opened) {
    const std::size_t most = std::max<std::size_t>(4, limit_ / 12 / std::max(1, problem_.cells()));
    std::vector<int> move;
    for (int c = 0; c < problem_.cells(); ++c) {
      if (changed_[c] <= opened[c]) continue;
      opened[c] = time_;
      for (int v = 0; v < views_; ++v)
        for (int w = 0; w < v; ++w) {
          if (ended()) return;
          if (open_or_fill(c, v, w, problem_.keep()[c], most, move)) try_move(move);
        }
    }
  }

  /// Drops (or restores) the first n cells of those that are kept (dropped), for the best n.
  void try_in_order(const std::vector<int>& order, bool kept) {
    std::vector<int> flipped;
    std::size_t best = 0;
    std::int64_t best_energy = problem_.energy();
    for (const int c : order) {
      if (problem_.keep()[c] != kept) continue;
      flip(c);
      flipped.push_back(c);
      if (problem_.energy() < best_energy) best_energy = problem_.energy(), best = flipped.size();
    }
    for (; flipped.size() > best; flipped.pop_back()) flip(flipped.back());
    change(flipped);
  }

  /// Drops the first n cells and keeps the rest, for the best n, if that is better than what is.
  void try_levels(const std::vector<int>& column) {
    const std::int64_t energy = problem_.energy();
    std::vector<std::uint8_t> before;
    before.reserve(column.size());
    for (const int c : column) before.push_back(problem_.keep()[c]);
    for (const int c : column)
      if (!problem_.keep()[c]) flip(c);
    std::size_t best = 0;
    std::int64_t best_energy = problem_.energy();
    for (std::size_t n = 1; n <= column.size(); ++n) {
      flip(column[n - 1]);
      if (problem_.energy() < best_energy) best_energy = problem_.energy(), best = n;
    }
    const bool better = best_energy < energy;
    for (std::size_t k = 0; k < column.size(); ++k)
      if ((better ? k >= best : before[k]) != problem_.keep()[column[k]]) flip(column[k]);
    if (!better) return;
    std::vector<int> flipped;
    for (std::size_t k = 0; k < column.size(); ++k)
      if (problem_.keep()[column[k]] != before[k]) flipped.push_back(column[k]);
    change(flipped);
  }

  /// With less steps a cell it was never seen to find anything better.
  bool enough_to_anneal() const {
    constexpr int kFewest = 100;
    return problem_.cells() > 0 && (limit_ - spent()) * 9 / 10 >= kFewest * problem_.cells();
  }

  /// Descends from where drop_once() leads to, and takes over what is better there.
  void start_again(std::span<const std::uint8_t> start) {
    const std::vector<std::uint8_t> one = state();
    const std::int64_t energy = problem_.energy();
    become(start);
    drop_once();
    descend();
    const std::vector<std::uint8_t> other = state();
    if (problem_.energy() < energy) return join(one);
    become(one);
    join(other);
  }

  void become(std::span<const std::uint8_t> state) {
    std::vector<int> move;
    for (int c = 0; c < problem_.cells(); ++c)
      if (problem_.keep()[c] != state[c]) move.push_back(c);
    problem_.flip(move);
  }

  /// Takes over each connected part in which another choice differs, if that is better.
  void join(std::span<const std::uint8_t> other) {
    std::vector<std::uint8_t> differs(problem_.cells());
    for (int c = 0; c < problem_.cells(); ++c) differs[c] = problem_.keep()[c] != other[c];
    each_part(problem_, std::move(differs), [&](std::span<const int> part) {
      nodes_ += static_cast<std::int64_t>(part.size());
      if (problem_.flip(part) >= 0) problem_.flip(part);
    });
  }

  void anneal() {
    constexpr double kHot = 50, kCold = 1;  // in units of the energy: sides of grid pixels
    const std::int64_t start = spent(), steps = (limit_ - start) * 9 / 10;
    std::vector<std::uint8_t> best = state();
    std::int64_t best_energy = problem_.energy();
    std::vector<int> move;
    while (spent() - start < steps && !ended()) {
      const double done = static_cast<double>(spent() - start) / steps;
      const double temperature = CellProblem::kUnit * kHot * std::pow(kCold / kHot, done);
      random_move(move);
      mirror(move);
      const std::int64_t energy = problem_.energy();
      problem_.flip(move);
      const std::int64_t change = problem_.energy() - energy;
      if (change > 0 && random_.unit() >= std::exp(-change / temperature)) {
        problem_.flip(move);
      } else if (problem_.energy() < best_energy) {
        best_energy = problem_.energy();
        best = state();
      }
      nodes_ += 1 + static_cast<std::int64_t>(move.size());
    }
    for (int c = 0; c < problem_.cells(); ++c)
      if (problem_.keep()[c] != best[c]) flip(c);
  }

  /// By turns one cell; one opened or filled in two views; a column dropped up to some cell and kept behind it.
  void random_move(std::vector<int>& move) {
    const std::size_t kind = random_.below(4);
    const int cell = static_cast<int>(random_.below(problem_.cells()));
    move.assign(1, cell);
    if (kind == 2 && views_ > 1) {
      const int v = static_cast<int>(random_.below(views_)), w = static_cast<int>(random_.below(views_ - 1));
      if (!open_or_fill(cell, v, w < v ? w : w + 1, problem_.keep()[cell], 16, move)) move.assign(1, cell);
    } else if (kind == 3 && !arranged_.columns.empty()) {
      const std::vector<int>& column = arranged_.columns[random_.below(arranged_.columns.size())];
      const std::size_t level = random_.below(column.size() + 1);
      move.clear();
      for (std::size_t k = 0; k < column.size(); ++k)
        if (problem_.keep()[column[k]] != (k >= level)) move.push_back(column[k]);
    }
  }

  CellProblem& problem_;
  Arrangement arranged_;
  int views_;
  std::int64_t limit_, looks_before_ = problem_.looks(), nodes_ = 0, asked_ = 0;
  std::optional<std::chrono::steady_clock::time_point> until_;
  bool late_ = false, looked_at_all_ = false;
  std::vector<int> queue_, mark_;
  int stamp_ = 0;
  std::vector<std::int64_t> changed_;  // when something next to a cell changed last
  std::int64_t time_ = 0;
  Random random_;
};

}  // namespace

std::int64_t drop_in_one_pass(CellProblem& problem, const Cells& cells) {
  Search search(problem, arrangement(cells), {std::numeric_limits<std::int64_t>::max(), {}});
  search.drop_once();
  return search.nodes();
}

std::int64_t flip_in_one_pass(CellProblem& problem) {
  Search search(problem, {}, {});
  search.flip_once();
  return search.nodes();
}

void restore_unexplained(CellProblem& problem) {
  std::vector<std::uint8_t> dropped(problem.cells());
  for (int c = 0; c < problem.cells(); ++c) dropped[c] = !problem.keep()[c];
  each_part(problem, std::move(dropped), [&](std::span<const int> part) {
    const std::int64_t strokes = problem.strokes(), jumps = problem.jumps();
    problem.flip(part);
    const std::int64_t explained = problem.strokes() - strokes, added = jumps - problem.jumps();
    if (4 * added <= explained) problem.flip(part);
  });
}

SearchEnd search_cells(CellProblem& problem, const Cells& cells, const SearchLimit& limit) {
  return Search(problem, arrangement(cells), limit).run();
}

}  // namespace carve
