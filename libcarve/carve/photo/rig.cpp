#include "carve/photo/rig.h"

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "carve/core/options.h"

namespace carve {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kBorder = 1.02;  // the sphere keeps this much off the picture's border

std::vector<double> elevations_of(const RigOptions& options) {
  std::vector<double> values;
  for (const std::string& text : options.elevations) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= 89))
      throw std::invalid_argument("rig.elevations must be degrees in [-89, 89], got " + text);
    values.push_back(value);
  }
  if (values.empty()) throw std::invalid_argument("rig.elevations must name at least one height");
  return values;
}

// Box and Muller's: the standard library's normal distribution differs from one implementation to the next.
double gauss(std::mt19937_64& random) {
  const auto unit = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  const double radius = std::sqrt(-2 * std::log(unit()));
  return radius * std::cos(2 * std::numbers::pi * unit());
}

Vec3 gauss3(std::mt19937_64& random) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = gauss(random);
  return v;
}

}  // namespace

std::vector<Camera> rig(const Vec3& low, const Vec3& high, const RigOptions& options) {
  check("rig", options);
  const std::vector<double> elevations = elevations_of(options);
  const Vec3 target = (low + high) / 2;
  const double radius = (high - low).norm() / 2;
  if (!(radius > 0 && std::isfinite(radius))) throw std::invalid_argument("a rig needs a box with an extent");
  const double distance = kBorder * radius / std::sin(options.field_of_view / 2 * kDegree);
  const auto camera = [&](const Vec3& towards, const Vec3& up) {
    return look_at(target + distance * towards, target, up, options.size, options.size, options.field_of_view);
  };

  std::vector<Camera> cameras;
  const int ring = options.views - (options.top ? 1 : 0);
  const double step = options.step.value_or(std::min(90.0, 360.0 / std::max(1, ring)));
  for (int i = 0; i < ring; ++i) {
    const double azimuth = i * step * kDegree, elevation = elevations[i % elevations.size()] * kDegree;
    cameras.push_back(
        camera({std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation)},
               Vec3::UnitY()));
  }
  if (options.top) cameras.push_back(camera(Vec3::UnitY(), -Vec3::UnitZ()));
  return cameras;
}

std::vector<Camera> with_pose_noise(std::vector<Camera> cameras, const Vec3& target, const PoseNoiseOptions& options) {
  check("pose_noise", options);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    Camera& camera = cameras[i];
    std::mt19937_64 random(static_cast<std::uint64_t>(options.seed) << 32 | i);
    const Vec3 turn = options.rotation * kDegree * gauss3(random) / std::sqrt(3.0);
    const Vec3 eye = camera.centre() + options.position / 100 * (camera.centre() - target).norm() * gauss3(random);
    if (turn.norm() > 0)
      camera.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * camera.rotation;
    camera.translation = -(camera.rotation * eye);
  }
  return cameras;
}

}  // namespace carve
