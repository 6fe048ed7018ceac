#pragma once
#include <cstdint>
#include <vector>

namespace carve {

/// Which label each node takes: least sum of the nodes' costs and of the weights of edges between different labels.
struct PottsProblem {
  static constexpr int kImpossible = 1 << 28;
  struct Edge {
    int a, b, weight;
  };
  int labels = 0;
  std::vector<int> costs;  // [node * labels + label], from 0 to kImpossible
  std::vector<Edge> edges;
};

/// Alpha expansion \cite boykov_2001 over what is not decided beforehand: a node whose best label wins whatever its
/// undecided neighbours take has it in every optimum. Deterministic; within a factor of two of the least sum, in
/// practice a few percent. Every node needs one label below kImpossible.
std::vector<int> minimise(const PottsProblem& problem);

/// Maximum flow between two terminals \cite dinic_1970: a node's terminal capacity is what it gets from the source if
/// positive, what it may give to the sink if negative.
class Cut {
 public:
  explicit Cut(int nodes) : terminal_(nodes) {}
  void add_terminal(int node, std::int64_t capacity) { terminal_[node] += capacity; }
  void add_arc(int from, int to, std::int64_t capacity) { arcs_.push_back({from, to, capacity}); }
  /// Per node, whether it lies on the sink's side of the minimum cut; of several the one with the fewest there.
  std::vector<bool> sink_side();

 private:
  struct Arc {
    int from, to;
    std::int64_t capacity;
  };
  void build();
  bool find_levels();
  std::int64_t push(int start);

  std::vector<std::int64_t> terminal_;
  std::vector<Arc> arcs_;
  std::vector<int> first_, to_, twin_, level_, next_, queue_, path_;
  std::vector<std::int64_t> left_;
};

}  // namespace carve
