#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "carve/photo/camera.h"

namespace carve {

/// PMVS2's folder \cite furukawa_2010: visualize/%08d.jpg (quality 100), txt/%08d.txt (CONTOUR and P, for pixel centres
/// at whole numbers as PMVS2 has them), masks/%08d.pgm (white = object) if `masks`, and option.txt with the paper's
/// parameters: level 1, csize 2, wsize 7, threshold 0.7, minImageNum 3. Run as `pmvs2 FOLDER/ option.txt`.
/// \throws IoError; std::invalid_argument if there are no photos
void write_pmvs(const std::filesystem::path& folder, std::span<const Photo> photos, bool masks = true);

/// The name of photo `index` in COLMAP's folder: %08d.png.
std::string colmap_name(int index);

/// COLMAP's text model with known poses \cite schoenberger_2016: images/%08d.png, masks/%08d.png.png (black = ignored),
/// sparse/{cameras,images,points3D}.txt with one PINHOLE camera a photo and no points; pixel centres as here.
/// \throws as write_pmvs
void write_colmap(const std::filesystem::path& folder, std::span<const Photo> photos);

}  // namespace carve
