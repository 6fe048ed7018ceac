#include "run/photo_methods.h"

#include "carve/core/error.h"
#include "carve/photo/poisson.h"
#include "carve/photo/settle_cells.h"
#include "carve/photo/silhouette_hull.h"
#include "carve/surface/marching_cubes.h"

namespace carve::experiments {
namespace {

constexpr double kPadding = 3;  // % of the longest side that the box is larger than the object

VoxelGrid region(const MethodInput& input) {
  return grid_over(input.photos.low, input.photos.high, input.options.pipeline.carve.grid, Fill::full);
}

void mesh_grid(MethodOutput& output, const VoxelGrid& grid, const MethodInput& input) {
  if (grid.count() == 0) throw NoResult("no voxel is consistent with the photos");
  const Mesh rough = timed(output, "surface", [&] { return marching_cubes(grid); });
  output.mesh = timed(output, "smooth", [&] { return smooth(rough, input.options.pipeline.smooth); });
}

VoxelGrid hull_of(MethodOutput& output, const VoxelGrid& start, const MethodInput& input) {
  return timed(output, "silhouettes", [&] { return silhouette_hull(input.photos.photos, start); });
}

VoxelGrid carved(MethodOutput& output, const VoxelGrid& start, const MethodInput& input) {
  return timed(output, "space_carving",
               [&] { return space_carving(input.photos.photos, start, input.options.space_carving); })
      .grid;
}

}  // namespace

PhotoInput take_photos(const Model& model, const RunOptions& options) {
  const auto [low, high] = bounds(model.mesh);
  const std::vector<Camera> cameras = rig(low, high, options.rig);
  const Vec3 padding = Vec3::Constant(kPadding / 100 * (high - low).maxCoeff());
  PhotoInput input{photograph(model, cameras, options.photograph, options.solid_texture), low - padding,
                   high + padding};
  const std::vector<Camera> told = with_pose_noise(cameras, (low + high) / 2, options.pose_noise);
  for (std::size_t i = 0; i < told.size(); ++i) input.photos[i].camera = told[i];
  return input;
}

MethodOutput surface_through(MethodOutput output, const OrientedPoints& points, const MethodInput& input) {
  output.mesh = timed(output, "poisson", [&] { return poisson_surface(points, region(input)); });
  output.points = points.positions;
  return output;
}

MethodOutput silhouettes_arm(const MethodInput& input) {
  MethodOutput output;
  mesh_grid(output, hull_of(output, region(input), input), input);
  return output;
}

MethodOutput space_carving_arm(const MethodInput& input) {
  MethodOutput output;
  const VoxelGrid hull = hull_of(output, region(input), input);
  mesh_grid(output, carved(output, hull, input), input);
  return output;
}

MethodOutput drawings_and_photos_arm(const MethodInput& input) {
  Reconstruction drawn = reconstruct(input.drawings, input.options.pipeline);
  MethodOutput output{.times = std::move(drawn.times)};
  const VoxelGrid hull = hull_of(output, drawn.grid, input);
  mesh_grid(output, carved(output, hull, input), input);
  return output;
}

MethodOutput open_cells_arm(const MethodInput& input) {
  Reconstruction drawn = reconstruct(input.drawings, input.options.pipeline);
  MethodOutput output{.times = std::move(drawn.times)};
  SettledCells settled = timed(output, "open_cells", [&] {
    return settle_cells(input.photos.photos, drawn.grid, drawn.consistency.open_cells, input.options.space_carving);
  });
  output.provenance["open cells"] =
      std::to_string(settled.kept) + " kept, " + std::to_string(settled.dropped) + " dropped";
  mesh_grid(output, settled.grid, input);
  return output;
}

MethodOutput stereo_arm(const MethodInput& input) {
  MethodOutput output;
  const PhotoInput& in = input.photos;
  const StereoOptions& options = input.options.stereo;
  const std::vector<DepthMap> maps =
      timed(output, "stereo", [&] { return depth_maps(in.photos, in.low, in.high, options); });
  const OrientedPoints points = timed(output, "fusion", [&] { return fuse(maps, in.low, in.high, options); });
  return surface_through(std::move(output), points, input);
}

MethodOutput patches_arm(const MethodInput& input) {
  MethodOutput output;
  const PhotoInput& in = input.photos;
  const OrientedPoints points =
      timed(output, "patches", [&] { return patches(in.photos, in.low, in.high, input.options.patches); });
  return surface_through(std::move(output), points, input);
}

}  // namespace carve::experiments
