#pragma once
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace carve {

/// Union-find over 0 .. n-1. A set is named by its least member.
struct DisjointSets {
  std::vector<int> parent;
  explicit DisjointSets(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0); }
  int find(int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  /// \param a, b  names of sets \return the name of their union
  int join(int a, int b) {
    const auto [least, other] = std::minmax(a, b);
    parent[other] = least;
    return least;
  }
};

}  // namespace carve
