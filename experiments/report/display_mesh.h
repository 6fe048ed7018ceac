#pragma once
#include <string>

#include "carve/mesh/mesh.h"

namespace carve::experiments {

/// A mesh simplified to about `triangles` (it stays as it is if it has fewer) and packed for report/viewer.js:
/// positions in 16 bits a coordinate of the box, indices as distances from the next new vertex, deflated, base64. The
/// same mesh gives the same text. \throws std::invalid_argument on a mesh without triangles
std::string packed(const Mesh& mesh, int triangles);

/// Bytes as text that may stand in a URL's data or an HTML element.
std::string base64(const std::string& bytes);

}  // namespace carve::experiments
