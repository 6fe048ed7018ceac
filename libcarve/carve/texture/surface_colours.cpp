#include "carve/texture/surface_colours.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <unordered_map>

#include "carve/mesh/adjacency.h"

namespace carve {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

bool painted(const Paint& paint) {
  return std::ranges::any_of(paint, [](const Layer& layer) { return layer.weight > 0; });
}

// The two sides of seams as a graph: a node is a vertex as one patch has it.
class SeamGraph {
 public:
  struct Node {
    int vertex, triangle, distance;  // a triangle of the patch; distance in edges from the seam
  };
  struct Seam {
    int a, b;
    Colour difference;  // from a to b
  };
  SeamGraph(const Mesh& mesh, const VertexTriangles& around, const std::vector<int>& patch)
      : mesh_(mesh), around_(around), patch_(patch) {}

  int add(int vertex, int triangle, int distance) {
    const std::uint64_t key = std::uint64_t(vertex) << 32 | static_cast<std::uint32_t>(patch_[triangle]);
    const auto [place, is_new] = index_.try_emplace(key, static_cast<int>(nodes.size()));
    if (is_new) nodes.push_back({vertex, triangle, distance});
    return place->second;
  }
  int find(int vertex, int triangle) const {
    const auto found = index_.find(std::uint64_t(vertex) << 32 | static_cast<std::uint32_t>(patch_[triangle]));
    return found == index_.end() ? -1 : found->second;
  }
  // Calls visit(vertex, triangle) for the vertices that the node's patch joins to it by an edge, most of them twice.
  template <class Visit>
  void for_each_neighbour(const Node& node, const Visit& visit) const {
    for (const int t : around_[node.vertex])
      if (patch_[t] == patch_[node.triangle])
        for (const int v : mesh_.triangles[t])
          if (v != node.vertex) visit(v, t);
  }
  void grow(int reach) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Node node = nodes[i];
      if (node.distance < reach) for_each_neighbour(node, [&](int v, int t) { add(v, t, node.distance + 1); });
    }
  }

  std::vector<Node> nodes;
  std::vector<Seam> seams;

 private:
  const Mesh& mesh_;
  const VertexTriangles& around_;
  const std::vector<int>& patch_;
  std::unordered_map<std::uint64_t, int> index_;
};

class SurfaceColours {
 public:
  SurfaceColours(const Mesh& mesh, const std::vector<Paint>& paints, const std::vector<int>& patch,
                 const Drawings& drawings)
      : mesh_(mesh), paints_(paints), patch_(patch), drawings_(drawings), around_(vertex_triangles(mesh)) {
    result_.corners.assign(mesh.triangles.size(), {-1, -1, -1});
  }

  void fill();
  void level(double largest);
  CornerColours take() { return std::move(result_); }

 private:
  Colour seen_at(int vertex) const;
  void spread(const std::vector<int>& vertices, const std::vector<int>& index, const std::vector<char>& known,
              Columns& colours) const;
  void find_seams(double largest, SeamGraph& graph) const;
  void add_to_corners(const SeamGraph& graph, int base);

  const Mesh& mesh_;
  const std::vector<Paint>& paints_;
  const std::vector<int>& patch_;
  const Drawings& drawings_;
  VertexTriangles around_;
  CornerColours result_;
};

// The mean of what the vertex's patches show there; each counts once.
Colour SurfaceColours::seen_at(int vertex) const {
  Colour sum = Colour::Zero();
  std::vector<int> done;
  for (const int t : around_[vertex]) {
    if (!painted(paints_[t]) || std::ranges::find(done, patch_[t]) != done.end()) continue;
    done.push_back(patch_[t]);
    sum += drawings_.at(paints_[t], mesh_.positions[vertex]);
  }
  return sum / static_cast<float>(done.size());
}

Columns solve(const Matrix& matrix, const Columns& right) {
  Eigen::SimplicialLDLT<Matrix> solver(matrix);
  return solver.solve(right);
}

void SurfaceColours::fill() {
  // Vertices of triangles without paint: known where paint touches them.
  std::vector<int> index(mesh_.positions.size(), -1), vertices;
  for (std::size_t t = 0; t < paints_.size(); ++t) {
    if (painted(paints_[t])) continue;
    for (int k = 0; k < 3; ++k) {
      int& i = index[mesh_.triangles[t][k]];
      if (i < 0) i = static_cast<int>(vertices.size()), vertices.push_back(mesh_.triangles[t][k]);
      result_.corners[t][k] = i;
    }
  }
  const int count = static_cast<int>(vertices.size());
  if (count == 0) return;
  std::vector<char> known(count);
  Columns right = Columns::Zero(count, 3);
  for (int i = 0; i < count; ++i) {
    known[i] = std::ranges::any_of(around_[vertices[i]], [&](int t) { return painted(paints_[t]); });
    if (known[i]) right.row(i) = seen_at(vertices[i]).cast<double>().transpose();
  }
  spread(vertices, index, known, right);
  for (int i = 0; i < count; ++i) result_.colours.emplace_back(right.row(i).transpose().cast<float>());
}

// Unknown colours become those of the nearest known vertex along the surface; then rounds of means over neighbours that
// differ little even out streaks and leave borders between flat colours sharp, as drawn.
void SurfaceColours::spread(const std::vector<int>& vertices, const std::vector<int>& index,
                            const std::vector<char>& known, Columns& colours) const {
  constexpr int kRounds = 40;
  constexpr double kUpright = 6;   // how much nearer is what is as high than what is above or below
  constexpr double kSimilar = 24;  // RGB distance
  const int count = static_cast<int>(vertices.size());
  // Per vertex the next corners of the triangles around it; of a closed surface each neighbour once.
  std::vector<int> first(count + 1), beside;
  for (int i = 0; i < count; ++i) {
    first[i] = static_cast<int>(beside.size());
    for (const int t : around_[vertices[i]]) {
      const Triangle& corners = mesh_.triangles[t];
      const int k = corners[0] == vertices[i] ? 0 : corners[1] == vertices[i] ? 1 : 2;
      if (const int j = index[corners[(k + 1) % 3]]; j >= 0) beside.push_back(j);
    }
  }
  first[count] = static_cast<int>(beside.size());

  std::vector<double> distance(count, std::numeric_limits<double>::infinity());
  std::vector<int> source(count, -1);
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  for (int i = 0; i < count; ++i)
    if (known[i]) distance[i] = 0, source[i] = i, open.emplace(0.0, i);
  while (!open.empty()) {
    const auto [here, i] = open.top();
    open.pop();
    if (here > distance[i]) continue;
    for (int e = first[i]; e < first[i + 1]; ++e) {
      const int j = beside[e];
      Vec3 step = mesh_.positions[vertices[i]] - mesh_.positions[vertices[j]];
      step.y() *= kUpright;
      const double there = here + step.norm();
      if (there >= distance[j]) continue;
      distance[j] = there, source[j] = source[i];
      open.emplace(there, j);
    }
  }
  const Eigen::RowVector3d mean = drawings_.mean().cast<double>().transpose();
  for (int i = 0; i < count; ++i) colours.row(i) = source[i] < 0 ? mean : Eigen::RowVector3d(colours.row(source[i]));

  Columns next = colours;
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < count; ++i) {
      if (known[i]) continue;
      Eigen::RowVector3d sum = colours.row(i);
      double weight = 1;
      for (int e = first[i]; e < first[i + 1]; ++e) {
        const double off = (colours.row(beside[e]) - colours.row(i)).squaredNorm() / (kSimilar * kSimilar);
        const double w = 1 / (1 + off * off);
        sum += w * colours.row(beside[e]), weight += w;
      }
      next.row(i) = sum / weight;
    }
    colours.swap(next);
  }
}

void SurfaceColours::find_seams(double largest, SeamGraph& graph) const {
  struct Side {
    int triangle;
    Colour colour;
  };
  std::vector<Side> sides;
  for (int v = 0; v < static_cast<int>(mesh_.positions.size()); ++v) {
    const auto triangles = around_[v];
    if (std::ranges::all_of(triangles, [&](int t) { return patch_[t] == patch_[triangles[0]]; })) continue;
    sides.clear();
    for (const int t : triangles)
      if (painted(paints_[t]) &&
          std::ranges::none_of(sides, [&](const Side& s) { return patch_[s.triangle] == patch_[t]; }))
        sides.push_back({t, drawings_.at(paints_[t], mesh_.positions[v])});
    for (std::size_t i = 0; i < sides.size(); ++i)
      for (std::size_t j = i + 1; j < sides.size(); ++j) {
        const Colour difference = sides[j].colour - sides[i].colour;
        if (difference.norm() > largest) continue;
        const int a = graph.add(v, sides[i].triangle, 0), b = graph.add(v, sides[j].triangle, 0);
        graph.seams.push_back({a, b, difference});
      }
  }
}

void SurfaceColours::level(double largest) {
  constexpr int kReach = 6;       // edges; beyond, nothing changes
  constexpr double kSeam = 100;   // how much more a seam weighs than an edge
  constexpr double kStay = 0.05;  // pull to no change: patches that are nothing but seams stay about where they are
  SeamGraph graph(mesh_, around_, patch_);
  find_seams(largest, graph);
  if (std::ranges::all_of(graph.seams, [](const SeamGraph::Seam& s) { return s.difference.isZero(); })) return;
  graph.grow(kReach);
  const int count = static_cast<int>(graph.nodes.size());
  const auto free = [&](int i) { return graph.nodes[i].distance < kReach; };
  std::vector<Eigen::Triplet<double>> entries;
  Columns right = Columns::Zero(count, 3);
  for (int i = 0; i < count; ++i) {
    if (!free(i)) {
      entries.emplace_back(i, i, 1);
      continue;
    }
    entries.emplace_back(i, i, kStay);
    graph.for_each_neighbour(graph.nodes[i], [&](int v, int t) {
      const int j = graph.find(v, t);
      entries.emplace_back(i, i, 1);
      if (free(j)) entries.emplace_back(i, j, -1);
    });
  }
  for (const auto& [a, b, difference] : graph.seams) {
    for (const int i : {a, b}) entries.emplace_back(i, i, kSeam);
    entries.emplace_back(a, b, -kSeam), entries.emplace_back(b, a, -kSeam);
    right.row(a) += kSeam * difference.cast<double>().transpose();
    right.row(b) -= kSeam * difference.cast<double>().transpose();
  }
  Matrix matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Columns solution = solve(matrix, right);
  const int base = static_cast<int>(result_.colours.size());
  for (int i = 0; i < count; ++i) result_.colours.emplace_back(solution.row(i).transpose().cast<float>());
  add_to_corners(graph, base);
}

// Triangles near a seam get their corners' offsets; corners beyond the graph get none.
void SurfaceColours::add_to_corners(const SeamGraph& graph, int base) {
  for (const SeamGraph::Node& node : graph.nodes)
    for (const int t : around_[node.vertex])
      if (patch_[t] == patch_[node.triangle])
        for (int k = 0; k < 3; ++k)
          if (mesh_.triangles[t][k] == node.vertex)
            result_.corners[t][k] = base + static_cast<int>(&node - graph.nodes.data());
}

}  // namespace

CornerColours surface_colours(const Mesh& mesh, const std::vector<Paint>& paints, const std::vector<int>& patch,
                              const Drawings& drawings, double level) {
  SurfaceColours colours(mesh, paints, patch, drawings);
  colours.fill();
  colours.level(level);
  return colours.take();
}

}  // namespace carve
