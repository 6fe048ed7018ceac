#pragma once
#include <array>
#include <vector>

#include "carve/mesh/mesh.h"

namespace carve {

/// The generalised winding number of a mesh: 1 inside a closed shell, 0 outside, in between near the holes of an open
/// one. Far triangles count as one dipole \cite barill_2018; prepared once, asked often, from any thread.
class WindingNumber {
 public:
  /// \param accuracy  a cluster is far beyond so many of its radii; infinite: exact sums of solid angles
  explicit WindingNumber(const Mesh& mesh, double accuracy = 2.5);
  double operator()(const Vec3& point) const;

 private:
  struct Node {
    Vec3 centre, dipole;  // dipole: sum of area vectors
    double radius;
    int first, last;  // triangles
    int right;        // the other child; the left one follows the node. 0: a leaf
  };
  int build(int first, int last);
  double sum(int node, const Vec3& point) const;

  double accuracy_;
  std::vector<std::array<Vec3, 3>> corners_;
  std::vector<Node> nodes_;
};

}  // namespace carve
