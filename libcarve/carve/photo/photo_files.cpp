#include "carve/photo/photo_files.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <locale>
#include <ostream>
#include <stdexcept>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/core/options.h"
#include "carve/image/read_image.h"
#include "carve/image/write_jpeg.h"

namespace carve {
namespace fs = std::filesystem;
namespace {

std::string numbered(int index, const char* ending) {
  char name[40];
  std::snprintf(name, sizeof name, "%08d%s", index, ending);
  return name;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(folder.string(), "cannot write: " + error.message(), IoError::Side::output);
}

// Numbers that read back to the same doubles, in the C locale.
void write_text(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  write_file(path, [&](std::ostream& out) {
    out.imbue(std::locale::classic());
    out.precision(17);
    write(out);
  });
}

void check_any(std::span<const Photo> photos) {
  if (photos.empty()) throw std::invalid_argument("there must be at least one photo to write");
  check_photos(photos);
}

// PMVS2 looks a point of the whole photo up at its place divided by 2^level, counted from the middle of the first pixel
// of the halved photo.
void write_contour(std::ostream& out, Camera camera, int level) {
  camera.principal -= Vec2::Constant(0.5 * (1 << level));
  const Eigen::Matrix<double, 3, 4> matrix = projection(camera);
  out << "CONTOUR\n";
  for (int i = 0; i < 3; ++i)
    out << matrix(i, 0) << ' ' << matrix(i, 1) << ' ' << matrix(i, 2) << ' ' << matrix(i, 3) << '\n';
}

void write_bundle_camera(std::ostream& out, const Camera& camera) {
  out << camera.focal << " 0 0\n";
  const Vec3 turn(1, -1, -1);
  const Eigen::Matrix3d rotation = turn.asDiagonal() * camera.rotation;
  for (int i = 0; i < 3; ++i) out << rotation(i, 0) << ' ' << rotation(i, 1) << ' ' << rotation(i, 2) << '\n';
  const Vec3 translation = turn.cwiseProduct(camera.translation);
  out << translation.x() << ' ' << translation.y() << ' ' << translation.z() << '\n';
}

Rgba colour_at(const Photo& photo, const Vec3& point) {
  const Vec2 at = project(photo.camera, point);
  return photo.picture(std::clamp(static_cast<int>(at.x()), 0, photo.picture.width - 1),
                       std::clamp(static_cast<int>(at.y()), 0, photo.picture.height - 1));
}

void write_pgm(std::ostream& out, const Mask& mask) {
  out << "P5\n" << mask.width << ' ' << mask.height << "\n255\n";
  for (const std::uint8_t inside : mask.pixels) out.put(static_cast<char>(inside ? 255 : 0));
}

Picture picture_of(const Mask& mask) {
  Picture picture(mask.width, mask.height, {0, 0, 0, 255});
  for (std::size_t i = 0; i < mask.pixels.size(); ++i)
    if (mask.pixels[i]) picture.pixels[i] = {255, 255, 255, 255};
  return picture;
}

}  // namespace

void write_pmvs(const fs::path& folder, std::span<const Photo> photos, bool masks, const PmvsOptions& options) {
  check("pmvs", options);
  check_any(photos);
  for (const char* part : {"visualize", "txt", "models"}) make_folder(folder / part);
  if (masks) make_folder(folder / "masks");
  for (int i = 0; i < static_cast<int>(photos.size()); ++i) {
    const Photo& photo = photos[i];
    write_file(folder / "visualize" / numbered(i, ".jpg"),
               [&](std::ostream& out) { out << encode_jpeg(photo.picture, 100); });
    write_text(folder / "txt" / numbered(i, ".txt"),
               [&](std::ostream& out) { write_contour(out, photo.camera, options.level); });
    if (masks)
      write_file(folder / "masks" / numbered(i, ".pgm"), [&](std::ostream& out) { write_pgm(out, photo.mask); });
  }
  write_text(folder / "option.txt", [&](std::ostream& out) {
    out << std::setprecision(6) << "level " << options.level << "\ncsize " << options.csize << "\nthreshold "
        << options.threshold << "\nwsize " << options.wsize << "\nminImageNum " << options.min_image_num << "\nCPU "
        << options.cpu << "\nsetEdge 0\nuseBound 0\nuseVisData 0\nsequence -1\ntimages -1 0 " << photos.size()
        << "\noimages 0\n";
  });
}

void write_bundle(const fs::path& path, std::span<const Photo> photos, std::span<const SeenPoint> points) {
  check_any(photos);
  for (const SeenPoint& point : points)
    for (const int i : point.photos)
      if (i < 0 || i >= static_cast<int>(photos.size()))
        throw std::invalid_argument("a point is in photo " + std::to_string(i) + " of " +
                                    std::to_string(photos.size()));
  write_text(path, [&](std::ostream& out) {
    out << "# Bundle file v0.3\n" << photos.size() << ' ' << points.size() << '\n';
    for (const Photo& photo : photos) write_bundle_camera(out, photo.camera);
    std::vector<int> keys(photos.size());
    for (const SeenPoint& point : points) {
      const Vec3& x = point.position;
      const Rgba colour = point.photos.empty() ? Rgba{} : colour_at(photos[point.photos[0]], x);
      out << x.x() << ' ' << x.y() << ' ' << x.z() << '\n'
          << int{colour.r} << ' ' << int{colour.g} << ' ' << int{colour.b} << '\n'
          << point.photos.size();
      for (const int i : point.photos) {
        const Vec2 at = project(photos[i].camera, x) - photos[i].camera.principal;
        out << ' ' << i << ' ' << keys[i]++ << ' ' << at.x() << ' ' << -at.y();
      }
      out << '\n';
    }
  });
}

std::string colmap_name(int index) { return numbered(index, ".png"); }

void write_colmap(const fs::path& folder, std::span<const Photo> photos) {
  check_any(photos);
  for (const char* part : {"images", "masks", "sparse"}) make_folder(folder / part);
  for (int i = 0; i < static_cast<int>(photos.size()); ++i) {
    write_png(folder / "images" / colmap_name(i), photos[i].picture);
    write_png(folder / "masks" / numbered(i, ".png.png"), picture_of(photos[i].mask));
  }
  write_text(folder / "sparse" / "cameras.txt", [&](std::ostream& out) {
    out << "# CAMERA_ID, MODEL, WIDTH, HEIGHT, fx, fy, cx, cy\n";
    for (std::size_t i = 0; i < photos.size(); ++i) {
      const Camera& c = photos[i].camera;
      out << i + 1 << " PINHOLE " << c.width << ' ' << c.height << ' ' << c.focal << ' ' << c.focal << ' '
          << c.principal.x() << ' ' << c.principal.y() << '\n';
    }
  });
  write_text(folder / "sparse" / "images.txt", [&](std::ostream& out) {
    out << "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; then its points, none\n";
    for (std::size_t i = 0; i < photos.size(); ++i) {
      const Camera& c = photos[i].camera;
      const Eigen::Quaterniond q(c.rotation);
      out << i + 1 << ' ' << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << c.translation.x() << ' '
          << c.translation.y() << ' ' << c.translation.z() << ' ' << i + 1 << ' ' << colmap_name(static_cast<int>(i))
          << "\n\n";
    }
  });
  write_text(folder / "sparse" / "points3D.txt", [](std::ostream& out) { out << "# no points yet\n"; });
}

}  // namespace carve
