#include "run/external_methods.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

#include "carve/core/error.h"
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

std::vector<std::string> gen_option_arguments(const std::string& prefix, const PmvsOptions& options) {
  char threshold[32];
  std::snprintf(threshold, sizeof threshold, "%g", options.threshold);
  return {prefix,
          std::to_string(options.level),
          std::to_string(options.csize),
          threshold,
          std::to_string(options.wsize),
          std::to_string(options.min_image_num),
          std::to_string(options.cpu)};
}

// option-0000, option-0001, ... of a folder.
std::vector<std::string> option_files(const fs::path& folder) {
  std::vector<std::string> found;
  for (char name[32];; found.emplace_back(name)) {
    std::snprintf(name, sizeof name, "option-%04zu", found.size());
    if (!fs::exists(folder / name)) break;
  }
  if (found.empty()) throw IoError((folder / "option-0000").string(), "genOption did not write it");
  return found;
}

// How many photos each of the option files names: "9, 8".
std::string sizes_of(const fs::path& folder, const std::vector<std::string>& option_files) {
  std::string sizes;
  for (const std::string& file : option_files) {
    std::istringstream words(read_file(folder / file));
    std::string word;
    while (words >> word && word != "timages") continue;
    words >> word;
    sizes += (sizes.empty() ? "" : ", ") + word;
  }
  return sizes;
}

void add(OrientedPoints& all, const OrientedPoints& more) {
  all.positions.insert(all.positions.end(), more.positions.begin(), more.positions.end());
  all.normals.insert(all.normals.end(), more.normals.begin(), more.normals.end());
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
  write_pmvs(folder.path(), input.photos.photos, input.options.external.masks, input.options.pmvs);
  const OrientedPoints points = timed(output, "pmvs2", [&] {
    run_program(pmvs2, {folder.path().string() + "/", "option.txt"}, folder.path(), input.options.external.seconds);
    return read_oriented_points(folder.path() / "models" / "option.txt.ply");
  });
  return surface_through(std::move(output), points, input);
}

MethodOutput cmvs_arm(const MethodInput& input) {
  const fs::path cmvs = find_program("cmvs"), gen_option = find_program("genOption"), pmvs2 = find_program("pmvs2");
  const std::vector<Photo>& photos = input.photos.photos;
  const ExternalOptions& external = input.options.external;
  MethodOutput output{
      .provenance = {{"external", version_of(cmvs) + "; " + version_of(gen_option) + "; " + version_of(pmvs2)}}};
  PatchOptions matching = input.options.patches;
  matching.masks = external.masks;
  const std::vector<SeenPoint> seen = timed(
      output, "features", [&] { return matched_features(photos, input.photos.low, input.photos.high, matching); });
  if (seen.empty()) throw NoResult("no feature that photos agree on, which cmvs could group them by");
  const WorkFolder folder;
  write_pmvs(folder.path(), photos, external.masks, input.options.pmvs);
  write_bundle(folder.path() / "bundle.rd.out", photos, seen);
  const std::string prefix = folder.path().string() + "/";
  const std::vector<std::string> clusters = timed(output, "cmvs", [&] {
    run_program(cmvs, {prefix, std::to_string(external.max_images), std::to_string(input.options.pmvs.cpu)},
                folder.path(), external.seconds);
    run_program(gen_option, gen_option_arguments(prefix, input.options.pmvs), folder.path(), external.seconds);
    return option_files(folder.path());
  });
  output.provenance["clusters"] =
      sizes_of(folder.path(), clusters) + " of " + std::to_string(photos.size()) + " photos";
  const OrientedPoints points = timed(output, "pmvs2", [&] {
    OrientedPoints all;
    for (const std::string& cluster : clusters) {
      run_program(pmvs2, {prefix, cluster}, folder.path(), external.seconds);
      add(all, read_oriented_points(folder.path() / "models" / (cluster + ".ply")));
    }
    return all;
  });
  return surface_through(std::move(output), points, input);
}

}  // namespace carve::experiments
