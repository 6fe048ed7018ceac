#pragma once
#include <filesystem>
#include <map>

#include "carve/image/drawing.h"
#include "carve/views/frame.h"

namespace carve {

/// The drawings in these files, each understood by itself. \throws IoError naming the file: unreadable, not an image,
/// nothing but background or nothing but object
std::map<View, Drawing> read_drawings(const std::map<View, std::filesystem::path>& paths,
                                      const DrawingOptions& options = {});

}  // namespace carve
