#include "run/metrics.h"

#include <algorithm>

#include "eval/metrics.h"

namespace carve::experiments {
namespace {

Direction direction_of(carve::Better better) {
  switch (better) {
    case carve::Better::lower:
      return Direction::lower;
    case carve::Better::higher:
      return Direction::higher;
    default:
      return Direction::none;
  }
}

std::string unit_of(carve::Unit unit) {
  switch (unit) {
    case carve::Unit::length:
      return "% of the diagonal";
    case carve::Unit::squared_length:
      return "% of the squared diagonal";
    default:
      return "";
  }
}

std::vector<RunMetric> all_metrics() {
  std::vector<RunMetric> all;
  const std::vector<std::string> tolerances = CompareOptions().tolerances;
  for (const carve::Metric& metric : carve::metrics()) {
    const RunMetric column{metric.name, metric.formula, unit_of(metric.unit), direction_of(metric.better)};
    if (!metric.per_tolerance) {
      all.push_back(column);
      continue;
    }
    for (const std::string& t : tolerances) {
      all.push_back(column);
      all.back().name += "@" + t + "%";
    }
  }
  const RunMetric own[] = {
      {"iou",
       "volume of intersection over union with the base model's occupancy, on as many voxels as the run's grid has", "",
       Direction::higher},
      {"silhouette_iou", "mean over the drawings of the IoU of silhouette and the solid's shadow", "",
       Direction::higher},
      {"disagreement", "largest relative difference of two drawings' extents along a shared axis", "",
       Direction::lower},
      {"seconds", "wall time from pictures to mesh, one thread", "s", Direction::lower},
      {"cpu_seconds", "processor time from pictures to mesh: what a busy machine does not lengthen much", "s",
       Direction::lower},
      {"step_volume", "the thesis's step: alignment, silhouette carving, geometric consistency, convex refinement", "s",
       Direction::lower},
      {"step_mesh", "the thesis's step: intersections, marching cubes, smoothing and what works on the mesh", "s",
       Direction::lower},
      {"step_texture", "the thesis's step: texture atlas and diffuse map", "s", Direction::lower},
      {kEveryStage, "wall time of each stage, one thread", "s", Direction::lower},
      {"seconds_read", "understanding the drawings", "s", Direction::lower},
      {"seconds_align", "bringing the drawings to one scale", "s", Direction::lower},
      {"seconds_carve", "silhouette carving", "s", Direction::lower},
      {"seconds_consistency", "geometric consistency", "s", Direction::lower},
      {"seconds_convex", "convex refinement", "s", Direction::lower},
      {"seconds_intersections", "marching intersections", "s", Direction::lower},
      {"seconds_surface", "marching cubes", "s", Direction::lower},
      {"seconds_smooth", "smoothing", "s", Direction::lower},
      {"seconds_hull", "exact polyhedral hull", "s", Direction::lower},
      {"seconds_refine", "remeshing, smoothing of the shape, decimation", "s", Direction::lower},
      {"seconds_texture", "atlas and diffuse map", "s", Direction::lower},
      {"charts", "charts of the texture atlas", "", Direction::lower},
      {"packing", "share of the texture that charts cover", "", Direction::higher},
      {"distortion", "mean symmetric Dirichlet energy of the atlas; 4 = isometric", "", Direction::lower},
      {"seam_length", "of the atlas's seams on the surface, object units", "", Direction::lower},
      {"seam_contrast", "mean RGB distance of the two sides of seams", "", Direction::lower},
      {"texture_psnr", "round trip: drawings seen on the model, pixels no other drawing sees more squarely", "dB",
       Direction::higher},
      {"texture_psnr_all", "the same at all pixels of surface, also where drawings contradict each other", "dB",
       Direction::higher},
      {"texture_ssim", "structural similarity at the pixels of texture_psnr", "", Direction::higher},
      {"ghosting", "share of seen pixels whose colour no drawing shows there", "", Direction::lower},
      {"seconds_check", "checking that the mesh is closed and manifold", "s", Direction::lower},
      {"seconds_silhouettes", "visual hull of photos", "s", Direction::lower},
      {"seconds_space_carving", "Space Carving", "s", Direction::lower},
      {"seconds_stereo", "depth maps of pairs of photos", "s", Direction::lower},
      {"seconds_fusion", "depth maps to points", "s", Direction::lower},
      {"seconds_patches", "patches of the surface that photos agree on", "s", Direction::lower},
      {"seconds_poisson", "points to surface", "s", Direction::lower},
      {"points", "points that the mesh was made from", "", Direction::none},
      {"points_accuracy", "mean distance of these points to the reference", "% of the diagonal", Direction::lower},
      {"points_completeness", "mean distance of the reference's samples to these points", "% of the diagonal",
       Direction::lower},
      {"points_precision@1%", "share of these points within 1 % of the diagonal", "", Direction::higher},
      {"points_recall@1%", "share of the reference's samples within 1 % of the diagonal of one of these points", "",
       Direction::higher},
      {"megabytes", "largest resident memory of the run's process, synthesis and evaluation included", "MB",
       Direction::lower},
  };
  all.insert(all.end(), std::begin(own), std::end(own));
  return all;
}

}  // namespace

const std::vector<RunMetric>& metrics() {
  static const std::vector<RunMetric> all = all_metrics();
  return all;
}

const RunMetric* find_metric(const std::string& name) {
  const auto found =
      std::find_if(metrics().begin(), metrics().end(), [&](const RunMetric& m) { return m.name == name; });
  return found == metrics().end() ? nullptr : &*found;
}

}  // namespace carve::experiments
