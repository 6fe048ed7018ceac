#include "carve/texture/potts.h"

#include <algorithm>
#include <utility>

namespace carve {

// ---- minimum cut ---------------------------------------------------------------------------------------------------

// Arcs and their reverses, those of a node side by side.
void Cut::build() {
  const std::size_t nodes = terminal_.size();
  first_.assign(nodes + 1, 0);
  for (const Arc& arc : arcs_) ++first_[arc.from], ++first_[arc.to];
  int sum = 0;
  for (int& f : first_) sum += std::exchange(f, sum);
  std::vector<int> at(first_.begin(), first_.end() - 1);
  to_.resize(2 * arcs_.size()), twin_.resize(2 * arcs_.size()), left_.assign(2 * arcs_.size(), 0);
  for (const Arc& arc : arcs_) {
    const int i = at[arc.from]++, j = at[arc.to]++;
    to_[i] = arc.to, to_[j] = arc.from;
    twin_[i] = j, twin_[j] = i;
    left_[i] = arc.capacity;
  }
}

// Steps from the nodes that still have something to send; false once no node that takes any is reached.
bool Cut::find_levels() {
  level_.assign(terminal_.size(), -1);
  queue_.clear();
  for (std::size_t node = 0; node < terminal_.size(); ++node)
    if (terminal_[node] > 0) level_[node] = 0, queue_.push_back(static_cast<int>(node));
  bool found = false;
  for (std::size_t head = 0; head < queue_.size(); ++head) {
    const int node = queue_[head];
    found |= terminal_[node] < 0;
    for (int a = first_[node]; a < first_[node + 1]; ++a)
      if (left_[a] > 0 && level_[to_[a]] < 0) level_[to_[a]] = level_[node] + 1, queue_.push_back(to_[a]);
  }
  return found;
}

// One path from `start` along rising levels to a node that takes something; what went along it, 0 if there is none.
std::int64_t Cut::push(int start) {
  path_.clear();
  for (int node = start;;) {
    if (terminal_[node] < 0) {
      std::int64_t amount = std::min(terminal_[start], -terminal_[node]);
      for (const int a : path_) amount = std::min(amount, left_[a]);
      for (const int a : path_) left_[a] -= amount, left_[twin_[a]] += amount;
      terminal_[start] -= amount, terminal_[node] += amount;
      return amount;
    }
    int& a = next_[node];
    while (a < first_[node + 1] && !(left_[a] > 0 && level_[to_[a]] == level_[node] + 1)) ++a;
    if (a < first_[node + 1]) {
      path_.push_back(a);
      node = to_[a];
      continue;
    }
    if (path_.empty()) return 0;
    node = to_[twin_[path_.back()]];
    path_.pop_back();
    ++next_[node];
  }
}

std::vector<bool> Cut::sink_side() {
  build();
  while (find_levels()) {
    next_.assign(first_.begin(), first_.end() - 1);
    for (std::size_t node = 0; node < terminal_.size(); ++node)
      while (terminal_[node] > 0 && level_[node] == 0 && push(static_cast<int>(node)) > 0) {
      }
  }
  // Whatever still reaches the sink.
  std::vector<bool> side(terminal_.size());
  queue_.clear();
  for (std::size_t node = 0; node < side.size(); ++node)
    if (terminal_[node] < 0) side[node] = true, queue_.push_back(static_cast<int>(node));
  for (std::size_t head = 0; head < queue_.size(); ++head)
    for (int a = first_[queue_[head]]; a < first_[queue_[head] + 1]; ++a)
      if (left_[twin_[a]] > 0 && !side[to_[a]]) side[to_[a]] = true, queue_.push_back(to_[a]);
  return side;
}

// ---- labels --------------------------------------------------------------------------------------------------------

namespace {

class Expansion {
 public:
  explicit Expansion(const PottsProblem& problem)
      : problem_(problem), costs_(problem.costs.begin(), problem.costs.end()) {
    const std::size_t nodes = costs_.size() / problem_.labels;
    first_.assign(nodes + 1, 0);
    for (const auto& edge : problem_.edges) ++first_[edge.a], ++first_[edge.b];
    int sum = 0;
    for (int& f : first_) sum += std::exchange(f, sum);
    half_edges_.resize(2 * problem_.edges.size());
    std::vector<int> at(first_.begin(), first_.end() - 1);
    for (const auto& [a, b, weight] : problem_.edges) {
      half_edges_[at[a]++] = {b, weight};
      half_edges_[at[b]++] = {a, weight};
    }
    label_.resize(nodes);
    for (std::size_t node = 0; node < nodes; ++node) label_[node] = best(static_cast<int>(node));
  }

  std::vector<int> run() {
    decide();
    constexpr int kRounds = 4;  // more change next to nothing
    for (int round = 0, since = 0; round < kRounds; ++round)
      for (int alpha = 0; alpha < problem_.labels; ++alpha) {
        since = expand(alpha) ? 0 : since + 1;
        if (since >= problem_.labels) return label_;
      }
    return label_;
  }

 private:
  struct HalfEdge {
    int to, weight;
  };
  std::int64_t& cost(int node, int label) { return costs_[static_cast<std::size_t>(node) * problem_.labels + label]; }

  int best(int node) {
    int best = 0;
    for (int l = 1; l < problem_.labels; ++l)
      if (cost(node, l) < cost(node, best)) best = l;
    return best;
  }

  // A node whose best label costs less than any other by all the weights of its undecided edges is decided; its edges
  // then only add to what the other labels cost its neighbours.
  void decide() {
    const int nodes = static_cast<int>(label_.size());
    decided_.assign(nodes, false);
    std::vector<std::int64_t> open(nodes);
    std::vector<int> queue(nodes);
    for (int node = 0; node < nodes; ++node) {
      queue[node] = node;
      for (int e = first_[node]; e < first_[node + 1]; ++e) open[node] += half_edges_[e].weight;
    }
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const int node = queue[head];
      if (decided_[node]) continue;
      const int l = best(node);
      bool wins = true;
      for (int other = 0; other < problem_.labels; ++other)
        wins &= other == l || cost(node, other) - cost(node, l) >= open[node];
      if (!wins) continue;
      decided_[node] = true;
      label_[node] = l;
      for (int e = first_[node]; e < first_[node + 1]; ++e) {
        const auto [to, weight] = half_edges_[e];
        if (decided_[to]) continue;
        for (int other = 0; other < problem_.labels; ++other)
          if (other != l) cost(to, other) += weight;
        open[to] -= weight;
        queue.push_back(to);
      }
    }
    for (int node = 0; node < nodes; ++node)
      if (!decided_[node]) label_[node] = best(node);
  }

  // The best set of undecided nodes to take `alpha`, the others keeping what they have \cite kolmogorov_2004.
  bool expand(int alpha) {
    index_.assign(label_.size(), -1);
    nodes_.clear();
    for (int node = 0; node < static_cast<int>(label_.size()); ++node)
      if (!decided_[node] && label_[node] != alpha && cost(node, alpha) < PottsProblem::kImpossible) {
        index_[node] = static_cast<int>(nodes_.size());
        nodes_.push_back(node);
      }
    if (nodes_.empty()) return false;
    Cut cut(static_cast<int>(nodes_.size()));
    for (const int node : nodes_) {
      const int i = index_[node];
      cut.add_terminal(i, cost(node, alpha) - cost(node, label_[node]));
      for (int e = first_[node]; e < first_[node + 1]; ++e) {
        const auto [to, weight] = half_edges_[e];
        if (decided_[to]) continue;  // is in the costs
        if (index_[to] < 0) {
          // A neighbour that stays: it has alpha already or must not take it.
          cut.add_terminal(i, (label_[to] == alpha ? 0 : weight) - (label_[to] == label_[node] ? 0 : weight));
        } else if (node < to) {
          const std::int64_t now = label_[node] == label_[to] ? 0 : weight;
          // E(0,0) = now, E(0,1) = E(1,0) = weight, E(1,1) = 0; 1 = takes alpha = sink side.
          cut.add_terminal(i, weight - now);
          cut.add_terminal(index_[to], -weight);
          cut.add_arc(i, index_[to], 2 * static_cast<std::int64_t>(weight) - now);
        }
      }
    }
    return take(cut, alpha);
  }

  bool take(Cut& cut, int alpha) {
    const std::vector<bool> side = cut.sink_side();
    bool changed = false;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (side[i]) label_[nodes_[i]] = alpha, changed = true;
    return changed;
  }

  const PottsProblem& problem_;
  std::vector<std::int64_t> costs_;
  std::vector<int> first_, label_, index_, nodes_;
  std::vector<HalfEdge> half_edges_;
  std::vector<bool> decided_;
};

}  // namespace

std::vector<int> minimise(const PottsProblem& problem) { return Expansion(problem).run(); }

}  // namespace carve
