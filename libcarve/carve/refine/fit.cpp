#include "carve/refine/fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "carve/mesh/adjacency.h"
#include "carve/refine/bending.h"
#include "carve/refine/carried.h"
#include "carve/refine/contour.h"
#include "carve/refine/features.h"
#include "carve/refine/stages.h"

namespace carve {
namespace {
using namespace refining;

constexpr double kCoarse = 0.02;     // object units: edges on which large parts are bent
constexpr double kFineEnough = 0.8;  // times kCoarse
constexpr int kGrain = 1 << 10;
constexpr double kNear = 3;           // edges from an outline within which it is pulled at or holds back
constexpr double kRimDepth = 0.2;     // edges: vertices that share a rim
constexpr double kWall = 0.35;        // edges: how near to a straight outline a wall's vertices lie
constexpr double kWallAngle = 0.985;  // cosine between a wall's normal and the outline's
constexpr double kTangential = 0.3;   // share of the way to the neighbours' middle, within the tangent plane
constexpr int kPasses = 8;            // one view's outline can drive a vertex out of another's
constexpr int kSnapRounds = 1;
constexpr double kSnapStiffness = 0.1;
constexpr int kSharpRings = 2;

class Fitting {
 public:
  Fitting(const Mesh& mesh, const ViewSet& views, const FitOptions& options)
      : start_(mesh), options_(options), edge_(mean_edge_length(mesh)), around_(vertex_triangles(mesh)) {
    for (const AlignedView& view : views.views) contours_.emplace_back(view);
    problem_.positions = mesh.positions;
    for (Vec3& p : problem_.positions) p /= edge_;
    connect();
    find_normals();
    find_held();
    find_stiffness();
  }

  Mesh operator()(int rounds, double tangential, const Monitor& monitor) {
    for (int round = 0; round < rounds + kSnapRounds; ++round) {
      monitor.at("fit", static_cast<double>(round) / (rounds + kSnapRounds));
      // At the end the rims go where they belong, whatever that bends.
      if (round == rounds)
        for (double& stiffness : problem_.stiffness) stiffness *= kSnapStiffness;
      find_normals();
      find_curvature();
      find_pulls();
      move(solve(problem_), tangential);
    }
    Mesh result = start_;
    for (int v = 0; v < count(); ++v) result.positions[v] = edge_ * problem_.positions[v];
    return result;
  }

 private:
  int count() const { return static_cast<int>(problem_.positions.size()); }
  Vec3 world(int v) const { return edge_ * problem_.positions[v]; }
  template <class Body>
  void each(Body&& body) const {
    parallel_ranges(0, count(), kGrain, [&](int first, int last) {
      for (int v = first; v < last; ++v) body(v);
    });
  }
  template <class Body>
  void each_neighbour(int v, Body&& body) const {
    for (std::uint32_t i = problem_.first[v]; i < problem_.first[v + 1]; ++i) body(problem_.neighbours[i]);
  }

  void connect() {
    problem_.first = {0};
    for (int v = 0; v < count(); ++v) {
      for (const int t : around_[v])  // a solid: each neighbour comes after v in one triangle
        for (int k = 0; k < 3; ++k)
          if (start_.triangles[t][k] == v) problem_.neighbours.push_back(start_.triangles[t][(k + 1) % 3]);
      problem_.first.push_back(static_cast<std::uint32_t>(problem_.neighbours.size()));
    }
    problem_.normals.resize(count());
    problem_.curvature.resize(count());
    problem_.held.resize(count());
  }

  Vec3 area_normal(int triangle) const {
    const auto& [a, b, c] = start_.triangles[triangle];
    const auto& p = problem_.positions;
    return (p[b] - p[a]).cross(p[c] - p[a]);
  }

  void find_normals() {
    each([&](int v) {
      Vec3 sum = Vec3::Zero();
      for (const int t : around_[v]) sum += area_normal(t);
      problem_.normals[v] = sum.stableNormalized();
    });
  }

  /// Where the surface bends by more than options.crease within kSharpRings.
  std::vector<std::uint8_t> sharp() const {
    const double lowest = std::cos(options_.crease * M_PI / 180);
    std::vector<std::uint8_t> result(count());
    each([&](int v) {
      std::vector<int> ring = {v};
      for (int k = 0; k < kSharpRings; ++k) {
        const std::size_t size = ring.size();
        for (std::size_t i = 0; i < size; ++i)
          each_neighbour(ring[i], [&](int other) {
            if (std::find(ring.begin(), ring.end(), other) == ring.end()) ring.push_back(other);
          });
      }
      for (const int a : ring)
        for (const int b : ring) result[v] |= problem_.normals[a].dot(problem_.normals[b]) < lowest;
    });
    return result;
  }

  /// Walls, and the sharp edges around them; sharp edges that a stroke draws.
  void find_held() {
    const auto is_sharp = sharp();
    std::vector<std::uint8_t> wall(count()), near_wall;
    each([&](int v) {
      for (const Contour& contour : contours_) {
        const Nearest at = contour.nearest(world(v));
        const Vec2 normal = contour.project(problem_.normals[v]);
        if (std::abs(at.distance) < kWall * edge_ && contour.straight(at.piece) && normal.dot(at.outward) > kWallAngle)
          wall[v] = 1;
        if (is_sharp[v] && contour.on_stroke(world(v))) problem_.held[v] = 1;
      }
    });
    near_wall = wall;
    for (int ring = 0; ring < kSharpRings + 1; ++ring) {
      const auto before = near_wall;
      each([&](int v) { each_neighbour(v, [&](int other) { near_wall[v] |= before[other]; }); });
    }
    for (int v = 0; v < count(); ++v) problem_.held[v] |= wall[v] | (near_wall[v] & is_sharp[v]);
  }

  /// Squares of the lengths in edges over which the surface is bent: a share of how thick the views show it there.
  void find_stiffness() {
    problem_.stiffness.resize(count());
    each([&](int v) {
      double radius = 1;
      for (const Contour& contour : contours_)
        radius = std::min(radius, contour.radius(contour.nearest(world(v)).piece));
      problem_.stiffness[v] = std::pow(options_.bend * radius / edge_, 2);
    });
  }

  /// The surface's curvature, evened out over these lengths.
  void find_curvature() {
    std::vector<double> now(count()), next(count());
    each([&](int v) { now[v] = umbrella_curvature(problem_, v); });
    const double steps = std::ceil(*std::max_element(problem_.stiffness.begin(), problem_.stiffness.end()));
    for (int step = 0; step < steps; ++step) {
      each([&](int v) {
        double sum = now[v], weight = 1;
        each_neighbour(v, [&](int other) {
          if (!problem_.held[other]) sum += now[other], weight += 1;
        });
        next[v] = problem_.held[v] || step > problem_.stiffness[v] ? now[v] : sum / weight;
      });
      now.swap(next);
    }
    problem_.curvature = now;
  }

  void find_pulls() {
    problem_.pulls.clear();
    std::vector<Nearest> at(count());
    for (const Contour& contour : contours_) {
      each([&](int v) { at[v] = contour.nearest(world(v)); });
      add_pulls(contour, at);
    }
  }

  /// The outermost vertices along each stretch of the outline, an edge long, are the surface's rim.
  void add_pulls(const Contour& contour, const std::vector<Nearest>& at) {
    std::vector<int> stretch(contour.pieces());
    double length = 0;
    for (int piece = 0; piece < contour.pieces(); ++piece) {
      stretch[piece] = static_cast<int>(length);
      length += contour.length(piece) / edge_;
    }
    std::vector<double> outermost(static_cast<std::size_t>(length) + 1, -kNear), sum(outermost.size());
    const auto rim_weight = [&](int v) {
      const int i = stretch[at[v].piece];
      const double depth = (outermost[i] - at[v].distance / edge_) / kRimDepth;
      return depth < 3 && outermost[i] > -kNear ? std::exp(-depth) : 0.0;
    };
    for (int v = 0; v < count(); ++v) {
      double& most = outermost[stretch[at[v].piece]];
      most = std::max(most, at[v].distance / edge_);
    }
    for (int v = 0; v < count(); ++v) sum[stretch[at[v].piece]] += rim_weight(v);
    for (int v = 0; v < count(); ++v)
      if (const double weight = rim_weight(v); weight > 0)
        problem_.pulls.push_back({v, at[v].distance / edge_, at[v].outward.dot(contour.project(problem_.normals[v])),
                                  weight / sum[stretch[at[v].piece]]});
  }

  void move(const std::vector<double>& offsets, double tangential) {
    std::vector<Vec3> moved = problem_.positions;
    each([&](int v) {
      if (problem_.held[v]) return;
      Vec3 middle = Vec3::Zero();
      each_neighbour(v, [&](int other) { middle += problem_.positions[other] - problem_.positions[v]; });
      middle /= problem_.first[v + 1] - problem_.first[v];
      const Vec3& normal = problem_.normals[v];
      moved[v] += offsets[v] * normal + tangential * (middle - normal.dot(middle) * normal);
    });
    problem_.positions = moved;
    each([&](int v) {
      if (!problem_.held[v]) problem_.positions[v] = inside_hull(v);
    });
  }

  /// Back onto the outlines that the vertex left.
  Vec3 inside_hull(int v) const {
    Vec3 p = world(v);
    for (int pass = 0; pass < kPasses; ++pass) {
      bool inside = true;
      for (const Contour& contour : contours_) {
        const Nearest at = contour.nearest(p);
        if (at.distance <= 0) continue;
        inside = false;
        contour.shift(p, -at.distance * at.outward);
      }
      if (inside) break;
    }
    return p / edge_;
  }

  const Mesh& start_;
  const FitOptions options_;
  const double edge_;  // mean length, the unit of all that follows
  const VertexTriangles around_;
  std::vector<Contour> contours_;
  BendingProblem problem_;
};

}  // namespace

Mesh fit(const Mesh& mesh, const ViewSet& views, const FitOptions& options, const Monitor& monitor) {
  check("refine", options);
  check_mesh(mesh);
  if (mesh.triangles.empty() || options.rounds == 0) return mesh;
  if (mean_edge_length(mesh) > kFineEnough * kCoarse)
    return Fitting(mesh, views, options)(options.rounds, kTangential, monitor);
  const Mesh coarse = remesh(mesh, {.edge_length = kCoarse});
  const Mesh bent = Fitting(coarse, views, options)(options.rounds, 0, monitor);
  const Mesh carried = refining::carried(mesh, coarse, bent, 2 * kCoarse);
  return Fitting(carried, views, options)(options.rounds, kTangential, monitor);
}

}  // namespace carve
