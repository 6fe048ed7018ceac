#pragma once
#include <filesystem>
#include <stdexcept>

#include "carve/core/error.h"

namespace carve {

/// work(), and what it finds wrong with a mesh is told with the name of the mesh's file.
template <class Work>
auto about(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw IoError(file.string(), error.what());
  }
}

}  // namespace carve
