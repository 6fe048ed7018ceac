#include "models/shells.h"

#include <algorithm>
#include <map>
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

Mesh welded(const Mesh& mesh) {
  const auto before = [](const Vec3& p, const Vec3& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::map<Vec3, int, decltype(before)> place(before);
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    if (a == b || b == c || c == a) continue;
    Triangle joined;
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.positions[t[k]];
      const auto [found, is_new] = place.try_emplace(p, static_cast<int>(result.positions.size()));
      if (is_new) result.positions.push_back(p);
      joined[k] = found->second;
    }
    result.triangles.push_back(joined);
  }
  return result;
}

bool winds_whole(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> balance;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
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
