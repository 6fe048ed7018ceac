#include <benchmark/benchmark.h>

#include "carve/core/parallel.h"
#include "carve/mesh/mesh_io.h"
#include "carve/mesh/topology.h"
#include "carve/surface/smooth.h"
#include "mesh/solids.h"
#include "temporary_folder.h"

namespace carve {
namespace {

// 2 * side * side triangles with coordinates that use every digit.
Mesh grid_mesh(int side) { return shaken(torus_mesh(side, side), 1, 1e-5); }

void count_triangles(benchmark::State& state, const Mesh& mesh) {
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

void topology_of_2m_triangles(benchmark::State& state) {
  const Mesh mesh = grid_mesh(1024);
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(topology(mesh));
  set_thread_count(0);
  count_triangles(state, mesh);
}
BENCHMARK(topology_of_2m_triangles)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void write_2m_triangles(benchmark::State& state, const char* name) {
  const TemporaryFolder folder;
  const Mesh mesh = grid_mesh(1024);
  for (auto _ : state) write_mesh(folder / name, mesh, {.strict = false});
  state.counters["MB"] = static_cast<double>(std::filesystem::file_size(folder / name)) / 1e6;
}

void read_2m_triangles(benchmark::State& state, const char* name) {
  const TemporaryFolder folder;
  write_mesh(folder / name, grid_mesh(1024), {.strict = false});
  for (auto _ : state) benchmark::DoNotOptimize(read_mesh(folder / name));
}

const bool registered = [] {
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "a.glb"}) {
    const std::string ending = name + 2;
    benchmark::RegisterBenchmark(("write_2m_triangles/" + ending).c_str(), write_2m_triangles, name)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
    benchmark::RegisterBenchmark(("read_2m_triangles/" + ending).c_str(), read_2m_triangles, name)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  return true;
}();

// Two steps; 224^2 * 2 triangles are what grid 128 gives, 520^2 * 2 what grid 256 gives.
void smooth_two_steps(benchmark::State& state) {
  const Mesh mesh = grid_mesh(static_cast<int>(state.range(0)));
  set_thread_count(static_cast<int>(state.range(1)));
  const SmoothOptions options{.steps = 2, .level = static_cast<double>(state.range(2))};
  for (auto _ : state) benchmark::DoNotOptimize(smooth(mesh, options));
  set_thread_count(0);
  count_triangles(state, mesh);
}
BENCHMARK(smooth_two_steps)
    ->ArgNames({"side", "threads", "level"})
    ->ArgsProduct({{224, 520}, {1, 2}, {60, 180}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace carve
