#include "models/shells.h"

#include <algorithm>
#include <numeric>

namespace carve {

std::vector<int> shell_indices(const Mesh& mesh) {
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root(b)] = root(a);
    parent[root(c)] = root(a);
  }
  std::vector<int> number(mesh.positions.size(), -1), shell;
  int count = 0;
  for (const Triangle& t : mesh.triangles) {
    int& n = number[root(t[0])];
    shell.push_back(n < 0 ? n = count++ : n);
  }
  return shell;
}

std::vector<Mesh> shells(const Mesh& mesh) {
  const std::vector<int> shell = shell_indices(mesh);
  std::vector<Mesh> parts(shell.empty() ? 0 : *std::max_element(shell.begin(), shell.end()) + 1);
  std::vector<int> place(mesh.positions.size(), -1);
  for (std::size_t i = 0; i < shell.size(); ++i) {
    Mesh& part = parts[shell[i]];
    Triangle t = mesh.triangles[i];
    for (int& k : t) {
      if (place[k] < 0) {
        place[k] = static_cast<int>(part.positions.size());
        part.positions.push_back(mesh.positions[k]);
      }
      k = place[k];
    }
    part.triangles.push_back(t);
  }
  return parts;
}

}  // namespace carve
