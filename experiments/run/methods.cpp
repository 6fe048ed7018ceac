#include "run/methods.h"

#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include "run/external_methods.h"
#include "run/photo_methods.h"

namespace carve::experiments {
namespace {

// The library's way, with all its options: every variant that options can state.
MethodOutput carve_arm(const MethodInput& input) {
  Reconstruction result = reconstruct(input.drawings, input.options.pipeline);
  return {std::move(result.mesh), std::move(result.textured), std::move(result.times)};
}

// Methods that fail on purpose: what a sweep does with them is tested and shown in the documentation.
MethodOutput crash(const MethodInput&) {
  std::raise(SIGSEGV);
  return {};
}

MethodOutput hang(const MethodInput&) {
  for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
}

MethodOutput hoard(const MethodInput&) {
  for (std::vector<std::unique_ptr<char[]>> all;;)
    all.push_back(std::make_unique_for_overwrite<char[]>(std::size_t{1} << 26));
}

constexpr Method kMethods[] = {
    {"carve", "the pipeline of carve build", carve_arm},
    {"silhouettes", "the visual hull of photos", silhouettes_arm, true},
    {"space_carving", "Space Carving from that hull", space_carving_arm, true},
    {"drawings_and_photos", "Space Carving from what the pipeline carved", drawings_and_photos_arm, true},
    {"open_cells", "what the pipeline carved; photos settle the cells that drawings leave open", open_cells_arm, true},
    {"stereo", "dense stereo of photos, fusion, Poisson", stereo_arm, true},
    {"patches", "multi-view stereo by patches as PMVS does it, Poisson", patches_arm, true},
    {"colmap", "sparse points of COLMAP, if it is installed; Poisson", colmap_arm, true},
    {"pmvs2", "the points of a pmvs2 on the PATH; Poisson", pmvs2_arm, true},
    {"cmvs", "the points of a pmvs2 on the clusters of a cmvs and genOption; Poisson", cmvs_arm, true},
    {"crash", "dies of a segmentation fault: to see that a sweep survives it", crash},
    {"hang", "never ends: to see the time limit at work", hang},
    {"hoard", "takes memory until there is none: to see the memory limit at work", hoard},
};

}  // namespace

std::span<const Method> methods() { return kMethods; }

const Method* find_method(const std::string& name) {
  for (const Method& method : kMethods)
    if (name == method.name) return &method;
  return nullptr;
}

std::string method_names() {
  std::string all;
  for (const Method& method : kMethods) all += (all.empty() ? "" : ", ") + std::string(method.name);
  return all;
}

}  // namespace carve::experiments
