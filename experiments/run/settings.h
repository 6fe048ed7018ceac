#pragma once
#include "carve/core/options.h"
#include "carve/photo/photo_files.h"
#include "carve/photo/rig.h"
#include "carve/photo/space_carving.h"
#include "carve/photo/stereo.h"
#include "carve/pipeline/reconstruct.h"
#include "eval/compare.h"
#include "photograph/photograph.h"
#include "run/spec.h"
#include "synthesize/synthesize.h"

namespace carve::experiments {

/// Of methods that other programs do.
struct ExternalOptions {
  bool masks = true;
  double seconds = 600;
  double angle = 30;  // degrees
  int max_images = 100;
};
template <class Visitor>
void visit_fields(ExternalOptions& o, Visitor&& field) {
  field("masks", o.masks, "the program gets the masks");
  field("seconds", o.seconds, 0.1, 1e6, "a program that runs longer is stopped");
  field("angle", o.angle, 0.1, 180.0,
        "largest angle in degrees between two photos whose features are matched by colmap");
  field("max_images", o.max_images, 2, 10000, "photos in a cluster of cmvs, at most");
}

/// Every option that a spec may set: the pipeline's as in carve build, "synthesize.*", "degrade.*", "evaluate.*" and
/// those of photos.
struct RunOptions {
  PipelineOptions pipeline;
  SynthesizeOptions synthesize;
  DegradeOptions degrade;  // its seed is the run's
  CompareOptions evaluate;
  RigOptions rig;  // of photos: where from, with what error, of what
  PoseNoiseOptions pose_noise;
  PhotographOptions photograph;
  SolidTextureOptions solid_texture;
  SpaceCarvingOptions space_carving;
  StereoOptions stereo;
  PatchOptions patches;
  ExternalOptions external;
  PmvsOptions pmvs;  // of pmvs2, whether cmvs ran before it or not
};

std::vector<Field> fields(RunOptions& options);

/// \throws std::invalid_argument naming field, range and value
void apply(RunOptions& options, const Settings& settings);

/// The value that switches a field's part of the method off ("none", "off", 0). \throws std::invalid_argument if it has
/// none
std::string switched_off(const std::string& field);

}  // namespace carve::experiments
