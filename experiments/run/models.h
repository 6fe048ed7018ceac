#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models/model.h"
#include "synthesize/synthesize.h"

namespace carve::experiments {

/// What a run reconstructs: a base model, which is ground truth and is drawn by synthesize, or drawings made by hand,
/// which have none.
struct Subject {
  std::optional<Model> model;
  std::map<View, Picture> drawings;
};

/// Subjects are procedural models by name ("couch"), artists' models that were fetched and imported
/// ("artist/dog_scopia", below $CARVE_ARTIST_MODELS), those of them that nobody tunes on ("held_out/deer", below
/// $CARVE_HELD_OUT_MODELS) and hand-made drawings ("drawing/dragon", PNGs below $CARVE_DRAWINGS); experiments/reproduce
/// makes these folders.
std::vector<std::string> known_subjects();

/// Names, globs ("stairs_*") and sets ("set:thesis": axe, dog, head, robot; "set:procedural", "set:artist",
/// "set:held_out", "set:drawing"). What is held out is in no other set, and no glob matches it unless it says
/// "held_out/". A set, or what has a folder in its name, may match nothing: not every machine has the artists' models.
/// \throws std::invalid_argument for procedural models or a set that there are not
std::vector<std::string> expand_subjects(const std::vector<std::string>& patterns);

/// \throws std::invalid_argument if there is none; IoError if its files cannot be read
Subject make_subject(const std::string& name);

/// Hash of geometry, colours, textures and drawings.
std::string content_hash(const Subject& subject);

}  // namespace carve::experiments
