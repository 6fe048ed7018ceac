#pragma once
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
/// Dense stereo, fusion, Poisson.
MethodOutput stereo_arm(const MethodInput& input);
/// Patches as PMVS makes them, Poisson.
MethodOutput patches_arm(const MethodInput& input);

/// The photos that a run's options ask for, with the cameras as calibration has them, and the box.
PhotoInput take_photos(const Model& model, const RunOptions& options);

}  // namespace carve::experiments
