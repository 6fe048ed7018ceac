#include "models/inside.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "carve/core/parallel.h"
#include "models/shells.h"
#include "models/winding.h"

namespace carve {
namespace {

struct Crossing {
  int row;  // z * ny + y
  double x;
  int sign;
  bool operator<(const Crossing& other) const {
    return std::tie(row, x, sign) < std::tie(other.row, other.x, other.sign);
  }
};

// On which side of the edge from p to q, seen along x, the point (y, z) lies: +1 or -1, never 0. Both triangles of an
// edge get opposite answers, also where the point lies on it (it is then taken as moved by (e, e^2)).
int side(Vec3 p, Vec3 q, double y, double z) {
  const bool swapped = std::tie(q.y(), q.z(), q.x()) < std::tie(p.y(), p.z(), p.x());
  if (swapped) std::swap(p, q);
  const double dy = q.y() - p.y(), dz = q.z() - p.z();
  const double area = dy * (z - p.z()) - dz * (y - p.y());
  const bool left = area != 0 ? area > 0 : dz != 0 ? dz < 0 : dy > 0;
  return left != swapped ? 1 : -1;
}

void cross_rows(const Vec3& a, const Vec3& b, const Vec3& c, const VoxelGrid& grid, std::vector<Crossing>& out) {
  const Vec3 normal = (b - a).cross(c - a);
  const Vec3 low = (a.cwiseMin(b).cwiseMin(c) - grid.low()) / grid.spacing();
  const Vec3 high = (a.cwiseMax(b).cwiseMax(c) - grid.low()) / grid.spacing();
  const auto first = [](double v) { return std::max(0, static_cast<int>(std::floor(v - 0.5))); };
  const auto last = [](double v, int n) { return std::min(n - 1, static_cast<int>(std::ceil(v - 0.5))); };
  for (int k = first(low.z()); k <= last(high.z(), grid.size().z()); ++k)
    for (int j = first(low.y()); j <= last(high.y(), grid.size().y()); ++j) {
      const Vec3 centre = grid.centre(0, j, k);
      const int s = side(a, b, centre.y(), centre.z());
      if (side(b, c, centre.y(), centre.z()) != s || side(c, a, centre.y(), centre.z()) != s) continue;
      const double t =
          normal.x() == 0 ? 0 : -(normal.y() * (centre.y() - a.y()) + normal.z() * (centre.z() - a.z())) / normal.x();
      const double x = std::clamp(a.x() + t, std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}));
      out.push_back({k * grid.size().y() + j, x, s});
    }
}

// Adds the voxels around which a closed shell winds.
void fill(const Mesh& shell, VoxelGrid& grid) {
  std::vector<Crossing> crossings;
  for (const auto& [a, b, c] : shell.triangles)
    cross_rows(shell.positions[a], shell.positions[b], shell.positions[c], grid, crossings);
  std::sort(crossings.begin(), crossings.end());
  const int ny = grid.size().y(), nx = grid.size().x();
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding += crossings[i].sign;
    if (winding == 0 || crossings[i + 1].row != crossings[i].row) continue;
    const auto voxel = [&](double x) {
      return static_cast<int>(std::clamp(std::ceil((x - grid.low().x()) / grid.spacing() - 0.5), 0.0, 1.0 * nx));
    };
    for (int x = voxel(crossings[i].x); x < voxel(crossings[i + 1].x); ++x)
      grid.set(x, crossings[i].row % ny, crossings[i].row / ny, true);
  }
}

// About the centroid of its corners, so that it means something for an open shell too.
double volume(const Mesh& mesh) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : mesh.positions) middle += p / static_cast<double>(mesh.positions.size());
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += (mesh.positions[a] - middle).dot((mesh.positions[b] - middle).cross(mesh.positions[c] - middle));
  return sum / 6;
}

void append(Mesh& mesh, const Mesh& part, bool turn) {
  const int first = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  for (const auto& [a, b, c] : part.triangles)
    mesh.triangles.push_back(turn ? Triangle{first + a, first + c, first + b}
                                  : Triangle{first + a, first + b, first + c});
}

// A cube of voxels, for open shells: the winding number is harmonic away from the triangles, so where none is near and
// it is clearly on one side of one half at the cube's corners and middle, it is so within.
class OpenFill {
 public:
  OpenFill(const Mesh& open, VoxelGrid& grid) : mesh_(open), grid_(grid), winding_(open, 2), result_(grid) {}

  void run() {
    const int cubes = (grid_.size().maxCoeff() + kLargest - 1) / kLargest;
    std::vector<int> all(mesh_.triangles.size());
    std::iota(all.begin(), all.end(), 0);
    // A slab of cubes shares no rows with another.
    parallel_ranges(0, cubes, 1, [&](int first, int last) {
      for (int z = first; z < last; ++z)
        for (int y = 0; y < cubes; ++y)
          for (int x = 0; x < cubes; ++x) decide(kLargest * Vec3i(x, y, z), kLargest, all);
    });
    grid_ = std::move(result_);
  }

 private:
  static constexpr int kLargest = 16;

  void decide(const Vec3i& first, int edge, const std::vector<int>& around) {
    if ((first.array() >= grid_.size().array()).any()) return;
    const Vec3 low = grid_.low() + grid_.spacing() * first.cast<double>(), high = low.array() + grid_.spacing() * edge;
    const std::vector<int> close =
        touching(low.array() - grid_.spacing() * edge / 2, high.array() + grid_.spacing() * edge / 2, around);
    if (edge == 1) return set(first, 1, winding_((low + high) / 2) > 0.5);
    if (close.empty()) {
      double least = winding_((low + high) / 2), most = least;
      for (int corner = 0; corner < 8; ++corner) {
        const double w = winding_(
            {corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(), corner & 4 ? high.z() : low.z()});
        least = std::min(least, w), most = std::max(most, w);
      }
      if (least > 0.55 || most < 0.45) return set(first, edge, least > 0.55);
    }
    const int half = edge / 2;
    for (int part = 0; part < 8; ++part) decide(first + half * Vec3i(part & 1, part >> 1 & 1, part >> 2), half, close);
  }

  // Of `among`, the triangles whose boxes reach into a box.
  std::vector<int> touching(const Vec3& low, const Vec3& high, const std::vector<int>& among) const {
    std::vector<int> found;
    for (const int i : among) {
      const auto& [a, b, c] = mesh_.triangles[i];
      const Vec3 &p = mesh_.positions[a], &q = mesh_.positions[b], &r = mesh_.positions[c];
      if ((p.cwiseMin(q).cwiseMin(r).array() <= high.array()).all() &&
          (p.cwiseMax(q).cwiseMax(r).array() >= low.array()).all())
        found.push_back(i);
    }
    return found;
  }

  void set(const Vec3i& first, int edge, bool inside) {
    if (!inside) return;
    const Vec3i last = (first.array() + edge).min(grid_.size().array());
    for (int z = first.z(); z < last.z(); ++z)
      for (int y = first.y(); y < last.y(); ++y)
        for (int x = first.x(); x < last.x(); ++x) result_.set(x, y, z, true);
  }

  const Mesh& mesh_;
  VoxelGrid& grid_;
  WindingNumber winding_;
  VoxelGrid result_;
};

}  // namespace

VoxelGrid occupancy(const Model& model, const VoxelGrid& like) {
  VoxelGrid grid(like.size(), like.low(), like.spacing());
  Mesh open;
  for (const Mesh& shell : shells(welded(model.mesh))) {
    if (winds_whole(shell))
      fill(shell, grid);
    else
      append(open, shell, volume(shell) < 0);
  }
  if (!open.triangles.empty()) OpenFill(open, grid).run();
  return grid;
}

VoxelGrid grid_of(const Model& model, int resolution) {
  const auto [low, high] = bounds(model.mesh);
  return grid_over(low, high, resolution);
}

}  // namespace carve
