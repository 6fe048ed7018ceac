#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "carve/photo/patches.h"

namespace carve {

/// What PMVS2's option file says, by its names there; defaults as in the paper.
struct PmvsOptions {
  int level = 1;
  int csize = 2;
  double threshold = 0.7;
  int wsize = 7;
  int min_image_num = 3;
  int cpu = 1;
};
template <class Visitor>
void visit_fields(PmvsOptions& o, Visitor&& field) {
  field("level", o.level, 0, 8, "photos are halved so many times");
  field("csize", o.csize, 1, 64, "side of the cells that get a patch each, in pixels of the halved photos");
  field("threshold", o.threshold, 0.0, 1.0, "least normalised cross-correlation of photos that agree");
  field("wsize", o.wsize, 3, 21, "side of the windows that are compared, in the same pixels");
  field("min_image_num", o.min_image_num, 2, 100, "photos that must agree on a patch");
  field("cpu", o.cpu, 1, 64, "threads; with more than 1 its results may vary");
}

/// PMVS2's folder \cite furukawa_2010: visualize/%08d.jpg (quality 100), txt/%08d.txt (CONTOUR and P, for pixel centres
/// of the halved photos at whole numbers as PMVS2 has them: 2^level / 2 pixels before ours), masks/%08d.pgm (white =
/// object) if `masks`, and option.txt. Run as `pmvs2 FOLDER/ option.txt`. \throws IoError; std::invalid_argument if
/// there are no photos or an option is out of range
void write_pmvs(const std::filesystem::path& folder, std::span<const Photo> photos, bool masks = true,
                const PmvsOptions& options = {});

/// Bundler's file of cameras and points, which CMVS reads as bundle.rd.out beside PMVS2's folders
/// \cite furukawa_2010_cmvs: camera axes x right, y up, z backwards; places in pictures from the principal point, y up.
/// \throws as write_pmvs; std::invalid_argument if a point is said to be in a photo that there is not
void write_bundle(const std::filesystem::path& path, std::span<const Photo> photos, std::span<const SeenPoint> points);

/// The name of photo `index` in COLMAP's folder: %08d.png.
std::string colmap_name(int index);

/// COLMAP's text model with known poses \cite schoenberger_2016: images/%08d.png, masks/%08d.png.png (black = ignored),
/// sparse/{cameras,images,points3D}.txt with one PINHOLE camera a photo and no points; pixel centres as here.
/// \throws as write_pmvs
void write_colmap(const std::filesystem::path& folder, std::span<const Photo> photos);

}  // namespace carve
