// Carving and surface extraction: drawings of 512 x 512 pixels, grids of 256 to 2048 voxels; the couch at grid 128.
#include <benchmark/benchmark.h>

#include <map>

#include "carve/carving/carve_silhouettes.h"
#include "carve/core/pages.h"
#include "carve/core/parallel.h"
#include "carve/pipeline/reconstruct.h"
#include "carve/surface/crossings.h"
#include "carve/surface/marching_cubes.h"
#include "carve/surface/smooth.h"
#include "models/procedural.h"
#include "run/models.h"
#include "shapes.h"
#include "synthesize/synthesize.h"

namespace carve {
namespace {

const ViewSet& ball_views() {
  static const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 506, .margin = 3});
  return views;
}

const Carving& ball_carving(int grid) {
  static std::map<int, Carving> carvings;
  auto found = carvings.find(grid);
  if (found == carvings.end()) found = carvings.emplace(grid, carve_silhouettes(ball_views(), {.grid = grid})).first;
  return found->second;
}

/// The work under test on 1 or 2 threads (the second argument), the clock being the wall's.
template <class Work>
void measure(benchmark::State& state, Work&& work) {
  set_thread_count(static_cast<int>(state.range(1)));
  for (auto _ : state) benchmark::DoNotOptimize(work(static_cast<int>(state.range(0))));
  set_thread_count(0);
}

void BM_PatchLabels(benchmark::State& state) {
  const VoxelGrid grid = grid_over(ball_views().low(), ball_views().high(), static_cast<int>(state.range(0)));
  measure(state, [&](int) {
    std::vector<PatchLabels> labels;
    for (const AlignedView& view : ball_views().views) labels.push_back(patch_labels(view, grid));
    return labels;
  });
}

void BM_CarveSilhouettes(benchmark::State& state) {
  measure(state, [](int grid) { return carve_silhouettes(ball_views(), {.grid = grid}); });
}

void BM_ContourCrossings(benchmark::State& state) {
  const VoxelGrid& grid = ball_carving(static_cast<int>(state.range(0))).grid;
  measure(state, [&](int) { return contour_crossings(ball_views(), grid); });
}

void BM_MarchingCubes(benchmark::State& state) {
  const VoxelGrid& grid = ball_carving(static_cast<int>(state.range(0))).grid;
  const Crossings crossings = contour_crossings(ball_views(), grid);
  measure(state, [&](int) {
    Mesh mesh = marching_cubes(grid, crossings);
    state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
    return mesh;
  });
}

void BM_Whole(benchmark::State& state) {
  measure(state, [](int grid) {
    const Carving carving = carve_silhouettes(ball_views(), {.grid = grid});
    return marching_cubes(carving.grid, contour_crossings(ball_views(), carving.grid));
  });
}

const ViewSet& couch_views() {
  static const ViewSet views = [] {
    std::map<View, Drawing> drawings;
    for (auto& [view, picture] : synthesize(couch())) drawings.emplace(view, understand_drawing(std::move(picture)));
    return align(std::move(drawings));
  }();
  return views;
}

// Drawings to closed mesh without consistency and convex refinement, whose time depends on what is drawn.
void BM_Couch(benchmark::State& state) {
  couch_views();
  measure(state, [](int grid) {
    const Carving carving = carve_silhouettes(couch_views(), {.grid = grid});
    return smooth(marching_cubes(carving.grid, contour_crossings(couch_views(), carving.grid)));
  });
}

/// The drawings of a model, understood: what reconstruct() starts from.
const std::map<View, Drawing>& drawings_of(const std::string& name) {
  static std::map<std::string, std::map<View, Drawing>> all;
  auto& drawings = all[name];
  if (drawings.empty()) {
    const experiments::Subject subject = experiments::make_subject(name);
    for (const auto& [view, picture] : subject.model ? synthesize(*subject.model) : subject.drawings)
      drawings.emplace(view, understand_drawing(picture));
  }
  return drawings;
}

/// Labels to smoothed mesh on one thread, with the stages' milliseconds beside the whole.
void measure_model(benchmark::State& state, const std::string& name, Consistency arm) {
  const std::map<View, Drawing>& drawings = drawings_of(name);
  PipelineOptions options;
  options.consistency.arm = arm;
  std::map<std::string, double> times;
  set_thread_count(1);
  for (auto _ : state) {
    state.PauseTiming();
    std::map<View, Drawing> input = drawings;
    state.ResumeTiming();
    const Reconstruction result = reconstruct(std::move(input), options);
    for (const StageTime& time : result.times) times[time.stage] += time.seconds;
  }
  set_thread_count(0);
  for (const auto& [stage, seconds] : times)
    state.counters[stage] = 1000 * seconds / static_cast<double>(state.iterations());
}

const bool kModelsAreRegistered = [] {
  keep_freed_memory();  // as programs do
  for (const std::string& name : experiments::expand_subjects({"set:procedural", "set:artist", "set:drawing"}))
    for (const Consistency arm : {Consistency::none, Consistency::solver})
      benchmark::RegisterBenchmark(("BM_Model/" + name + "/" + names(arm)[static_cast<int>(arm)]).c_str(),
                                   [name, arm](benchmark::State& state) { measure_model(state, name, arm); })
          ->Unit(benchmark::kMillisecond);
  return true;
}();

constexpr auto kUnit = benchmark::kMillisecond;
BENCHMARK(BM_PatchLabels)->ArgsProduct({{256, 512, 1024}, {1, 2}})->Unit(kUnit)->UseRealTime();
BENCHMARK(BM_CarveSilhouettes)->ArgsProduct({{256, 512, 1024}, {1, 2}})->Unit(kUnit)->UseRealTime();
BENCHMARK(BM_ContourCrossings)->ArgsProduct({{256, 512}, {1, 2}})->Unit(kUnit)->UseRealTime();
BENCHMARK(BM_MarchingCubes)->ArgsProduct({{256, 512}, {1, 2}})->Unit(kUnit)->UseRealTime();
BENCHMARK(BM_Couch)->ArgsProduct({{128}, {1, 2}})->Unit(kUnit)->UseRealTime();
BENCHMARK(BM_Whole)->ArgsProduct({{2048}, {1, 2}})->Unit(kUnit)->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace carve
