#pragma once
#include <filesystem>

#include "carve/photo/stereo.h"

namespace carve {

/// Points with unit normals from a PLY file (x, y, z, nx, ny, nz of its vertices; text or binary little endian; the
/// rest is skipped) or, by the name's ending .pset, from lines "x y z nx ny nz", as PMVS2 writes both \cite
/// furukawa_2010. Points whose normal is 0 are left out. \throws IoError naming the place: missing, truncated, without
/// normals, numbers that are not finite
OrientedPoints read_oriented_points(const std::filesystem::path& path);

/// The points of COLMAP's text model (points3D.txt) \cite schoenberger_2016; their normals are those of planes through
/// neighbours, turned to the photos that see them. \param photos  those that write_colmap was given
/// \throws IoError as read_oriented_points
OrientedPoints read_colmap_points(const std::filesystem::path& path, std::span<const Photo> photos);

}  // namespace carve
