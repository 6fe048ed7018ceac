#pragma once
#include <filesystem>

#include "artist/manifest.h"
#include "artist/model.h"

namespace carve::artist {

/// Reads a fetched model and places it (place.h): its format's reader, then the manifest's texture and colours.
/// \param folder where its files lie
/// \throws IoError: a file is missing or broken, an unknown format; std::invalid_argument: axes that cannot be
Model read_model(const Entry& entry, const std::filesystem::path& folder);

}  // namespace carve::artist
