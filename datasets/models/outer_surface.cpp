#include "models/outer_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "models/ray_scene.h"
#include "models/shells.h"
#include "models/winding.h"

namespace carve {
namespace {

using Corners = std::array<Vec3, 3>;

// A closed shell: what is inside it cannot be seen.
struct Cover {
  int shell;
  Vec3 low, high;
  WindingNumber winding;
};

class Watch {
 public:
  Watch(const Mesh& mesh, const OuterSurfaceOptions& options) : scene_(mesh) {
    const std::vector<Mesh> parts = shells(mesh);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!winds_whole(parts[i])) continue;
      const auto [low, high] = bounds(parts[i]);
      covers_.push_back({static_cast<int>(i), low, high, WindingNumber(parts[i])});
    }
    const auto [low, high] = bounds(mesh);
    finest_ = options.finest / 100 * (high - low).norm();
    lift_ = 1e-5 * (high - low).norm();
    // A Fibonacci lattice: even over the sphere for any count.
    const double golden = (1 + std::sqrt(5.0)) / 2;
    for (int i = 0; i < options.directions; ++i) {
      const double z = 1 - (2 * i + 1.0) / options.directions, angle = 2 * std::numbers::pi * i / golden;
      const double r = std::sqrt(1 - z * z);
      directions_.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }

  // The seen pieces of a triangle.
  void seen_of(const Corners& t, int shell, std::vector<Corners>& out) const {
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    if (normal.allFinite() && normal != Vec3::Zero()) pieces({t, normal, shell}, out);
  }

 private:
  struct Piece {
    Corners corners;
    Vec3 normal;
    int shell;
  };
  enum class Answer { none, some, all };

  void pieces(const Piece& piece, std::vector<Corners>& out) const {
    const Corners& t = piece.corners;
    const Answer answer = look(piece);
    if (answer == Answer::all) out.push_back(t);
    if (answer != Answer::some) return;
    // Through the middle of the longest edge.
    int k = 0;
    for (int i = 1; i < 3; ++i)
      if (edge(t, i) > edge(t, k)) k = i;
    const Vec3 &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
    const Vec3 middle = (a + b) / 2;
    pieces({{a, middle, c}, piece.normal, piece.shell}, out);
    pieces({{middle, b, c}, piece.normal, piece.shell}, out);
  }

  // At points at most `finest` apart: the middles of the triangle's congruent parts.
  Answer look(const Piece& piece) const {
    const Corners& t = piece.corners;
    const int n = std::max(1, static_cast<int>(std::ceil(std::max({edge(t, 0), edge(t, 1), edge(t, 2)}) / finest_)));
    bool some = false, all = true;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n - i; ++j) {
        const Vec3 at = t[0] + (i + 1 / 3.0) / n * (t[1] - t[0]) + (j + 1 / 3.0) / n * (t[2] - t[0]);
        if (!covered(at, piece.shell) && seen(at, piece.normal))
          some = true;
        else
          all = false;
        if (some && !all) return Answer::some;
      }
    return all ? Answer::all : Answer::none;
  }

  static double edge(const Corners& t, int k) { return (t[(k + 1) % 3] - t[k]).norm(); }

  bool covered(const Vec3& point, int shell) const {
    return std::any_of(covers_.begin(), covers_.end(), [&](const Cover& cover) {
      return cover.shell != shell && (point.array() > cover.low.array()).all() &&
             (point.array() < cover.high.array()).all() && std::abs(cover.winding(point)) > 0.5;
    });
  }

  bool seen(const Vec3& point, const Vec3& normal) const {
    for (const Vec3& direction : directions_) {
      // Lifted off its own triangle, to the side that the viewer is on.
      const Vec3 start = point + (direction.dot(normal) < 0 ? -lift_ : lift_) * normal;
      if (scene_.clear(start, direction, std::numeric_limits<double>::infinity())) return true;
    }
    return false;
  }

  RayScene scene_;
  std::vector<Cover> covers_;
  double finest_ = 0, lift_ = 0;
  std::vector<Vec3> directions_;
};

}  // namespace

Mesh outer_surface(const Model& model, const OuterSurfaceOptions& options) {
  check("outer_surface", options);
  const Mesh mesh = welded(model.mesh);
  const std::vector<int> shell = shell_indices(mesh);
  const Watch watch(mesh, options);
  std::vector<std::vector<Corners>> seen(mesh.triangles.size());
  parallel_ranges(0, static_cast<int>(seen.size()), 16, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const auto& [a, b, c] = mesh.triangles[i];
      watch.seen_of({mesh.positions[a], mesh.positions[b], mesh.positions[c]}, shell[i], seen[i]);
    }
  });
  Mesh apart;
  for (const auto& pieces : seen)
    for (const Corners& t : pieces) {
      const int first = static_cast<int>(apart.positions.size());
      apart.positions.insert(apart.positions.end(), t.begin(), t.end());
      apart.triangles.push_back({first, first + 1, first + 2});
    }
  return welded(apart);
}

}  // namespace carve
