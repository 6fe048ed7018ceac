#pragma once
#include <filesystem>
#include <string>

#include "models/model.h"

namespace carve::experiments {

inline constexpr const char* kReferences = "references";   // folder below the results
inline constexpr const char* kReferenceKey = "reference";  // in a record's provenance: the file's name without .ply

/// The outer surface of a model, which distances are measured to. Made once for all runs of a results folder; `content`
/// is the model's hash.
Mesh reference_of(const std::filesystem::path& results, const Model& model, const std::string& content);

}  // namespace carve::experiments
