#pragma once
#include <chrono>

#include "run/methods.h"

namespace carve::experiments {

// Ways from photos with known cameras to a mesh (thesis 4.1.2, design: photo-consistency beside drawings). They are
// told the box that the object lies in, as drawings tell it, and work at the drawings' grid; a solid is meshed by
// marching cubes and smoothed as the drawings' is. \throws NoResult if nothing is left

/// The visual hull of all photos.
MethodOutput silhouettes_arm(const MethodInput& input);
/// Space Carving from that hull.
MethodOutput space_carving_arm(const MethodInput& input);
/// Space Carving from what geometric consistency left of the drawings' hull: the combination the thesis proposes (5.2).
MethodOutput drawings_and_photos_arm(const MethodInput& input);
/// What the pipeline carved, with the cells that the drawings leave open settled by Space Carving.
MethodOutput open_cells_arm(const MethodInput& input);
/// Dense stereo, fusion, Poisson.
MethodOutput stereo_arm(const MethodInput& input);
/// Patches as PMVS makes them, Poisson.
MethodOutput patches_arm(const MethodInput& input);

/// The closed surface through points, both of the output.
MethodOutput surface_through(MethodOutput output, const OrientedPoints& points, const MethodInput& input);

/// Does a stage and notes its time.
template <class Work>
auto timed(MethodOutput& output, const char* stage, Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  auto result = work();
  output.times.push_back({stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
  return result;
}

/// The photos that a run's options ask for, with the cameras as calibration has them, and the box.
PhotoInput take_photos(const Model& model, const RunOptions& options);

}  // namespace carve::experiments
