#include "synthesize/view_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace carve {
namespace {

double along(const Vec3& p, SignedAxis axis) { return axis.sign * p[axis.axis]; }

Rgba texel(const Picture& texture, const Vec2& uv) {
  const auto wrapped = [](double t, int n) { return (t - std::floor(t)) * n - 0.5; };
  const double x = wrapped(uv.x(), texture.width), y = wrapped(1 - uv.y(), texture.height);
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const double u = x - i, v = y - j;
  const auto at = [&](int a, int b) -> const Rgba& {
    return texture((a + texture.width) % texture.width, (b + texture.height) % texture.height);
  };
  const Rgba &p = at(i, j), &q = at(i + 1, j), &r = at(i, j + 1), &s = at(i + 1, j + 1);
  const auto mix = [&](int a, int b, int c, int d) {
    return static_cast<std::uint8_t>(std::lround((a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v));
  };
  return {mix(p.r, q.r, r.r, s.r), mix(p.g, q.g, r.g, s.g), mix(p.b, q.b, r.b, s.b), 255};
}

}  // namespace

ViewSampler::ViewSampler(const Model& model, const RayScene& scene, View view, const Placement& place, int samples)
    : model_(model),
      scene_(scene),
      frame_(frame(view)),
      scale_(place.scale * samples),
      column_(place.column * samples),
      row_(place.row * samples) {
  const auto [low, high] = bounds(model.mesh);
  const Vec3 middle = (low + high) / 2;
  middle_right_ = along(middle, frame_.right);
  middle_up_ = along(middle, frame_.up);
  nearest_ = std::max(along(low, frame_.toward), along(high, frame_.toward));
  const double half_width = (high - low)[frame_.right.axis] / 2 * scale_ + 1;
  const double half_height = (high - low)[frame_.up.axis] / 2 * scale_ + 1;
  low_x_ = column_ - half_width, high_x_ = column_ + half_width;
  low_y_ = row_ - half_height, high_y_ = row_ + half_height;
}

ViewSampler::Corner ViewSampler::corner(int triangle, int k) const {
  const Vec3& p = model_.mesh.positions[model_.mesh.triangles[triangle][k]];
  return {along(p, frame_.right), along(p, frame_.up), along(p, frame_.toward)};
}

ViewSampler::Corner ViewSampler::point(double x, double y) const {
  return {middle_right_ + (x - column_) / scale_, middle_up_ - (y - row_) / scale_, nearest_ + 0.5};
}

// The tree finds the triangle in floats; where its plane is met comes from its doubles.
ViewSampler::Hit ViewSampler::hit(double x, double y) const {
  if (x < low_x_ || x > high_x_ || y < low_y_ || y > high_y_) return {};
  const Corner p = point(x, y);
  Vec3 origin, direction = Vec3::Zero();
  origin[frame_.right.axis] = frame_.right.sign * p.right;
  origin[frame_.up.axis] = frame_.up.sign * p.up;
  origin[frame_.toward.axis] = frame_.toward.sign * p.toward;
  direction[frame_.toward.axis] = -frame_.toward.sign;
  const int triangle = scene_.first_hit(origin, direction);
  if (triangle < 0) return {};
  const Corner a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  const auto [low, high] = std::minmax({a.toward, b.toward, c.toward});
  const Vec3 n = Vec3(b.right - a.right, b.up - a.up, b.toward - a.toward)
                     .cross(Vec3(c.right - a.right, c.up - a.up, c.toward - a.toward));
  double depth = a.toward;
  if (n.z() != 0) depth -= (n.x() * (p.right - a.right) + n.y() * (p.up - a.up)) / n.z();
  return {triangle, std::clamp(depth, low, high)};
}

Vec3 ViewSampler::normal(int triangle) const {
  const Corner a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  const Vec3 n = Vec3(b.right - a.right, b.up - a.up, b.toward - a.toward)
                     .cross(Vec3(c.right - a.right, c.up - a.up, c.toward - a.toward))
                     .normalized();
  return n.z() < 0 ? Vec3(-n) : n;
}

Rgba ViewSampler::colour(int triangle, const Corner& p) const {
  const Material& material = model_.materials[model_.material[triangle]];
  if (material.texture.empty() || model_.uv.empty()) return {material.colour.r, material.colour.g, material.colour.b};
  const Corner a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  const double area = (b.right - a.right) * (c.up - a.up) - (c.right - a.right) * (b.up - a.up);
  double u = 0, v = 0;
  if (std::abs(area) > 1e-18) {
    u = ((p.right - a.right) * (c.up - a.up) - (c.right - a.right) * (p.up - a.up)) / area;
    v = ((b.right - a.right) * (p.up - a.up) - (p.right - a.right) * (b.up - a.up)) / area;
    u = std::clamp(u, 0.0, 1.0), v = std::clamp(v, 0.0, 1.0);
  }
  const Vec2* uv = &model_.uv[3 * static_cast<std::size_t>(triangle)];
  return texel(material.texture, uv[0] + u * (uv[1] - uv[0]) + v * (uv[2] - uv[0]));
}

SampleBlock ViewSampler::sample(int first_row, int last_row, int width) const {
  SampleBlock block{width, last_row - first_row, first_row, {}, {}, {}};
  const std::size_t count = static_cast<std::size_t>(width) * block.height;
  block.triangle.assign(count, -1);
  block.depth.assign(count, 0);
  block.colours.assign(count, {});
  for (int j = 0; j < block.height; ++j)
    for (int i = 0; i < width; ++i) {
      const double x = i + 0.5, y = first_row + j + 0.5;
      const Hit met = hit(x, y);
      if (met.triangle < 0) continue;
      block.triangle[block.at(i, j)] = met.triangle;
      block.depth[block.at(i, j)] = met.depth;
      block.colours[block.at(i, j)] = colour(met.triangle, point(x, y));
    }
  return block;
}

}  // namespace carve
