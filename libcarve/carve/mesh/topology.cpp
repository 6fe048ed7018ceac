#include "carve/mesh/topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <numeric>
#include <ostream>
#include <span>

#include "carve/core/parallel.h"
#include "carve/mesh/adjacency.h"

namespace carve {
namespace {

// A triangle seen from one of its corners: the edge of the corner's link, counter-clockwise.
struct LinkEdge {
  int from, to;
};

int root_of(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// True if the two were apart.
bool join(std::vector<int>& parent, int a, int b) {
  const int root_a = root_of(parent, a), root_b = root_of(parent, b);
  parent[std::max(root_a, root_b)] = std::min(root_a, root_b);
  return root_a != root_b;
}

// One cycle of three or more that runs one way: the link of every vertex of a solid. Reorders the edges.
bool is_cycle(std::span<LinkEdge> link) {
  constexpr std::size_t kFew = 32;  // the search is quadratic
  if (link.size() < 3 || link.size() > kFew) return false;
  int wanted = link[0].from;
  for (std::size_t k = 0; k < link.size(); ++k) {
    std::size_t matches = 0, at = 0;
    for (std::size_t i = k; i < link.size(); ++i)
      if (link[i].from == wanted) ++matches, at = i;
    if (matches != 1) return false;
    std::swap(link[k], link[at]);
    wanted = link[k].to;
  }
  return wanted == link[0].from;
}

// Counts around ranges of vertices. An edge is counted at its lower vertex.
class LinkCounter {
 public:
  explicit LinkCounter(const Mesh& mesh, const VertexTriangles& around) : mesh_(mesh), around_(around) {}

  void count(int vertex) {
    const auto triangles = around_[vertex];
    if (triangles.empty()) {
      ++result.unused_vertices;
      return;
    }
    bool proper = gather(vertex, triangles);
    if (proper && is_cycle(link_)) {
      for (const LinkEdge& edge : link_) result.edges += edge.from > vertex;
      return;
    }
    proper = count_edges(vertex) && proper;
    if (!proper || !is_connected()) ++result.nonmanifold_vertices;
  }

  Topology result;

 private:
  // The vertex's link; false if a triangle has two corners at one index.
  bool gather(int vertex, std::span<const int> triangles) {
    link_.clear();
    bool proper = true;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[triangles[i]];
      if (i > 0 && triangles[i] == triangles[i - 1]) continue;
      for (int corner = 0; corner < 3; ++corner) {
        if (t[corner] != vertex) continue;
        const LinkEdge edge{t[(corner + 1) % 3], t[(corner + 2) % 3]};
        proper = proper && edge.from != vertex && edge.to != vertex && edge.from != edge.to;
        link_.push_back(edge);
      }
    }
    return proper;
  }

  // Counts the vertex's edges; false if one belongs to three triangles, or two triangles share two edges.
  bool count_edges(int vertex) {
    ends_.clear();
    for (const LinkEdge& edge : link_) {
      ends_.push_back(std::uint32_t(edge.from) * 2);
      ends_.push_back(std::uint32_t(edge.to) * 2 + 1);
    }
    std::sort(ends_.begin(), ends_.end());
    neighbours_.clear();
    bool at_most_two = true;
    for (std::size_t i = 0, end; i < ends_.size(); i = end) {
      const int other = static_cast<int>(ends_[i] / 2);
      std::size_t arriving = 0;
      for (end = i; end < ends_.size() && int(ends_[end] / 2) == other; ++end) arriving += ends_[end] % 2;
      const std::size_t triangles = end - i;
      neighbours_.push_back(other);
      at_most_two = at_most_two && triangles <= 2;
      if (other < vertex) continue;
      ++result.edges;
      if (other == vertex || triangles > 2)
        ++result.nonmanifold_edges;
      else if (triangles == 1)
        ++result.boundary_edges;
      else if (arriving != 1)
        ++result.misoriented_edges;
    }
    return at_most_two && (link_.size() != 2 || neighbours_.size() > 2);
  }

  bool is_connected() {
    parent_.resize(neighbours_.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    std::size_t parts = parent_.size();
    const auto index = [&](int other) {
      return static_cast<int>(std::lower_bound(neighbours_.begin(), neighbours_.end(), other) - neighbours_.begin());
    };
    for (const LinkEdge& edge : link_) parts -= join(parent_, index(edge.from), index(edge.to));
    return parts == 1;
  }

  const Mesh& mesh_;
  const VertexTriangles& around_;
  std::vector<LinkEdge> link_;
  std::vector<std::uint32_t> ends_;  // 2 * neighbour + 1 where the triangle's edge arrives from it
  std::vector<int> neighbours_, parent_;
};

void count_links(const Mesh& mesh, Topology& result) {
  const VertexTriangles around = vertex_triangles(mesh);
  std::mutex merging;
  parallel_ranges(0, static_cast<int>(mesh.positions.size()), 1 << 13, [&](int first, int last) {
    LinkCounter counter(mesh, around);
    for (int v = first; v < last; ++v) counter.count(v);
    const std::lock_guard lock(merging);
    result.edges += counter.result.edges;
    result.boundary_edges += counter.result.boundary_edges;
    result.nonmanifold_edges += counter.result.nonmanifold_edges;
    result.misoriented_edges += counter.result.misoriented_edges;
    result.nonmanifold_vertices += counter.result.nonmanifold_vertices;
    result.unused_vertices += counter.result.unused_vertices;
  });
}

std::int64_t count_components(const Mesh& mesh, std::int64_t unused) {
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  std::int64_t components = static_cast<std::int64_t>(parent.size()) - unused;
  for (const auto& [a, b, c] : mesh.triangles) components -= join(parent, a, b) + join(parent, a, c);
  return components;
}

// A sum with the rounding of its additions kept aside (Neumaier).
struct Sum {
  double high = 0, low = 0;
  void add(double x) {
    const double next = high + x;
    low += std::abs(high) >= std::abs(x) ? (high - next) + x : (x - next) + high;
    high = next;
  }
  double value() const { return high + low; }
};

struct Measures {
  Sum area, volume;
  std::int64_t degenerate = 0;
};

// a x b, set to zero where rounding cannot tell it from zero.
Vec3 cross_or_zero(const Vec3& a, const Vec3& b) {
  constexpr double kRounding = 0x1p-51;
  const Vec3 cross = a.cross(b);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (std::abs(cross[i]) > kRounding * (std::abs(a[j] * b[k]) + std::abs(a[k] * b[j]))) return cross;
  }
  return Vec3::Zero();
}

Measures measure(const Mesh& mesh, std::size_t first, std::size_t last, const Vec3& origin) {
  Measures sums;
  for (std::size_t t = first; t < last; ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 a = mesh.positions[i] - origin, b = mesh.positions[j] - origin, c = mesh.positions[k] - origin;
    const Vec3 cross = cross_or_zero(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i]);
    sums.degenerate += cross.isZero(0);
    sums.area.add(cross.norm() / 2);
    sums.volume.add(a.dot(b.cross(c)) / 6);
  }
  return sums;
}

// Sums blocks of fixed size, then the blocks in order, so that threads cannot change the rounding.
void measure(const Mesh& mesh, Topology& result) {
  if (mesh.triangles.empty()) return;
  constexpr std::size_t kBlock = 1 << 12;
  const Vec3 origin = mesh.positions[mesh.triangles[0][0]];  // far from the world's origin, volumes would cancel
  std::vector<Measures> blocks((mesh.triangles.size() + kBlock - 1) / kBlock);
  parallel_ranges(0, static_cast<int>(blocks.size()), 1, [&](int first, int last) {
    for (std::size_t i = first; i < std::size_t(last); ++i)
      blocks[i] = measure(mesh, i * kBlock, std::min((i + 1) * kBlock, mesh.triangles.size()), origin);
  });
  Measures all;
  for (const Measures& block : blocks) {
    all.degenerate += block.degenerate;
    for (const double x : {block.area.high, block.area.low}) all.area.add(x);
    for (const double x : {block.volume.high, block.volume.low}) all.volume.add(x);
  }
  result.degenerate_triangles = all.degenerate;
  result.area = all.area.value();
  result.volume = all.volume.value();
}

std::string text_of(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

Topology topology(const Mesh& mesh) {
  Topology result;
  count_links(mesh, result);
  result.vertices = static_cast<std::int64_t>(mesh.positions.size());
  result.triangles = static_cast<std::int64_t>(mesh.triangles.size());
  result.components = count_components(mesh, result.unused_vertices);
  result.euler = result.vertices - result.unused_vertices - result.edges + result.triangles;
  result.genus = result.components - result.euler / 2;
  measure(mesh, result);
  return result;
}

std::ostream& operator<<(std::ostream& out, const Topology& t) {
  const auto line = [&](std::string name, const std::string& value) {
    name.resize(21, ' ');
    out << name << value << '\n';
  };
  line("vertices", std::to_string(t.vertices));
  line("edges", std::to_string(t.edges));
  line("triangles", std::to_string(t.triangles));
  line("boundary edges", std::to_string(t.boundary_edges));
  line("nonmanifold edges", std::to_string(t.nonmanifold_edges));
  line("misoriented edges", std::to_string(t.misoriented_edges));
  line("nonmanifold vertices", std::to_string(t.nonmanifold_vertices));
  line("unused vertices", std::to_string(t.unused_vertices));
  line("degenerate triangles", std::to_string(t.degenerate_triangles));
  line("components", std::to_string(t.components));
  line("Euler number", std::to_string(t.euler));
  line("genus", std::to_string(t.genus));
  line("area", text_of(t.area));
  line("volume", text_of(t.volume));
  line("solid", t.solid() ? "yes" : "no");
  return out;
}

}  // namespace carve
