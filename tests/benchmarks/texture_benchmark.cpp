// Texturing the hand-made drawings of Table 4.3's objects at grid 128 with a texture of 1024 x 1024, stage by stage and
// as the whole pipeline, one thread. Needs the drawings: datasets/drawings/rasterise.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <iostream>

#include "carve/core/parallel.h"
#include "carve/pipeline/reconstruct.h"
#include "carve/texture/diffuse.h"

namespace carve {
namespace {

struct Object {
  const char* name;
  std::map<View, Drawing> drawings;
  Reconstruction untextured;
};

Object read(const char* name) {
  std::map<View, std::filesystem::path> files;
  for (const View view : {View::front, View::side, View::top})
    files[view] = std::filesystem::path(CARVE_DRAWINGS) / name / (std::string(carve::name(view)) + ".png");
  auto drawings = read_drawings(files);
  Reconstruction untextured = reconstruct(drawings);
  return {name, std::move(drawings), std::move(untextured)};
}

const TextureOptions kBest{.arm = TextureArm::best_view};

void views(benchmark::State& state, const Object& object) {
  const Drawings drawings(object.untextured.views, kBest);
  for (auto _ : state)
    benchmark::DoNotOptimize(choose_views(object.untextured.mesh, object.untextured.views, drawings, kBest));
}

void atlas(benchmark::State& state, const Object& object) {
  const auto& [mesh, set] = std::tie(object.untextured.mesh, object.untextured.views);
  const ViewChoice choice = choose_views(mesh, set, Drawings(set, kBest), kBest);
  for (auto _ : state) benchmark::DoNotOptimize(lay_out(mesh, view_charts(mesh, set, choice)));
}

void diffuse(benchmark::State& state, const Object& object) {
  const auto& [mesh, set] = std::tie(object.untextured.mesh, object.untextured.views);
  const ViewChoice choice = choose_views(mesh, set, Drawings(set, kBest), kBest);
  const Atlas atlas = lay_out(mesh, view_charts(mesh, set, choice));
  for (auto _ : state) {
    const Drawings drawings(set, kBest);
    const std::vector<Paint> paints = paint_by_view(choice);
    const CornerColours corners = surface_colours(mesh, paints, choice.patch, drawings, kBest.level);
    benchmark::DoNotOptimize(bake(mesh, atlas, paints, drawings, corners, 4));
  }
}

void all(benchmark::State& state, const Object& object) {
  for (auto _ : state) benchmark::DoNotOptimize(texture(object.untextured.mesh, object.untextured.views, kBest));
}

void pipeline(benchmark::State& state, const Object& object) {
  PipelineOptions options;
  options.texture = kBest;
  for (auto _ : state) benchmark::DoNotOptimize(reconstruct(object.drawings, options));
}

}  // namespace
}  // namespace carve

int main(int argc, char** argv) {
  using namespace carve;
  benchmark::Initialize(&argc, argv);
  set_thread_count(1);
  static std::vector<Object> objects;
  for (const char* name : {"wagon", "couch", "spaceship", "head", "robot", "axe", "dog", "airplane", "car", "handgun",
                           "dragon", "jet", "armchair"})
    try {
      objects.push_back(read(name));
    } catch (const IoError& error) {
      std::cerr << error.what() << " (datasets/drawings/rasterise makes the drawings)\n";
      return 2;
    }
  using Work = void (*)(benchmark::State&, const Object&);
  const std::pair<const char*, Work> works[] = {
      {"views", views}, {"atlas", atlas}, {"diffuse", diffuse}, {"texture", all}, {"pipeline", pipeline}};
  for (const Object& object : objects)
    for (const auto& [name, work] : works)
      benchmark::RegisterBenchmark((std::string(object.name) + "/" + name).c_str(), [&object, work = work](
                                                                                        benchmark::State& state) {
        work(state, object);
      })->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
