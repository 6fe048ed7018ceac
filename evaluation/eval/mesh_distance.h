#pragma once
#include <memory>
#include <span>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

struct MeshDistanceTree;

struct Nearest {
  double distance = 0;  // unsigned, in the mesh's unit
  int triangle = -1;    // the lowest index among those of the least squared distance in double
  bool operator==(const Nearest&) const = default;
};

/// Exact distances to a mesh, prepared once and asked often.
///
/// An eight-wide bounding volume hierarchy whose leaves measure eight triangles at a time in floats with a bound on
/// their error; every triangle that this bound cannot rule out is measured again in double (point_triangle.h). So the
/// answer is the brute-force minimum in double, bit for bit, whatever the threads and the instruction set. Many
/// points are asked along a Morton curve, each starting from its predecessor's triangle.
class MeshDistance {
 public:
  /// \throws std::invalid_argument: no triangle, an index out of range, a coordinate not finite or beyond 1e100
  explicit MeshDistance(const Mesh& mesh);
  ~MeshDistance();
  MeshDistance(MeshDistance&&) noexcept;
  MeshDistance& operator=(MeshDistance&&) noexcept;

  /// One answer a point, on all cores. \throws std::invalid_argument if a point is not finite or beyond 1e100
  std::vector<Nearest> nearest(std::span<const Vec3> points) const;

 private:
  std::unique_ptr<const MeshDistanceTree> tree_;
};

/// Unsigned distance of every point. Prepares a MeshDistance for this one call.
std::vector<double> distances(std::span<const Vec3> points, const Mesh& mesh);

}  // namespace carve
