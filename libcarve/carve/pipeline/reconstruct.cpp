#include "carve/pipeline/reconstruct.h"

#include <chrono>
#include <utility>

#include "carve/core/error.h"
#include "carve/surface/crossings.h"
#include "carve/surface/marching_cubes.h"
#include "carve/surface/sharpen.h"

namespace carve {
namespace {

// Runs a stage, telling the monitor before it and the record after it.
class Stages {
 public:
  Stages(const Monitor& monitor, int count, std::vector<StageTime>& times)
      : monitor_(monitor), count_(count), times_(times) {}

  template <class Work>
  auto operator()(const char* stage, Work&& work) {
    monitor_.at(stage, static_cast<double>(times_.size()) / count_);
    const auto start = std::chrono::steady_clock::now();
    auto result = work();
    times_.push_back({stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
    return result;
  }

  // For the work of the stage that runs: its 0 to 1 is the stage's share of the whole.
  Monitor within() const {
    if (!monitor_.progress) return monitor_;
    return {[this](std::string_view name, double fraction) {
              monitor_.progress(name, (static_cast<double>(times_.size()) + fraction) / count_);
            },
            monitor_.stop};
  }

 private:
  const Monitor& monitor_;
  int count_;
  std::vector<StageTime>& times_;
};

Mesh voxel_surface(const Carving& hull, Reconstruction& result, const PipelineOptions& options, Stages& stage) {
  result.consistency =
      stage("consistency", [&] { return apply_consistency(hull, result.views, options.consistency, stage.within()); });
  Refinement refined = stage("convex", [&] {
    return refine_convex(std::exchange(result.consistency.grid, {}), result.views, options.convex);
  });
  result.grid = std::move(refined.grid);
  if (result.grid.count() == 0) throw NoResult("geometric consistency left no voxel");
  const Crossings crossings = stage("intersections", [&] {
    if (!options.intersections) return Crossings{};
    Crossings crossings = contour_crossings(result.views, result.grid);
    if (options.intersections_strokes) crossings.strokes = std::exchange(result.consistency.crossings, {});
    crossings.edges = std::move(refined.crossings);
    return crossings;
  });
  Guides guides;
  Mesh surface = stage("surface", [&] {
    Mesh mesh = marching_cubes(result.grid, crossings);
    if (!options.intersections) return mesh;
    if (options.intersections_sharp || options.smooth.keep) guides = vertex_guides(mesh, result.grid, crossings);
    return options.intersections_sharp ? sharpen(mesh, result.grid, guides) : mesh;
  });
  return stage("smooth", [&] { return smooth(std::move(surface), options.smooth, stage.within(), guides); });
}

}  // namespace

std::vector<Field> fields(PipelineOptions& options) {
  std::vector<Field> all;
  add_fields(all, "", options.carve);
  add_fields(all, "", options);
  add_fields(all, "consistency", options.consistency);
  add_fields(all, "convex", options.convex);
  add_fields(all, "contour", options.contour);
  add_fields(all, "drawing", options.drawing);
  add_fields(all, "align", options.align);
  add_fields(all, "smooth", options.smooth);
  add_fields(all, "refine", options.refine);
  add_fields(all, "texture", options.texture);
  add_fields(all, "atlas", options.atlas);
  return all;
}

Reconstruction reconstruct(std::map<View, Drawing> drawings, const PipelineOptions& options, const Monitor& monitor) {
  PipelineOptions checked = options;
  for (const Field& field : fields(checked)) field.set(field.get());

  Reconstruction result;
  Stages stage(monitor, 10, result.times);
  result.views = stage("align", [&] { return align(std::move(drawings), options.align); });
  Carving hull = stage("carve", [&] { return carve_silhouettes(result.views, options.carve); });
  Mesh surface = options.hull == HullMethod::none ? voxel_surface(hull, result, options, stage) : stage("hull", [&] {
    return polyhedral_hull(pixel_contours(result.views, options.contour), options.hull).mesh;
  });
  if (options.hull != HullMethod::none) result.grid = std::move(hull.grid);
  RefinedMesh fine =
      stage("refine", [&] { return refine(std::move(surface), options.refine, result.views, stage.within()); });
  result.mesh = std::move(fine.mesh);
  result.refinement = std::move(fine.steps);
  result.topology = stage("check", [&] { return topology(result.mesh); });
  if (options.texture.arm == TextureArm::blend || options.texture.arm == TextureArm::best_view)
    result.textured = stage(
        "texture", [&] { return texture(result.mesh, result.views, options.texture, options.atlas, stage.within()); });
  result.agreement = agreement(result.grid, result.views);
  monitor.at("done", 1);
  return result;
}

}  // namespace carve
