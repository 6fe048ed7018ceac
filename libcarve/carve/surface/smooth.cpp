#include "carve/surface/smooth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <stdexcept>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "carve/mesh/adjacency.h"
#include "carve/mesh/self_intersections.h"

namespace carve {
namespace {

constexpr int kGrain = 1 << 12;
constexpr double kInwards = 0.5, kOutwards = 1 / (0.1 - 1 / kInwards);  // 1 / inwards + 1 / outwards = 0.1

// The one-ring of each vertex: its neighbours, once each.
struct Rings {
  std::vector<int> sizes;
  std::vector<int> neighbours;  // room for two a triangle around the vertex: of fans that are not closed
};

void collect_ring(const Mesh& mesh, std::span<const int> triangles, int vertex, std::vector<int>& ring) {
  constexpr std::size_t kFew = 32;  // searching is quadratic, but faster for as few as most vertices have
  ring.clear();
  const auto add = [&](int other) {
    if (other != vertex && (ring.size() > kFew || std::find(ring.begin(), ring.end(), other) == ring.end()))
      ring.push_back(other);
  };
  for (const int t : triangles)
    for (const int other : mesh.triangles[t]) add(other);
  if (ring.size() <= kFew) return;
  std::sort(ring.begin(), ring.end());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
}

Rings one_rings(const Mesh& mesh, const VertexTriangles& around) {
  Rings rings{std::vector<int>(mesh.positions.size()), std::vector<int>(2 * around.triangles.size())};
  parallel_ranges(0, static_cast<int>(rings.sizes.size()), kGrain, [&](int first, int last) {
    std::vector<int> ring;
    for (int v = first; v < last; ++v) {
      collect_ring(mesh, around[v], v, ring);
      rings.sizes[v] = static_cast<int>(ring.size());
      std::copy(ring.begin(), ring.end(), rings.neighbours.begin() + 2 * std::size_t{around.first[v]});
    }
  });
  return rings;
}

std::vector<Vec3> unit_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.triangles.size());
  parallel_ranges(0, static_cast<int>(normals.size()), kGrain, [&](int first, int last) {
    for (int t = first; t < last; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3& origin = mesh.positions[a];
      normals[t] = (mesh.positions[b] - origin).cross(mesh.positions[c] - origin).stableNormalized();
    }
  });
  return normals;
}

// 1 for the vertices on an edge whose triangles' normals differ by more than `level` degrees.
std::vector<std::uint8_t> sharp_vertices(const Mesh& mesh, const VertexTriangles& around, double level) {
  constexpr double kRounding = 1e-12;  // a right angle is not sharper than 90 degrees
  const double lowest = std::cos(level * std::numbers::pi / 180) - kRounding;
  const std::vector<Vec3> normals = unit_normals(mesh);
  std::vector<std::uint8_t> sharp(mesh.positions.size());
  parallel_ranges(0, static_cast<int>(sharp.size()), kGrain, [&](int first, int last) {
    std::vector<std::pair<int, int>> spokes;  // neighbour, triangle
    for (int v = first; v < last; ++v) {
      spokes.clear();
      for (const int t : around[v])
        for (const int other : mesh.triangles[t])
          if (other != v) spokes.emplace_back(other, t);
      std::sort(spokes.begin(), spokes.end());
      for (std::size_t i = 1; i < spokes.size(); ++i) {
        const Vec3 &a = normals[spokes[i - 1].second], &b = normals[spokes[i].second];
        // Without area there is no normal, and no angle.
        if (spokes[i - 1].first == spokes[i].first && !a.isZero(0) && !b.isZero(0) && a.dot(b) < lowest) sharp[v] = 1;
      }
    }
  });
  return sharp;
}

/// The part of a step that a guide allows.
Vec3 guided(const Vec3& step, const Guide& guide) {
  const Vec3 axis = guide.axis.cast<double>();
  switch (guide.kind) {
    case Guide::Kind::plane:
      return step - axis.dot(step) * axis;
    case Guide::Kind::line:
      return axis.dot(step) * axis;
    case Guide::Kind::fixed:
      return Vec3::Zero();
    default:
      return step;
  }
}

void take_steps(Mesh& mesh, const VertexTriangles& around, const SmoothOptions& options, const Monitor& monitor,
                const Guide* guide) {
  // Found once: what is sharp in the input stays, however the steps bend its surroundings.
  const std::vector<std::uint8_t> sharp = options.level < 180 ? sharp_vertices(mesh, around, options.level)
                                                              : std::vector<std::uint8_t>(mesh.positions.size());
  const Rings rings = one_rings(mesh, around);
  std::vector<Vec3> moved(mesh.positions.size());
  const auto move = [&](double share) {
    parallel_ranges(0, static_cast<int>(moved.size()), kGrain, [&](int first, int last) {
      for (int v = first; v < last; ++v) {
        const Vec3& position = mesh.positions[v];
        const std::span ring(rings.neighbours.data() + 2 * std::size_t{around.first[v]}, sharp[v] ? 0 : rings.sizes[v]);
        // Summing differences, as Equation 3.7 does, keeps planes exactly plane.
        Vec3 sum = Vec3::Zero();
        for (const int other : ring) sum += mesh.positions[other] - position;
        if (!ring.empty()) sum *= share / static_cast<double>(ring.size());
        moved[v] = position + (guide ? guided(sum, guide[v]) : sum);
      }
    });
    mesh.positions.swap(moved);
  };
  for (int step = 0; step < options.steps; ++step) {
    monitor.at("smooth", static_cast<double>(step) / options.steps);
    if (options.method == Smoothing::laplacian) {
      move(1);
    } else {
      move(kInwards);
      move(kOutwards);
    }
  }
}

/// Puts vertices of triangles that meet back to where they were `before`, half the way first, until no more meet than
/// did there.
void mend(Mesh& mesh, const std::vector<Vec3>& before, const VertexTriangles& around) {
  constexpr double kStill = 1e-12;  // of a coordinate: what rounding moves stays
  std::vector<std::uint8_t> moved(before.size()), tries(before.size());
  parallel_ranges(0, static_cast<int>(moved.size()), kGrain, [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      const double largest = before[v].cwiseAbs().maxCoeff();
      moved[v] = (mesh.positions[v] - before[v]).cwiseAbs().maxCoeff() > kStill * largest;
      if (!moved[v]) mesh.positions[v] = before[v];
    }
  });
  auto meeting = self_intersections(mesh, around, moved, true);
  if (meeting.empty()) return;
  std::ranges::fill(moved, 0);
  // From here on few vertices move, but often one after the other along a thin sheet.
  const TriangleGrid grid(mesh, before);
  for (std::vector<int> back; !meeting.empty(); back.clear()) {
    for (const auto& [i, j] : meeting)
      for (const int t : {i, j})
        for (const int v : mesh.triangles[t])
          if (!moved[v] && mesh.positions[v] != before[v]) {
            mesh.positions[v] = tries[v]++ ? before[v] : Vec3((mesh.positions[v] + before[v]) / 2);
            moved[v] = 1;
            back.push_back(v);
          }
    meeting = self_intersections(mesh, around, grid, back, true);
    for (const int v : back) moved[v] = 0;
  }
}

}  // namespace

Mesh smooth(Mesh mesh, const SmoothOptions& options, const Monitor& monitor, const Guides& guides) {
  check("smooth", options);
  if (options.keep && !guides.empty() && guides.size() != mesh.positions.size())
    throw std::invalid_argument("smooth: guides must be as many as the mesh's vertices");
  if (options.steps == 0 || options.level == 0) return mesh;
  const VertexTriangles around = vertex_triangles(mesh);
  const std::vector<Vec3> before = options.mend ? mesh.positions : std::vector<Vec3>();
  take_steps(mesh, around, options, monitor, options.keep && !guides.empty() ? guides.data() : nullptr);
  if (options.mend) mend(mesh, before, around);
  monitor.at("smooth", 1);
  return mesh;
}

}  // namespace carve
