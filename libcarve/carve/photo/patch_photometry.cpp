#include "carve/photo/patch_photometry.h"

#include <ceres/tiny_solver.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "carve/core/parallel.h"
#include "carve/photo/patch_window.h"

namespace carve {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kBefore = 0.3;  // photos whose NCC is so much below the threshold may still take part in refinement
constexpr int kSteps = 12;

PatchView halved(const Photo& photo, const PatchOptions& options) {
  PatchView view{photo.camera, {}, {}, {}};
  const int factor = 1 << options.level, width = photo.camera.width >> options.level,
            height = photo.camera.height >> options.level;
  view.camera.width = width, view.camera.height = height;
  view.camera.focal /= factor, view.camera.principal /= factor;
  view.colours = Raster<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero());
  view.usable = Mask(width, height, 1);
  for (int y = 0; y < height * factor; ++y)
    for (int x = 0; x < width * factor; ++x) {
      const Rgba& p = photo.picture(x, y);
      view.colours(x / factor, y / factor) += Eigen::Vector3f(p.r, p.g, p.b) / static_cast<float>(factor * factor);
      if (options.masks && !photo.mask(x, y)) view.usable(x / factor, y / factor) = 0;
    }
  return view;
}

// Depth and the two angles of a normal, as Ceres sees them: what the reference shows of the patch stays as it is, the
// others' windows come to it. Parameters: pixels of depth, radians.
class Misfit {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = 3 };

  Misfit(const Photometry& photometry, const Patch& patch, int reference, std::vector<int> views)
      : photometry_(photometry),
        views_(std::move(views)),
        plane_(plane_view(photometry.views()[reference].camera, patch.centre, patch.normal)),
        depth_(1 / plane_.w.x()),
        normal_(patch.normal),
        first_(patch.normal.unitOrthogonal()),
        second_(patch.normal.cross(first_)) {
    valid_ = window(photometry.views()[reference], plane_, photometry.options().wsize, target_);
  }

  bool valid() const { return valid_; }
  int NumResiduals() const { return static_cast<int>(views_.size() * target_.size()); }

  Vec3 normal(const double* x) const {
    return std::cos(x[1]) * std::cos(x[2]) * normal_ + std::sin(x[1]) * std::cos(x[2]) * first_ +
           std::sin(x[2]) * second_;
  }
  Vec3 centre(const double* x) const { return plane_.reference->centre() + depth(x) * plane_.from; }

  bool operator()(const double* x, double* residuals, double* jacobian) const {
    Eigen::Map<Eigen::VectorXd> r(residuals, NumResiduals());
    Eigen::Map<Eigen::MatrixX3d> j(jacobian, jacobian ? NumResiduals() : 0, 3);
    const Eigen::Index n = target_.size();
    const double z = depth(x);
    const Vec3 normal = this->normal(x);
    const double steep = normal.dot(plane_.from);
    PlaneView plane = plane_;
    plane.w = Vec3(steep, normal.dot(plane_.right), normal.dot(plane_.down)) / (steep * z);
    const Eigen::Matrix3d by_parameters = slopes(x, plane.w, z, steep);
    Window w;
    WindowSlopes by_plane;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      auto part = r.segment(static_cast<Eigen::Index>(i) * n, n);
      if (z > 0 && steep < 0 &&
          window(photometry_.views()[views_[i]], plane, photometry_.options().wsize, w,
                 jacobian ? &by_plane : nullptr)) {
        part = w - target_;
        if (jacobian) j.middleRows(static_cast<Eigen::Index>(i) * n, n) = by_plane * by_parameters;
      } else {  // off the object: as bad as the opposite
        part = -2 * target_;
        if (jacobian) j.middleRows(static_cast<Eigen::Index>(i) * n, n).setZero();
      }
    }
    return true;
  }

 private:
  double depth(const double* x) const { return depth_ * (1 + x[0] / plane_.reference->focal); }

  // Of the plane's w by the parameters.
  Eigen::Matrix3d slopes(const double* x, const Vec3& w, double z, double steep) const {
    Eigen::Matrix3d rays;
    rays.row(0) = plane_.from, rays.row(1) = plane_.right, rays.row(2) = plane_.down;
    const Eigen::Matrix3d by_normal = (rays - w * z * plane_.from.transpose()) / (steep * z);
    Eigen::Matrix3d result;
    result.col(0) = -w / z * depth_ / plane_.reference->focal;
    result.col(1) = by_normal * (std::cos(x[2]) * (std::cos(x[1]) * first_ - std::sin(x[1]) * normal_));
    result.col(2) =
        by_normal * (std::cos(x[2]) * second_ - std::sin(x[2]) * (std::cos(x[1]) * normal_ + std::sin(x[1]) * first_));
    return result;
  }

  const Photometry& photometry_;
  std::vector<int> views_;
  PlaneView plane_;
  double depth_;
  Vec3 normal_, first_, second_;
  Window target_;
  bool valid_ = false;
};

}  // namespace

Photometry::Photometry(std::span<const Photo> photos, const Vec3& low, const Vec3& high, const PatchOptions& options)
    : options_(options), low_(low), high_(high), least_cosine_(std::cos(options.angle * kDegree)) {
  const int count = static_cast<int>(photos.size());
  views_.resize(count);
  parallel_ranges(0, count, 1, [&](int first, int last) {
    for (int i = first; i < last; ++i) views_[i] = halved(photos[i], options);
  });
  const Vec3 middle = (low + high) / 2;
  const auto towards = [&](int i) { return (views_[i].camera.centre() - middle).normalized(); };
  const double least = std::cos(std::min(180.0, 2 * options.angle) * kDegree) - 1e-9;
  for (int i = 0; i < count; ++i) {
    std::vector<std::pair<double, int>> near;
    for (int k = 0; k < count; ++k)
      if (const double cosine = towards(i).dot(towards(k)); k != i && cosine > least)
        near.emplace_back(-std::round(cosine * 1e9), k);  // equal angles in the photos' order
    std::sort(near.begin(), near.end());
    for (const auto& [_, k] : near) views_[i].neighbours.push_back(k);
  }
}

double Photometry::cell_size(int view, const Vec3& point) const {
  const Camera& camera = views_[view].camera;
  return options_.csize * camera.in_camera(point).z() / camera.focal;
}

double Photometry::agreement(const Patch& patch, int reference, int view) const {
  const PlaneView plane = plane_view(views_[reference].camera, patch.centre, patch.normal);
  Window a, b;
  if (!window(views_[reference], plane, options_.wsize, a) || !window(views_[view], plane, options_.wsize, b))
    return -1;
  return a.dot(b);
}

// The reference and those of its neighbours that the patch faces and that show the same there.
std::vector<int> Photometry::agreeing(const Patch& patch, int reference, double threshold, double& score) const {
  const auto faces = [&](int v) {
    const Vec3 to = views_[v].camera.centre() - patch.centre;
    return patch.normal.dot(to) >= least_cosine_ * to.norm();
  };
  score = 0;
  Window target, w;
  const PlaneView plane = plane_view(views_[reference].camera, patch.centre, patch.normal);
  if (!faces(reference) || !window(views_[reference], plane, options_.wsize, target)) return {};
  std::vector<int> found{reference};
  for (const int v : views_[reference].neighbours) {
    if (!faces(v) || !window(views_[v], plane, options_.wsize, w)) continue;
    const double ncc = target.dot(w);
    if (ncc >= threshold) found.push_back(v), score += ncc;
  }
  if (found.size() > 1) score /= static_cast<double>(found.size() - 1);
  return found;
}

std::optional<Patch> Photometry::refined(Patch patch, int reference) const {
  const std::size_t least = static_cast<std::size_t>(options_.min_image_num);
  std::vector<int> others = agreeing(patch, reference, options_.threshold - kBefore, patch.score);
  if (others.size() < least) return {};
  if (others.size() > static_cast<std::size_t>(options_.images)) others.resize(options_.images);
  others.erase(others.begin());
  const Misfit misfit(*this, patch, reference, std::move(others));
  if (!misfit.valid()) return {};
  ceres::TinySolver<Misfit> solver{};
  solver.options.max_num_iterations = kSteps;
  solver.options.function_tolerance = 1e-4;
  Vec3 x = Vec3::Zero();
  solver.Solve(misfit, &x);
  if (!x.allFinite()) return {};
  patch.normal = misfit.normal(x.data()).normalized();
  patch.centre = misfit.centre(x.data());
  if (!in_box(patch.centre)) return {};
  patch.views = agreeing(patch, reference, options_.threshold, patch.score);
  if (patch.views.size() < least) return {};
  return patch;
}

}  // namespace carve
