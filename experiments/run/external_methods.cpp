#include "run/external_methods.h"

#include <cmath>
#include <fstream>
#include <numbers>

#include "carve/core/file.h"
#include "carve/photo/photo_files.h"
#include "carve/photo/point_files.h"
#include "run/external.h"
#include "run/photo_methods.h"

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

void write_pairs(const fs::path& path, std::span<const Photo> photos, double angle) {
  const double least = std::cos(angle * std::numbers::pi / 180) - 1e-9;
  write_file(path, [&](std::ostream& out) {
    for (std::size_t i = 0; i < photos.size(); ++i)
      for (std::size_t k = i + 1; k < photos.size(); ++k)
        if (photos[i].camera.rotation.row(2).dot(photos[k].camera.rotation.row(2)) >= least)
          out << colmap_name(static_cast<int>(i)) << ' ' << colmap_name(static_cast<int>(k)) << '\n';
  });
}

}  // namespace

MethodOutput colmap_arm(const MethodInput& input) {
  const fs::path colmap = find_program("colmap");
  const std::span<const Photo> photos = input.photos.photos;
  const ExternalOptions& options = input.options.external;
  MethodOutput output{.provenance = {{"external", version_of(colmap, {"help"})}}};
  const WorkFolder folder;
  write_colmap(folder.path(), photos);
  write_pairs(folder.path() / "pairs.txt", photos, options.angle);
  fs::create_directory(folder.path() / "points");
  const OrientedPoints points = timed(output, "colmap", [&] {
    const auto run = [&](const std::vector<std::string>& arguments) {
      run_program(colmap, arguments, folder.path(), options.seconds);
    };
    std::vector<std::string> features = {"feature_extractor",
                                         "--database_path",
                                         "points.db",
                                         "--image_path",
                                         "images",
                                         "--SiftExtraction.use_gpu",
                                         "0",
                                         "--SiftExtraction.num_threads",
                                         "1"};
    if (options.masks) features.insert(features.end(), {"--ImageReader.mask_path", "masks"});
    run(features);
    run({"matches_importer", "--database_path", "points.db", "--match_list_path", "pairs.txt", "--match_type", "pairs",
         "--SiftMatching.use_gpu", "0", "--SiftMatching.num_threads", "1"});
    run({"point_triangulator", "--database_path", "points.db", "--image_path", "images", "--input_path", "sparse",
         "--output_path", "points"});
    run({"model_converter", "--input_path", "points", "--output_path", "points", "--output_type", "TXT"});
    return read_colmap_points(folder.path() / "points" / "points3D.txt", photos);
  });
  return surface_through(std::move(output), points, input);
}

MethodOutput pmvs2_arm(const MethodInput& input) {
  const fs::path pmvs2 = find_program("pmvs2");
  MethodOutput output{.provenance = {{"external", version_of(pmvs2)}}};
  const WorkFolder folder;
  write_pmvs(folder.path(), input.photos.photos, input.options.external.masks);
  const OrientedPoints points = timed(output, "pmvs2", [&] {
    run_program(pmvs2, {folder.path().string() + "/", "option.txt"}, folder.path(), input.options.external.seconds);
    return read_oriented_points(folder.path() / "models" / "option.txt.ply");
  });
  return surface_through(std::move(output), points, input);
}

}  // namespace carve::experiments
