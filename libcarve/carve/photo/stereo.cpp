#include "carve/photo/stereo.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

#include "carve/core/options.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Pair {
  int left, right;
};

// For each photo the one on its right whose line of sight is nearest to its own.
std::vector<Pair> pairs_of(std::span<const Photo> photos, double largest_angle) {
  std::vector<Pair> pairs;
  for (int i = 0; i < static_cast<int>(photos.size()); ++i) {
    const Camera& a = photos[i].camera;
    int best = -1;
    double best_cosine = std::cos(largest_angle * kDegree) - 1e-9;
    for (int j = 0; j < static_cast<int>(photos.size()); ++j) {
      const Camera& b = photos[j].camera;
      const Vec3 to = a.rotation * (b.centre() - a.centre());
      // To the right rather than up or forward: rectification turns the pictures little.
      if (j == i || !(to.x() > std::abs(to.y()) && to.x() > std::abs(to.z()))) continue;
      const double cosine = a.rotation.row(2).dot(b.rotation.row(2));
      if (cosine > best_cosine) best = j, best_cosine = cosine;
    }
    if (best >= 0) pairs.push_back({i, best});
  }
  return pairs;
}

// Two cameras at the same places that look in one direction, with the baseline as their pictures' x axis, and with the
// middle of the box in the middle of each picture: disparities are then small.
std::pair<Camera, Camera> rectified(const Camera& left, const Camera& right, const Vec3& middle) {
  const Vec3 x = (right.centre() - left.centre()).normalized();
  const Vec3 between = left.rotation.row(2) + right.rotation.row(2);
  const Vec3 z = (between - between.dot(x) * x).normalized();
  const auto turned = [&](Camera camera) {
    const Vec3 eye = camera.centre();
    camera.rotation.row(0) = x;
    camera.rotation.row(1) = z.cross(x);
    camera.rotation.row(2) = z;
    camera.translation = -(camera.rotation * eye);
    camera.focal = left.focal;
    camera.width = left.width, camera.height = left.height;
    camera.principal.setZero();
    camera.principal = Vec2(camera.width / 2.0, camera.height / 2.0) - project(camera, middle);
    return camera;
  };
  auto both = std::pair(turned(left), turned(right));
  // Equal but for rounding; a row of one is the same row of the other.
  both.second.principal.y() = both.first.principal.y();
  return both;
}

// OpenCV's pixel centres lie at whole numbers.
Eigen::Matrix3d opencv_intrinsics(Camera camera) {
  camera.principal -= Vec2::Constant(0.5);
  return intrinsics(camera);
}

cv::Mat homography(const Camera& from, const Camera& to) {
  const Eigen::Matrix3d h =
      opencv_intrinsics(to) * to.rotation * from.rotation.transpose() * opencv_intrinsics(from).inverse();
  cv::Mat matrix(3, 3, CV_64F);
  for (int i = 0; i < 9; ++i) matrix.at<double>(i / 3, i % 3) = h(i / 3, i % 3);
  return matrix;
}

struct Warped {
  cv::Mat colours, mask;
};

Warped warped(const Photo& photo, const Camera& to) {
  cv::Mat colours(photo.picture.height, photo.picture.width, CV_8UC3);
  for (std::size_t i = 0; i < photo.picture.pixels.size(); ++i) {
    const Rgba& p = photo.picture.pixels[i];
    colours.data[3 * i] = p.b, colours.data[3 * i + 1] = p.g, colours.data[3 * i + 2] = p.r;
  }
  cv::Mat mask(photo.mask.height, photo.mask.width, CV_8U);
  for (std::size_t i = 0; i < photo.mask.pixels.size(); ++i) mask.data[i] = photo.mask.pixels[i] ? 255 : 0;
  Warped result;
  const cv::Mat h = homography(photo.camera, to);
  const cv::Size size(to.width, to.height);
  cv::warpPerspective(colours, result.colours, h, size, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::warpPerspective(mask, result.mask, h, size, cv::INTER_NEAREST, cv::BORDER_CONSTANT, 0);
  return result;
}

// Least and largest disparity of the box's corners.
std::pair<double, double> disparities(const Camera& left, const Camera& right, const Vec3& low, const Vec3& high) {
  double least = 1e300, most = -1e300;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p(corner & 1 ? low.x() : high.x(), corner & 2 ? low.y() : high.y(), corner & 4 ? low.z() : high.z());
    if (left.in_camera(p).z() <= 0 || right.in_camera(p).z() <= 0)
      throw std::invalid_argument("stereo: the box must lie before the cameras");
    const double d = project(left, p).x() - project(right, p).x();
    least = std::min(least, d), most = std::max(most, d);
  }
  return {least, most};
}

// 255 where a window has something that can be found again.
cv::Mat textured(const cv::Mat& colours, const StereoOptions& options) {
  cv::Mat grey, least, most, range;
  cv::cvtColor(colours, grey, cv::COLOR_BGR2GRAY);
  const cv::Mat window = cv::Mat::ones(options.window, options.window, CV_8U);
  cv::erode(grey, least, window);
  cv::dilate(grey, most, window);
  cv::subtract(most, least, range);
  return range >= options.contrast;
}

DepthMap depth_map(const Photo& left, const Photo& right, const Vec3& low, const Vec3& high,
                   const StereoOptions& options) {
  const auto [left_camera, right_camera] = rectified(left.camera, right.camera, (low + high) / 2);
  const Warped a = warped(left, left_camera), b = warped(right, right_camera);
  const auto [least, most] = disparities(left_camera, right_camera, low, high);
  const int first = static_cast<int>(std::floor(least)) - 1;
  const int count = (static_cast<int>(std::ceil(most)) + 1 - first + 15) / 16 * 16;
  const int smooth = 3 * options.window * options.window;
  DepthMap map{left_camera, Raster<float>(left_camera.width, left_camera.height)};
  if (count >= left_camera.width) return map;
  const auto matcher = cv::StereoSGBM::create(first, count, options.window, 8 * smooth, 32 * smooth, 1, 0, 10, 100, 2);
  cv::Mat found;
  matcher->compute(a.colours, b.colours, found);
  cv::Mat known = textured(a.colours, options);
  if (options.masks) known &= a.mask;

  const double baseline = (right.camera.centre() - left.camera.centre()).norm();
  const double shift = left_camera.principal.x() - right_camera.principal.x();
  for (int y = 0; y < map.depth.height; ++y)
    for (int x = 0; x < map.depth.width; ++x) {
      const int sixteenths = found.at<std::int16_t>(y, x);
      if (sixteenths < 16 * first || known.at<std::uint8_t>(y, x) == 0) continue;
      const double parallax = sixteenths / 16.0 - shift;
      if (parallax > 0) map.depth(x, y) = static_cast<float>(left_camera.focal * baseline / parallax);
    }
  return map;
}

}  // namespace

std::vector<DepthMap> depth_maps(std::span<const Photo> photos, const Vec3& low, const Vec3& high,
                                 const StereoOptions& options, const Monitor& monitor) {
  check("stereo", options);
  check_photos(photos);
  if (options.window % 2 == 0)
    throw std::invalid_argument("stereo.window must be odd, got " + std::to_string(options.window));
  const std::vector<Pair> pairs = pairs_of(photos, options.angle);
  std::vector<DepthMap> maps(pairs.size());
  monitor.at("stereo", 0);
  parallel_ranges(0, static_cast<int>(pairs.size()), 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      maps[i] = depth_map(photos[pairs[i].left], photos[pairs[i].right], low, high, options);
  });
  return maps;
}

}  // namespace carve
