#include "run/cell.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>

#include "carve/core/file.h"
#include "carve/core/parallel.h"
#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "eval/metrics.h"
#include "eval/texture_scores.h"
#include "models/inside.h"
#include "run/external.h"
#include "run/hash.h"
#include "run/methods.h"
#include "run/metrics.h"
#include "run/models.h"
#include "run/photo_methods.h"
#include "run/reference.h"
#include "run/runner.h"

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

/// Voxels along the longest side of the grid that solids are compared on: those of the run. On half as many, centres
/// would lie on the faces of the run's voxels, neither inside nor outside; an odd number avoids that on larger grids.
int occupancy_grid(const MethodInput& input) { return std::min(input.options.pipeline.carve.grid, 511); }

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The points that a mesh was made from: how near they are and what of the reference they cover.
void measure_points(const std::vector<Vec3>& points, const Reference& reference, Record& record) {
  record.metrics["points"] = static_cast<double>(points.size());
  const Comparison comparison = reference.compare({.positions = points, .triangles = {}});
  for (const Score& score : scores(comparison, reference))
    if (const auto value = score.percent ? score.percent : score.value)
      if (const std::string name = "points_" + score.name(); find_metric(name)) record.metrics[name] = *value;
}

void measure_against(const Model& model, const Mesh& reference, const MethodOutput& output,
                     const CompareOptions& options, int grid_size, Record& record) {
  const Reference prepared(reference, options);
  for (const Score& score : scores(prepared.compare(output.mesh), prepared)) {
    const auto value = score.percent ? score.percent : score.value;
    if (value) record.metrics[score.name()] = *value;
  }
  const VoxelGrid grid = grid_of(model, grid_size);
  record.metrics["iou"] = intersection_over_union(occupancy(model, grid), occupancy({.mesh = output.mesh}, grid));
  if (!output.points.empty()) measure_points(output.points, prepared, record);
}

void measure_shadows(const Mesh& mesh, const MethodInput& input, Record& record) {
  const ViewSet views = align(input.drawings, input.options.pipeline.align);
  double sum = 0;
  const VoxelGrid grid = grid_over(views.low(), views.high(), occupancy_grid(input));
  for (const ViewAgreement& fit : agreement(occupancy({.mesh = mesh}, grid), views)) sum += fit.silhouette_iou;
  record.metrics["silhouette_iou"] = sum / static_cast<double>(views.views.size());
  record.metrics["disagreement"] = views.disagreement;
}

// The steps of the thesis's Table 4.3 and the stages they are made of.
struct Step {
  const char* metric;
  std::array<std::string_view, 6> stages;
};
constexpr Step kSteps[] = {{"step_volume", {"align", "carve", "consistency", "convex"}},
                           {"step_mesh", {"intersections", "surface", "smooth", "fit", "refine", "hull"}},
                           {"step_texture", {"atlas", "diffuse", "texture"}}};

void measure_texture(const TexturedMesh& model, const MethodInput& input, Record& record) {
  const AtlasScores atlas = atlas_scores(model);
  record.metrics["charts"] = static_cast<double>(atlas.charts);
  record.metrics["packing"] = atlas.packing;
  record.metrics["distortion"] = atlas.distortion;
  record.metrics["seam_length"] = atlas.seam_length;
  record.metrics["seam_contrast"] = atlas.seam_contrast;
  const RoundTrip trip = round_trip(model, align(input.drawings, input.options.pipeline.align));
  for (const auto& [metric, value] :
       {std::pair("texture_psnr", trip.psnr), std::pair("texture_psnr_all", trip.psnr_all),
        std::pair("texture_ssim", trip.ssim), std::pair("ghosting", trip.ghosting)})
    if (value) record.metrics[metric] = *value;
}

void record_times(const std::vector<StageTime>& times, Record& record) {
  for (const StageTime& time : times) {
    record.metrics["seconds_" + time.stage] += time.seconds;
    for (const Step& step : kSteps)
      if (std::find(step.stages.begin(), step.stages.end(), time.stage) != step.stages.end())
        record.metrics[step.metric] += time.seconds;
  }
}

}  // namespace

void run_cell(const fs::path& results, const std::string& spec, const Cell& cell, int threads) {
  set_thread_count(threads);
  const Subject subject = make_subject(cell.model);
  MethodInput input{.pictures = subject.drawings, .drawings = {}, .options = {}, .seed = cell.seed};
  apply(input.options, cell.settings);
  input.options.degrade.seed = static_cast<int>(cell.seed);
  const std::string content = content_hash(subject);
  if (subject.model) input.pictures = concept_art_of(results, *subject.model, content, input.options);

  const Method& method = *find_method(cell.arm);
  if (method.photos) {
    if (!subject.model) throw std::invalid_argument(cell.model + " has no base model to take photos of");
    input.photos = take_photos(*subject.model, input.options);
  }

  Record record = record_of(spec, cell, "done");
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  for (const auto& [view, picture] : input.pictures)
    input.drawings.emplace(view, understand_drawing(picture, input.options.pipeline.drawing));
  record_times({{"read", seconds_since(start)}}, record);
  MethodOutput output;
  try {
    output = method.run(input);
  } catch (const NotInstalled& absent) {
    return store_record(results, cell, record_of(spec, cell, absent.what()));
  }
  record.metrics["seconds"] = seconds_since(start);
  record.metrics["cpu_seconds"] = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  record_times(output.times, record);

  record.provenance.insert(output.provenance.begin(), output.provenance.end());
  if (subject.model) {
    record.provenance[kReferenceKey] = content;
    measure_against(*subject.model, reference_of(results, *subject.model, content), output, input.options.evaluate,
                    occupancy_grid(input), record);
  }
  measure_shadows(output.mesh, input, record);
  if (!output.textured.texture.empty()) measure_texture(output.textured, input, record);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  record.metrics["megabytes"] = static_cast<double>(usage.ru_maxrss) / 1024;

  const fs::path folder = results / cell.path;
  fs::create_directories(folder);
  for (const auto& [view, picture] : input.pictures) write_png(folder / (std::string(name(view)) + ".png"), picture);
  write_mesh(folder / "mesh.ply", output.mesh);
  if (output.textured.texture.empty())
    write_mesh(folder / "mesh.glb", output.mesh);
  else
    write_textured_mesh(folder / "mesh.glb", output.textured);
  store_record(results, cell, record);  // last: its presence says that all is there
}

}  // namespace carve::experiments
