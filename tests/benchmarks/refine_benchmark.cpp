#include <benchmark/benchmark.h>

#include "carve/mesh/self_intersections.h"
#include "carve/refine/refine.h"
#include "mesh/solids.h"

namespace carve {
namespace {

// 138 k triangles with rough edges.
Mesh rough_torus() { return shaken(torus_mesh(372, 186), 1, 2e-4); }

void stage_of_138k_triangles(benchmark::State& state, const char* stage) {
  const Mesh mesh = rough_torus();
  const RefineOptions options{.arm = {stage},
                              .faces = std::string(stage) == "decimate" ? std::optional(13838) : std::nullopt,
                              .stages = {.wrap_always = true}};
  std::int64_t triangles = 0;
  for (auto _ : state) triangles = refine(mesh, options).steps[0].triangles;
  state.counters["triangles"] = static_cast<double>(triangles);
}

// What refine() adds to each stage.
void check_of_138k_triangles(benchmark::State& state) {
  const Mesh mesh = rough_torus();
  for (auto _ : state) benchmark::DoNotOptimize(self_intersections(mesh));
}
BENCHMARK(check_of_138k_triangles)->Unit(benchmark::kMillisecond)->UseRealTime();

const bool registered = [] {
  for (const char* stage :
       {"remesh", "smooth_shape", "angle_and_area", "tangential", "segment", "decimate", "alpha_wrap"})
    benchmark::RegisterBenchmark((std::string("stage_of_138k_triangles/") + stage).c_str(), stage_of_138k_triangles,
                                 stage)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  return true;
}();

}  // namespace
}  // namespace carve
