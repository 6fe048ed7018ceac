#include "photograph/photograph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "models/ray_scene.h"

namespace carve {
namespace {

constexpr double kGrey = 0.75;
constexpr double kAmbient = 0.3;

struct Lamp {
  Vec3 direction;  // towards the lamp, unit
  double power;
};
// In the model's axes (right, up, towards the front's viewer) or the camera's (right, up, towards the camera).
const Lamp kLamps[] = {{Vec3(0.45, 0.75, 0.5).normalized(), 0.55}, {Vec3(-0.7, 0.1, -0.7).normalized(), 0.35}};
const Lamp kTurningLamps[] = {{Vec3(-0.5, 0.6, 0.6).normalized(), 0.7}};

Vec3 colour_of_text(const std::string& text) {
  const bool hex =
      text.size() == 7 && text[0] == '#' && text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!hex) throw std::invalid_argument("photograph.background must be #rrggbb, got " + text);
  const auto channel = [&](int at) { return std::stoi(text.substr(at, 2), nullptr, 16) / 255.0; };
  return {channel(1), channel(3), channel(5)};
}

Vec3 vector_of(const Rgba& c) { return {c.r / 255.0, c.g / 255.0, c.b / 255.0}; }

// Bilinear, repeating, v = 0 at the lower edge.
Vec3 texel(const Picture& texture, const Vec2& uv) {
  const auto wrapped = [](double t, int n) { return (t - std::floor(t)) * n - 0.5; };
  const double x = wrapped(uv.x(), texture.width), y = wrapped(1 - uv.y(), texture.height);
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto at = [&](int a, int b) {
    return vector_of(texture((a + texture.width) % texture.width, (b + texture.height) % texture.height));
  };
  const double u = x - i, v = y - j;
  return (at(i, j) * (1 - u) + at(i + 1, j) * u) * (1 - v) + (at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u) * v;
}

class Studio {
 public:
  Studio(const Model& model, const PhotographOptions& options, const SolidTextureOptions& texture)
      : model_(model),
        options_(options),
        texture_(texture),
        scene_(model.mesh),
        background_(colour_of_text(options.background)) {
    const auto [low, high] = bounds(model.mesh);
    side_ = (high - low).maxCoeff();
    low_ = low, high_ = high;
  }

  Photo take(const Camera& camera) const {
    Photo photo{camera, Picture(camera.width, camera.height), Mask(camera.width, camera.height)};
    const Box box = seen_box(camera);
    const Vec3 base = ray(camera, {0, 0}), right = ray(camera, {1, 0}) - base, down = ray(camera, {0, 1}) - base;
    const Rgba empty = pixel_of(background_);
    std::fill(photo.picture.pixels.begin(), photo.picture.pixels.end(), empty);
    const int n = options_.samples;
    parallel_ranges(box.y0, box.y1, 4, [&](int first, int last) {
      for (int y = first; y < last; ++y)
        for (int x = box.x0; x < box.x1; ++x) {
          Vec3 sum = Vec3::Zero();
          int hits = 0;
          for (int k = 0; k < n * n; ++k) {
            const Vec3 direction = base + (x + (k % n + 0.5) / n) * right + (y + (k / n + 0.5) / n) * down;
            const auto seen = colour(camera, direction);
            sum += seen.value_or(background_);
            hits += seen.has_value();
          }
          photo.picture(x, y) = pixel_of(sum / (n * n));
          photo.mask(x, y) = 2 * hits >= n * n;
        }
    });
    return photo;
  }

 private:
  static Rgba pixel_of(const Vec3& colour) {
    const auto channel = [](double v) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0))); };
    return {channel(colour.x()), channel(colour.y()), channel(colour.z()), 255};
  }

  // The pixels that may show the model: its box's corners' bounds, or everything if one lies behind the camera.
  Box seen_box(const Camera& camera) const {
    Vec2 low = Vec2::Constant(1e300), high = -low;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p(corner & 1 ? low_.x() : high_.x(), corner & 2 ? low_.y() : high_.y(),
                   corner & 4 ? low_.z() : high_.z());
      if (camera.in_camera(p).z() <= 0) return {0, 0, camera.width, camera.height};
      const Vec2 at = project(camera, p);
      low = low.cwiseMin(at), high = high.cwiseMax(at);
    }
    const auto clamped = [](double v, int n) { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(n))); };
    return {clamped(std::floor(low.x()) - 1, camera.width), clamped(std::floor(low.y()) - 1, camera.height),
            clamped(std::ceil(high.x()) + 1, camera.width), clamped(std::ceil(high.y()) + 1, camera.height)};
  }

  // What a ray from the camera meets. The tree finds the triangle in floats; the place on it comes from its doubles.
  std::optional<Vec3> colour(const Camera& camera, const Vec3& towards) const {
    const Vec3 eye = camera.centre(), direction = towards.normalized();
    const int triangle = scene_.first_hit(eye, direction);
    if (triangle < 0) return {};
    const Triangle& t = model_.mesh.triangles[triangle];
    const Vec3 &a = model_.mesh.positions[t[0]], ab = model_.mesh.positions[t[1]] - a,
               ac = model_.mesh.positions[t[2]] - a;
    const Vec3 n = ab.cross(ac);
    const double squared = n.squaredNorm(), steep = n.dot(direction);
    Vec3 place = a;
    if (steep != 0) place = eye + n.dot(a - eye) / steep * direction;
    double u = 0, v = 0;
    if (squared > 0) {
      u = std::clamp((place - a).cross(ac).dot(n) / squared, 0.0, 1.0);
      v = std::clamp(ab.cross(place - a).dot(n) / squared, 0.0, 1.0 - u);
    }
    const Vec3 on = a + u * ab + v * ac;
    const Vec3 normal = squared > 0 ? Vec3((steep > 0 ? -n : n) / std::sqrt(squared)) : Vec3(-direction);
    return (shade(camera, normal) * surface(triangle, on, u, v)).eval();
  }

  Vec3 surface(int triangle, const Vec3& place, double u, double v) const {
    if (options_.style == PhotoStyle::textured) return noise_colour(place, side_, texture_);
    if (options_.style != PhotoStyle::own) return Vec3::Constant(kGrey);
    const Material& material = model_.materials[model_.material[triangle]];
    if (material.texture.empty() || model_.uv.empty()) return vector_of(material.colour);
    const Vec2* uv = &model_.uv[3 * static_cast<std::size_t>(triangle)];
    return texel(material.texture, uv[0] + u * (uv[1] - uv[0]) + v * (uv[2] - uv[0]));
  }

  double shade(const Camera& camera, const Vec3& normal) const {
    if (options_.style == PhotoStyle::flat) return 1;
    double light = kAmbient;
    if (options_.style == PhotoStyle::plain_turning) {
      Vec3 seen = camera.rotation * normal;
      seen.y() = -seen.y(), seen.z() = -seen.z();
      for (const Lamp& lamp : kTurningLamps) light += lamp.power * std::max(0.0, seen.dot(lamp.direction));
    } else {
      for (const Lamp& lamp : kLamps) light += lamp.power * std::max(0.0, normal.dot(lamp.direction));
    }
    return std::min(1.0, light);
  }

  const Model& model_;
  const PhotographOptions& options_;
  const SolidTextureOptions& texture_;
  RayScene scene_;
  Vec3 background_, low_, high_;
  double side_ = 1;
};

}  // namespace

std::vector<Photo> photograph(const Model& model, std::span<const Camera> cameras, const PhotographOptions& options,
                              const SolidTextureOptions& texture, const Monitor& monitor) {
  check("photograph", options);
  check("solid_texture", texture);
  if (model.mesh.triangles.empty()) throw std::invalid_argument("a model without triangles cannot be photographed");
  const Studio studio(model, options, texture);
  std::vector<Photo> photos;
  for (const Camera& camera : cameras) {
    monitor.at("photograph", static_cast<double>(photos.size()) / static_cast<double>(cameras.size()));
    photos.push_back(studio.take(camera));
  }
  return photos;
}

}  // namespace carve
