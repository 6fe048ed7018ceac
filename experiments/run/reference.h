#pragma once
#include <filesystem>
#include <string>

#include "models/model.h"
#include "store/record.h"

namespace carve::experiments {

/// The outer surface of a model, which distances are measured to. Made once for all runs of a results folder, in its
/// kReferences; `content` is the model's hash.
Mesh reference_of(const std::filesystem::path& results, const Model& model, const std::string& content);

}  // namespace carve::experiments
