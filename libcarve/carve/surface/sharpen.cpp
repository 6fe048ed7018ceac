#include "carve/surface/sharpen.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace carve {
namespace {

constexpr double kMargin = 0.01;    // voxels between a new vertex and its cell's sides
constexpr double kStray = 0.25;     // voxels that planes may meet outside the cell
constexpr double kParallel = 0.03;  // share of the normals' squares below which a direction is not held

/// The triangles of one cell, which come one after another.
struct CellTriangles {
  int first, last;
  Vec3i cell;
};

/// A side of a fan, its triangle and the vertex it runs around.
struct FanSide {
  int low, high;  // vertices
  int centre, triangle;
};

class Sharpener {
 public:
  Sharpener(const Mesh& mesh, const VoxelGrid& grid, Guides& guides) : mesh_(mesh), grid_(grid), guides_(guides) {}

  Mesh mesh() {
    result_.positions = mesh_.positions;
    result_.triangles.reserve(mesh_.triangles.size() + mesh_.triangles.size() / 4);
    for (int first = 0; first < static_cast<int>(mesh_.triangles.size());) {
      const CellTriangles cell = cell_at(first);
      if (!fan(cell))
        result_.triangles.insert(result_.triangles.end(), mesh_.triangles.begin() + cell.first,
                                 mesh_.triangles.begin() + cell.last);
      first = cell.last;
    }
    join_features();
    return std::move(result_);
  }

 private:
  /// In voxels, from the centre of voxel (0, 0, 0).
  Vec3 in_voxels(int vertex) const {
    return (mesh_.positions[vertex] - grid_.low()) / grid_.spacing() - Vec3::Constant(0.5);
  }
  Vec3i cell_of(int triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    // No triangle of a cell lies in one of its sides, so its middle is inside.
    return ((in_voxels(a) + in_voxels(b) + in_voxels(c)) / 3).array().floor().cast<int>();
  }
  CellTriangles cell_at(int first) const {
    CellTriangles found{first, first + 1, cell_of(first)};
    while (found.last < static_cast<int>(mesh_.triangles.size()) && cell_of(found.last) == found.cell) ++found.last;
    return found;
  }

  /// The border of a cell's triangles; empty if they are not one sheet.
  const std::vector<int>& loop_of(const CellTriangles& cell) {
    struct Side {
      int from, to;
    };
    Side sides[15];
    int count = 0;
    for (int t = cell.first; t < cell.last; ++t)
      for (int k = 0; k < 3; ++k) {
        const Side side{mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]};
        int other = 0;
        while (other < count && (sides[other].from != side.to || sides[other].to != side.from)) ++other;
        if (other < count)
          sides[other] = sides[--count];
        else
          sides[count++] = side;
      }
    loop_.clear();
    for (int at = sides[0].from; loop_.empty() || at != loop_.front();) {
      loop_.push_back(at);
      int next = 0;
      while (sides[next].from != at) ++next;
      at = sides[next].to;
    }
    if (static_cast<int>(loop_.size()) < count) loop_.clear();
    return loop_;
  }

  bool has_feature(const std::vector<int>& loop) const {
    static const float least = static_cast<float>(std::cos(kFeatureAngle * std::numbers::pi / 180));
    bool bent = false;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Guide& guide = guides_[loop[i]];
      if (guide.kind != Guide::Kind::plane) return false;
      for (std::size_t j = 0; j < i && !bent; ++j) bent = guide.axis.dot(guides_[loop[j]].axis) < least;
    }
    return bent;
  }

  struct Feature {
    Vec3 place;  // in voxels
    Guide guide;
  };

  /// Where the planes of a loop's vertices meet, nearest to the vertices' middle where they leave a choice.
  std::optional<Feature> feature_of(const std::vector<int>& loop, const Vec3i& cell) const {
    const double share = 1.0 / loop.size();
    Vec3 middle = Vec3::Zero();
    for (const int v : loop) middle += share * in_voxels(v);
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    for (const int v : loop) {
      const Vec3 normal = guides_[v].axis.cast<double>();
      squares += share * normal * normal.transpose();
      right += share * normal * normal.dot(in_voxels(v) - middle);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(squares);
    Feature found{middle, {Guide::Kind::fixed, parts.eigenvectors().col(0).cast<float>()}};
    for (int k = 0; k < 3; ++k) {
      if (parts.eigenvalues()[k] > kParallel)
        found.place += parts.eigenvectors().col(k) * (parts.eigenvectors().col(k).dot(right) / parts.eigenvalues()[k]);
      else
        found.guide.kind = Guide::Kind::line;
    }
    const Vec3 low = cell.cast<double>();
    const Vec3 within = found.place.cwiseMax(low + Vec3::Constant(kMargin)).cwiseMin(low + Vec3::Constant(1 - kMargin));
    if ((found.place - within).cwiseAbs().maxCoeff() > kStray) return std::nullopt;
    found.place = within;
    return found;
  }

  /// A fan around a new vertex instead of a cell's triangles. \return whether there is one
  bool fan(const CellTriangles& cell) {
    const std::vector<int>& loop = loop_of(cell);
    if (loop.empty() || !has_feature(loop)) return false;
    const auto feature = feature_of(loop, cell.cell);
    if (!feature) return false;
    const int centre = static_cast<int>(result_.positions.size());
    result_.positions.push_back(grid_.low() + grid_.spacing() * (feature->place + Vec3::Constant(0.5)));
    guides_.push_back(feature->guide);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int a = loop[k], b = loop[(k + 1) % loop.size()];
      sides_.push_back({std::min(a, b), std::max(a, b), centre, static_cast<int>(result_.triangles.size())});
      result_.triangles.push_back({centre, a, b});
    }
    return true;
  }

  /// Sides that two fans share become edges between their centres. Two centres that share two sides, across a face
  /// whose inside corners are separated, stay apart: a second edge between them would not be manifold.
  void join_features() {
    const auto by_side = [](const FanSide& a, const FanSide& b) {
      return std::tie(a.low, a.high, a.centre) < std::tie(b.low, b.high, b.centre);
    };
    std::sort(sides_.begin(), sides_.end(), by_side);
    struct Pair {
      int low, high, side;  // centres; its first one's index
    };
    std::vector<Pair> pairs;
    for (int i = 0; i + 1 < static_cast<int>(sides_.size()); ++i)
      if (sides_[i].low == sides_[i + 1].low && sides_[i].high == sides_[i + 1].high)
        pairs.push_back({sides_[i].centre, sides_[i + 1].centre, i});
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& a, const Pair& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto same = [&](std::size_t j) {
        return j < pairs.size() && pairs[j].low == pairs[i].low && pairs[j].high == pairs[i].high;
      };
      if (same(i + 1) || (i > 0 && same(i - 1))) continue;
      const FanSide &one = sides_[pairs[i].side], &other = sides_[pairs[i].side + 1];
      // {one, a, b} and {other, b, a}: the diagonal turns.
      const auto [centre, a, b] = result_.triangles[one.triangle];
      result_.triangles[one.triangle] = {centre, a, other.centre};
      result_.triangles[other.triangle] = {centre, other.centre, b};
    }
  }

  const Mesh& mesh_;
  const VoxelGrid& grid_;
  Guides& guides_;
  Mesh result_;
  std::vector<int> loop_;
  std::vector<FanSide> sides_;
};

}  // namespace

Mesh sharpen(const Mesh& mesh, const VoxelGrid& grid, Guides& guides) { return Sharpener(mesh, grid, guides).mesh(); }

}  // namespace carve
