#pragma once
#include <filesystem>
#include <string>

#include "models/model.h"
#include "run/settings.h"
#include "store/record.h"

namespace carve::experiments {

/// What runs of one results folder share is made by the first that needs it; `content` is the model's hash.

/// The outer surface of a model, which distances are measured to; in the folder's kReferences.
Mesh reference_of(const std::filesystem::path& results, const Model& model, const std::string& content);

/// The model's concept art as options.synthesize and options.degrade have it; in the folder's kConceptArt.
std::map<View, Picture> concept_art_of(const std::filesystem::path& results, const Model& model,
                                       const std::string& content, RunOptions& options);

}  // namespace carve::experiments
