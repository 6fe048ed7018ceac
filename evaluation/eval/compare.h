#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carve/mesh/ply_cloud.h"
#include "carve/mesh/topology.h"
#include "eval/mesh_distance.h"
#include "eval/signed_distance.h"
#include "eval/spill.h"

namespace carve {

struct CompareOptions {
  int samples = 200'000;
  int seed = 1;
  std::vector<std::string> tolerances = {"0.5", "1", "2"};
  int iou_resolution = 128;
  bool self_intersections = true;
  SignRule sign = SignRule::pseudo_normal;
};
template <class Visitor>
void visit_fields(CompareOptions& o, Visitor&& field) {
  field("samples", o.samples, 1, 100'000'000, "area-uniform samples on each mesh");
  field("seed", o.seed, 0, 2'147'483'647, "of the samples");
  field("tolerances", o.tolerances, "distances of precision, recall and F, % of the reference's diagonal");
  field("iou_resolution", o.iou_resolution, 0, 2048, "cubes along the longest side for the volume IoU; 0 = leave out");
  field("self_intersections", o.self_intersections, "count pairs of triangles that intersect");
  field("sign", o.sign, "how inside is told from outside");
}

/// Unsigned distances: their sums, and their ranks wherever they lie. Sums are taken in the order given.
struct Distances {
  double mean = 0, mean_square = 0, deviation = 0, max = 0;
  std::vector<double> sorted = {};                 // ascending; empty if they are
  std::shared_ptr<const Spill> spilled = nullptr;  // in a file, in the order given and signed

  double percentile(double p) const;  // linear between ranks, p in [0, 100]; NaN without values
  double share_within(double tolerance) const;
};
Distances summarise(std::vector<double> unsigned_distances);

/// What the metrics (eval/metrics.h) are read from. A part that the inputs do not allow is absent: a cloud has no
/// area, a surface with holes no volume.
struct Comparison {
  std::vector<double> vertex_signed;  // per vertex of the compared mesh, in its order; none of a PlyCloud
  double signed_mean = 0, signed_deviation = 0;
  Distances vertex;                        // the same, unsigned
  std::optional<Distances> to_reference;   // from samples of the compared mesh; of a cloud, from its points
  std::optional<Distances> to_compared;    // from samples of the reference
  std::optional<double> normal_agreement;  // mean |cos| between normals at a sample and at its nearest point, both ways
  std::optional<double> volume_iou;
  std::optional<Topology> topology;                // of the compared mesh
  std::optional<std::int64_t> self_intersections;  // pairs of triangles
};

/// Diagonal of the bounding box of the triangles' corners.
double box_diagonal(const Mesh& mesh);

/// A reference, prepared once for any number of compared meshes.
class Reference {
 public:
  /// \throws std::invalid_argument: a reference without triangles or area, options out of range
  explicit Reference(Mesh mesh, const CompareOptions& options = {});
  Comparison compare(const Mesh& compared) const;
  /// The same figures, bit for bit, of a cloud that need not fit into memory; `piece` points of it do.
  /// \throws IoError as PlyCloud, or if the disk has no 8 bytes a point for the distances
  Comparison compare(PlyCloud& compared, std::size_t piece = 1 << 20) const;

  const Mesh& mesh() const { return mesh_; }
  double diagonal() const { return diagonal_; }  // of the bounding box of the triangles' corners
  const std::vector<double>& tolerances() const { return tolerances_; }  // in % of the diagonal
  const CompareOptions& options() const { return options_; }

 private:
  Mesh mesh_;
  CompareOptions options_;
  MeshDistance distance_;
  double diagonal_ = 0;
  bool closed_ = false;
  std::vector<double> tolerances_;
};

}  // namespace carve
