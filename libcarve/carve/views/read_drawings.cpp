#include "carve/views/read_drawings.h"

#include <utility>

#include "carve/core/error.h"
#include "carve/image/read_image.h"

namespace carve {

std::map<View, Drawing> read_drawings(const std::map<View, std::filesystem::path>& paths,
                                      const DrawingOptions& options) {
  std::map<View, Drawing> drawings;
  for (const auto& [view, path] : paths) {
    Picture picture = read_image(path);
    try {
      drawings.emplace(view, understand_drawing(std::move(picture), options));
    } catch (const NoResult& nothing) {
      throw IoError(path.string(), nothing.what());
    }
  }
  return drawings;
}

}  // namespace carve
