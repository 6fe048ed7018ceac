// Exact hulls: strips, CGAL's corefinement and CGAL's Nef polyhedra on the same silhouettes.
#include <benchmark/benchmark.h>

#include <fstream>

#include "carve/hull/contours.h"
#include "carve/hull/polyhedral_hull.h"
#include "hull/polygons.h"
#include "shapes.h"

namespace carve {
namespace {

// The highest memory since it was last reset, in MB; 0 where the system does not tell.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kilobytes; word == "VmHWM:" && status >> kilobytes) return kilobytes / 1024;
  return 0;
}

void measure(benchmark::State& state, const Silhouettes& silhouettes, HullMethod method) {
  std::ofstream("/proc/self/clear_refs") << 5;
  const double before = peak_memory();
  PolyhedralHull hull;
  for (auto _ : state) hull = polyhedral_hull(silhouettes, method);
  state.counters["MB"] = peak_memory() - before;
  state.counters["facets"] = hull.facets;
  state.counters["triangles"] = static_cast<double>(hull.mesh.triangles.size());
}

void BM_Polygons(benchmark::State& state, HullMethod method) {
  Silhouettes silhouettes;
  for (int axis = 0; axis < 3; ++axis)
    silhouettes.along.push_back({axis, View::front, {wave(static_cast<int>(state.range(0)), 7 + axis)}});
  measure(state, silhouettes, method);
}

const ViewSet& torus_views(int pixels) {
  static std::map<int, ViewSet> views;
  auto found = views.find(pixels);
  if (found == views.end()) found = views.emplace(pixels, aligned(torus(), kThreeViews, {.pixels = pixels})).first;
  return found->second;
}

void BM_PixelContours(benchmark::State& state, HullMethod method) {
  measure(state, pixel_contours(torus_views(static_cast<int>(state.range(0)))), method);
}

void BM_Trace(benchmark::State& state) {
  const ViewSet& views = torus_views(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(pixel_contours(views));
}

constexpr auto kMs = benchmark::kMillisecond;
BENCHMARK_CAPTURE(BM_Polygons, strips, HullMethod::strips)->Arg(16)->Arg(64)->Arg(256)->Arg(1024)->Unit(kMs);
BENCHMARK_CAPTURE(BM_Polygons, corefinement, HullMethod::corefinement)
    ->Arg(16)
    ->Arg(64)
    ->Arg(256)
    ->Arg(1024)
    ->Unit(kMs);
BENCHMARK_CAPTURE(BM_Polygons, nef, HullMethod::nef)->Arg(16)->Arg(64)->Arg(256)->Arg(1024)->Unit(kMs);
BENCHMARK_CAPTURE(BM_PixelContours, strips, HullMethod::strips)->Arg(128)->Arg(512)->Unit(kMs);
BENCHMARK_CAPTURE(BM_PixelContours, corefinement, HullMethod::corefinement)->Arg(128)->Arg(512)->Unit(kMs);
BENCHMARK_CAPTURE(BM_PixelContours, nef, HullMethod::nef)->Arg(128)->Arg(512)->Unit(kMs);
BENCHMARK(BM_Trace)->Arg(128)->Arg(512)->Unit(kMs);

}  // namespace
}  // namespace carve
