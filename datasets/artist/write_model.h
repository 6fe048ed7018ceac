#pragma once
#include <filesystem>

#include "artist/model.h"

namespace carve::artist {

/// Writes FOLDER/NAME.obj, FOLDER/NAME.mtl and the textures, NAME_0.png or .jpg and so on, where NAME is the folder's.
/// The dialect that every reader of the project relies on: `mtllib`, `v`, `vt` (origin bottom left, repeating), then by
/// material `usemtl` and `f a/b c/d e/f`; `newmtl`, `Kd` (sRGB, 0..1) and `map_Kd` (Kd is then 1 1 1).
/// \param source the folder the textures lie in; PNG and JPEG are copied, Targa becomes PNG
/// \throws IoError: a texture is missing or no picture, a file cannot be written
void write_model(const std::filesystem::path& folder, const Model& model, const std::filesystem::path& source);

}  // namespace carve::artist
