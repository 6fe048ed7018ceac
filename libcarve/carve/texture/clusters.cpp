#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>
#include <tuple>
#include <utility>

#include "carve/core/options.h"
#include "carve/mesh/neighbours.h"
#include "carve/texture/atlas.h"
#include "carve/texture/chart_uvs.h"
#include "carve/texture/unfold.h"

namespace carve {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Half the angle of the cone that holds a chart's normals: of charts that may be unfolded, and of those that project.
constexpr double kWide = 120 * kDegree, kSteepest = 75 * kDegree;
constexpr double kDistorted = 5;        // symmetric Dirichlet energy above which a wide chart is cut up again
constexpr double kCompactness = 0.002;  // object units that a circle's roundness is worth

// What is known of a set of triangles without looking at them again.
struct Patch {
  double area = 0, perimeter = 0;
  Vec3 first = Vec3::Zero();                         // integral of the position
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // integral of its square
  Vec3 axis = Vec3::Zero();                          // of a cone that holds all normals
  double angle = 0;

  double distance() const {  // root mean square from the best plane
    const Vec3 mean = first / area;
    const Eigen::Matrix3d covariance = second / area - mean * mean.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  }
};

void join_cones(const Patch& a, const Patch& b, Patch& joined) {
  const double between = std::acos(std::clamp(a.axis.dot(b.axis), -1.0, 1.0));
  if (between + b.angle <= a.angle) {
    joined.axis = a.axis, joined.angle = a.angle;
  } else if (between + a.angle <= b.angle) {
    joined.axis = b.axis, joined.angle = b.angle;
  } else {
    joined.angle = (between + a.angle + b.angle) / 2;
    const Vec3 aside = b.axis - a.axis.dot(b.axis) * a.axis;
    const double turn = joined.angle - a.angle;
    joined.axis = aside.norm() > 1e-12 ? Vec3(std::cos(turn) * a.axis + std::sin(turn) * aside.normalized()) : a.axis;
  }
}

Patch joined(const Patch& a, const Patch& b, double shared) {
  Patch sum;
  sum.area = a.area + b.area;
  sum.perimeter = a.perimeter + b.perimeter - 2 * shared;
  sum.first = a.first + b.first;
  sum.second = a.second + b.second;
  join_cones(a, b, sum);
  return sum;
}

class Clustering {
 public:
  // Joins triangles of one group; those of a negative group stay alone.
  Clustering(const Mesh& mesh, const AtlasOptions& options, double widest, const std::vector<int>& group)
      : mesh_(mesh), options_(options), widest_(widest) {
    const std::vector<Vec3> normals = triangle_normals(mesh);
    const auto neighbours = triangle_neighbours(mesh);
    const int count = static_cast<int>(mesh.triangles.size());
    patches_.resize(count), beside_.resize(count), version_.resize(count), parent_.resize(count);
    for (int t = 0; t < count; ++t) {
      parent_[t] = t;
      add_triangle(t, normals[t]);
      for (int k = 0; k < 3; ++k)
        if (const int other = neighbours[t][k]; other >= 0 && group[t] >= 0 && group[t] == group[other])
          beside_[t][other] += edge(t, k);
    }
    for (int t = 0; t < count; ++t)
      for (const auto& [other, shared] : beside_[t])
        if (other > t) offer(t, other, shared);
  }

  // Per triangle its cluster's first triangle; the plane's normal of each cluster in `normals`.
  std::vector<int> run(int most, std::vector<Vec3>& normals) {
    int left = static_cast<int>(patches_.size());
    while (left > most && !offers_.empty()) {
      const Offer offer = offers_.top();
      offers_.pop();
      if (offer.version_a != version_[offer.a] || offer.version_b != version_[offer.b]) continue;
      join(offer.a, offer.b);
      --left;
    }
    std::vector<int> root(parent_.size());
    normals.resize(parent_.size());
    for (int t = 0; t < static_cast<int>(root.size()); ++t) {
      root[t] = find(t);
      normals[root[t]] = patches_[root[t]].axis;
    }
    return root;
  }

 private:
  struct Offer {
    double cost;
    int a, b, version_a, version_b;
    bool operator<(const Offer& o) const { return std::tie(cost, a, b) > std::tie(o.cost, o.a, o.b); }
  };

  double edge(int t, int k) const {
    return (mesh_.positions[mesh_.triangles[t][k]] - mesh_.positions[mesh_.triangles[t][(k + 1) % 3]]).norm();
  }

  void add_triangle(int t, const Vec3& normal) {
    Patch& patch = patches_[t];
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh_.positions[mesh_.triangles[t][k]];
      sum += p;
      patch.second += p * p.transpose();
      patch.perimeter += edge(t, k);
    }
    const Vec3& origin = mesh_.positions[mesh_.triangles[t][0]];
    patch.area = (mesh_.positions[mesh_.triangles[t][1]] - origin)
                     .cross(mesh_.positions[mesh_.triangles[t][2]] - origin)
                     .norm() /
                 2;
    patch.area = std::max(patch.area, 1e-16);
    patch.first = patch.area / 3 * sum;
    patch.second = patch.area / 12 * (patch.second + sum * sum.transpose());
    patch.axis = normal;
  }

  void offer(int a, int b, double shared) {
    const Patch both = joined(patches_[a], patches_[b], shared);
    if (both.angle > widest_) return;
    const double distance = both.distance();
    if (distance > options_.max_distortion) return;
    const double roundness = both.perimeter * both.perimeter / (4 * std::numbers::pi * both.area);
    offers_.push({distance + kCompactness * roundness, a, b, version_[a], version_[b]});
  }

  // The patch with more neighbours keeps its number.
  void join(int a, int b) {
    if (beside_[a].size() < beside_[b].size()) std::swap(a, b);
    patches_[a] = joined(patches_[a], patches_[b], beside_[a][b]);
    parent_[b] = a;
    ++version_[a], ++version_[b];
    for (const auto& [other, shared] : beside_[b]) {
      if (other == a) continue;
      beside_[other].erase(b);
      beside_[other][a] += shared;
      beside_[a][other] += shared;
    }
    beside_[a].erase(b);
    beside_[b].clear();
    for (const auto& [other, shared] : beside_[a]) offer(std::min(a, other), std::max(a, other), shared);
  }

  int find(int t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }

  const Mesh& mesh_;
  const AtlasOptions& options_;
  double widest_;
  std::vector<Patch> patches_;
  std::vector<std::map<int, double>> beside_;  // neighbours, by the length of the border with them
  std::vector<int> version_, parent_;
  std::priority_queue<Offer> offers_;
};

// Charts of the clusters that `root` tells, projected along their normals.
Charts projected(const Mesh& mesh, const std::vector<int>& root, const std::vector<Vec3>& normals, double density) {
  std::vector<int> number(root.size(), -1);
  Charts charts;
  charts.chart.resize(root.size());
  for (std::size_t t = 0; t < root.size(); ++t) {
    if (number[root[t]] < 0) number[root[t]] = charts.count++;
    charts.chart[t] = number[root[t]];
  }
  share_corners(mesh, charts, [&](int triangle, int vertex) {
    const Vec3 normal = normals[root[triangle]].isZero() ? Vec3(Vec3::UnitZ()) : normals[root[triangle]];
    const Vec3 aside = std::abs(normal.y()) < 0.9 ? Vec3(Vec3::UnitY()) : Vec3(-Vec3::UnitZ());
    const Vec3 right = aside.cross(normal).normalized(), up = normal.cross(right);
    return Vec2(density * mesh.positions[vertex].dot(right), -density * mesh.positions[vertex].dot(up));
  });
  charts.height.resize(root.size());
  for (std::size_t t = 0; t < root.size(); ++t)
    for (const int v : mesh.triangles[t]) charts.height[t] += mesh.positions[v].dot(normals[root[t]]);
  return charts;
}

}  // namespace

Charts cluster_charts(const Mesh& mesh, const ViewSet& views, const AtlasOptions& options) {
  check("atlas", options);
  double density = 0;  // a texel is a pixel
  for (const AlignedView& view : views.views)
    density = std::max({density, std::abs(view.column_per_unit), std::abs(view.row_per_unit)});
  std::vector<Vec3> normals;
  std::vector<int> root =
      Clustering(mesh, options, kWide, std::vector<int>(mesh.triangles.size())).run(options.max_clusters, normals);
  Charts charts = projected(mesh, root, normals, density);
  const std::vector<double> energies = unfold(mesh, density, charts);
  if (std::ranges::all_of(energies, [](double energy) { return energy <= kDistorted; })) return charts;

  std::vector<int> again(root.size(), -1);
  for (std::size_t t = 0; t < root.size(); ++t)
    if (energies[charts.chart[t]] > kDistorted) again[t] = charts.chart[t];
  std::vector<Vec3> narrow_normals;
  const std::vector<int> narrow = Clustering(mesh, options, kSteepest, again).run(1, narrow_normals);
  for (std::size_t t = 0; t < root.size(); ++t)
    if (again[t] >= 0) root[t] = narrow[t], normals[root[t]] = narrow_normals[root[t]];
  charts = projected(mesh, root, normals, density);
  unfold(mesh, density, charts);
  return charts;
}

}  // namespace carve
