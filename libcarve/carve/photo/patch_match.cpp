#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "carve/core/parallel.h"
#include "carve/photo/patch_photometry.h"

namespace carve {
namespace {

constexpr int kBlock = 16;      // pixels, at the patches' level
constexpr int kInBlock = 4;     // features of a kind
constexpr double kOffLine = 2;  // pixels from an epipolar line
constexpr double kBefore = 0.3;

enum Kind { corner, blob, kKinds };

struct Feature {
  Vec2 at;
  Kind kind;
};

// The strongest local maxima of each block.
void strongest(const cv::Mat& response, const PatchView& view, Kind kind, std::vector<Feature>& out) {
  struct Peak {
    float strength;
    int x, y;
  };
  for (int by = 0; by < view.camera.height; by += kBlock)
    for (int bx = 0; bx < view.camera.width; bx += kBlock) {
      std::vector<Peak> peaks;
      for (int y = std::max(1, by); y < std::min(by + kBlock, view.camera.height - 1); ++y)
        for (int x = std::max(1, bx); x < std::min(bx + kBlock, view.camera.width - 1); ++x) {
          const float r = response.at<float>(y, x);
          if (!view.usable(x, y) || r <= 1e-3f) continue;
          bool most = true;
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) most &= response.at<float>(y + dy, x + dx) <= r;
          if (most) peaks.push_back({r, x, y});
        }
      std::stable_sort(peaks.begin(), peaks.end(),
                       [](const Peak& a, const Peak& b) { return a.strength > b.strength; });
      if (peaks.size() > kInBlock) peaks.resize(kInBlock);
      for (const Peak& p : peaks) out.push_back({Vec2(p.x + 0.5, p.y + 0.5), kind});
    }
}

// Harris's corners, and differences of Gaussians.
std::vector<Feature> features_of(const PatchView& view) {
  cv::Mat grey(view.camera.height, view.camera.width, CV_32F), response, narrow, wide;
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x) grey.at<float>(y, x) = view.colours(x, y).mean();
  std::vector<Feature> found;
  cv::cornerHarris(grey / 255, response, 3, 3, 0.06);
  strongest(response, view, corner, found);
  cv::GaussianBlur(grey, narrow, {}, 1);
  cv::GaussianBlur(grey, wide, {}, 1.4);
  strongest(cv::abs(narrow - wide), view, blob, found);
  return found;
}

// x' F x = 0 for pictures x of the first camera, x' of the second.
Eigen::Matrix3d fundamental(const Camera& a, const Camera& b) {
  const Eigen::Matrix3d turn = b.rotation * a.rotation.transpose();
  const Vec3 t = b.translation - turn * a.translation;
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  return intrinsics(b).inverse().transpose() * cross * turn * intrinsics(a).inverse();
}

// Depth along the first ray where it is nearest to the second; negative if they are parallel.
double depth_of(const Camera& a, const Vec3& ra, const Camera& b, const Vec3& rb) {
  const Vec3 between = b.centre() - a.centre();
  const double aa = ra.squaredNorm(), ab = ra.dot(rb), bb = rb.squaredNorm(), determinant = aa * bb - ab * ab;
  if (determinant < 1e-12 * aa * bb) return -1;
  return (between.dot(ra) * bb - between.dot(rb) * ab) / determinant;
}

class Matcher {
 public:
  explicit Matcher(const Photometry& photometry) : photometry_(photometry), features_(photometry.views().size()) {
    parallel_ranges(0, count(), 1, [&](int first, int last) {
      for (int i = first; i < last; ++i) features_[i] = features_of(photometry.views()[i]);
    });
  }

  std::vector<Patch> run() const {
    std::vector<std::vector<Patch>> found(features_.size());
    parallel_ranges(0, count(), 1, [&](int first, int last) {
      for (int i = first; i < last; ++i) found[i] = seeds_of(i);
    });
    std::vector<Patch> all;
    for (auto& seeds : found) all.insert(all.end(), seeds.begin(), seeds.end());
    return all;
  }

 private:
  int count() const { return static_cast<int>(features_.size()); }

  std::vector<Patch> seeds_of(int view) const {
    const PatchView& a = photometry_.views()[view];
    std::vector<int> others = a.neighbours;
    if (others.size() >= static_cast<std::size_t>(photometry_.options().images))
      others.resize(photometry_.options().images - 1);
    std::vector<Eigen::Matrix3d> lines;
    lines.reserve(others.size());
    for (const int other : others) lines.push_back(fundamental(a.camera, photometry_.views()[other].camera));
    std::vector<Patch> found;
    for (const Feature& f : features_[view])
      if (auto patch = seed(view, f, others, lines)) found.push_back(std::move(*patch));
    return found;
  }

  // The candidates nearest to the camera first, as the nearest surface hides the others.
  std::optional<Patch> seed(int view, const Feature& f, const std::vector<int>& others,
                            const std::vector<Eigen::Matrix3d>& lines) const {
    const Camera& a = photometry_.views()[view].camera;
    const Vec3 eye = a.centre(), towards = ray(a, f.at);
    std::vector<double> depths;
    for (std::size_t k = 0; k < others.size(); ++k) {
      const Camera& b = photometry_.views()[others[k]].camera;
      const Vec3 line = lines[k] * f.at.homogeneous();
      const double length = line.head<2>().norm();
      for (const Feature& g : features_[others[k]]) {
        if (g.kind != f.kind || std::abs(line.dot(g.at.homogeneous())) > kOffLine * length) continue;
        const double depth = depth_of(a, towards, b, ray(b, g.at));
        if (depth <= 0 || !photometry_.in_box(eye + depth * towards)) continue;
        const Patch patch{eye + depth * towards, -towards.normalized()};
        if (photometry_.agreement(patch, view, others[k]) >= photometry_.options().threshold - kBefore)
          depths.push_back(depth);
      }
    }
    std::sort(depths.begin(), depths.end());
    for (const double depth : depths)
      if (auto patch = photometry_.refined({eye + depth * towards, -towards.normalized()}, view)) return patch;
    return {};
  }

  const Photometry& photometry_;
  std::vector<std::vector<Feature>> features_;
};

}  // namespace

std::vector<Patch> match_features(const Photometry& photometry) { return Matcher(photometry).run(); }

}  // namespace carve
