#include "artist/place.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

namespace carve::artist {
namespace {

constexpr double kMergeDistance = 1e-6;  // of the longest side

Vec3 axis(const std::string& name) {
  const auto letter = name.empty() ? std::string::npos : std::string("xyz").find(name.back());
  if (letter == std::string::npos || name.size() > 2 || (name.size() == 2 && name[0] != '+' && name[0] != '-'))
    throw std::invalid_argument("an axis must be one of +x, -x, +y, -y, +z, -z, got \"" + name + "\"");
  return (name[0] == '-' ? -1 : 1) * Vec3::Unit(static_cast<int>(letter));
}

Eigen::Matrix3d rotation(const Placement& placement) {
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  for (const auto& [about, degrees] : placement.turns)
    turned = Eigen::AngleAxisd(degrees / 180 * std::numbers::pi, axis(about)).toRotationMatrix() * turned;
  const Vec3 up = axis(placement.up), front = axis(placement.front);
  if (up.dot(front) != 0)
    throw std::invalid_argument("up " + placement.up + " and front " + placement.front + " lie along one axis");
  Eigen::Matrix3d rows;
  rows << up.cross(front).transpose(), up.transpose(), front.transpose();
  return rows * turned;
}

// For every position the first one that lies closer than `distance`, or itself; found through a grid of that pitch.
std::vector<int> merged(const std::vector<Vec3>& positions, double distance) {
  using Cell = Eigen::Matrix<std::int64_t, 3, 1>;
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      std::uint64_t h = 0;
      for (const std::int64_t i : c) h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
      return h ^ h >> 32;
    }
  };
  std::unordered_map<Cell, std::vector<int>, Hash> grid;
  std::vector<int> first(positions.size());
  for (int i = 0; i < static_cast<int>(positions.size()); ++i) {
    const Cell cell = (positions[i] / distance).array().floor().cast<std::int64_t>();
    int found = i;
    for (int n = 0; n < 27; ++n) {
      const auto near = grid.find(cell + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      if (near == grid.end()) continue;
      for (const int j : near->second)
        if ((positions[i] - positions[j]).norm() < distance) found = std::min(found, j);
    }
    first[i] = found;
    if (found == i) grid[cell].push_back(i);
  }
  return first;
}

Eigen::AlignedBox3d box_of(const Model& model) {
  Eigen::AlignedBox3d box;
  for (const Face& face : model.faces)
    for (const Corner& corner : face.corners) box.extend(model.positions[corner.position]);
  return box;
}

// Keeps what `remap[i] >= 0` asks for; remap then holds the new indices.
template <class T>
std::vector<T> compact(const std::vector<T>& all, std::vector<int>& remap) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (remap[i] < 0) continue;
    remap[i] = static_cast<int>(kept.size());
    kept.push_back(all[i]);
  }
  return kept;
}

void drop_unused(Model& model) {
  std::vector<int> positions(model.positions.size(), -1), texcoords(model.texcoords.size(), -1);
  std::vector<int> materials(model.materials.size(), -1);
  for (const Face& face : model.faces) {
    materials[face.material] = 0;
    for (const Corner& c : face.corners) {
      positions[c.position] = 0;
      if (c.texcoord >= 0) texcoords[c.texcoord] = 0;
    }
  }
  model.positions = compact(model.positions, positions);
  model.texcoords = compact(model.texcoords, texcoords);
  model.materials = compact(model.materials, materials);
  for (Face& face : model.faces) {
    face.material = materials[face.material];
    for (Corner& c : face.corners) c = {positions[c.position], c.texcoord < 0 ? -1 : texcoords[c.texcoord]};
  }
}

// Connected parts, as one number a position.
std::vector<int> parts_of(const Model& model) {
  std::vector<int> parent(model.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Face& face : model.faces)
    for (int k = 1; k < 3; ++k) parent[root(face.corners[k].position)] = root(face.corners[0].position);
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(static_cast<int>(i));
  return parent;
}

void turn_inside_out_parts(Model& model) {
  const std::vector<int> part = parts_of(model);
  std::vector<double> volume(part.size(), 0.0);
  for (const Face& face : model.faces) {  // measured from one point of the part, so that an open part has a volume too
    const auto& [a, b, c] = face.corners;
    const int p = part[a.position];
    const auto from = [&](const Corner& corner) -> Vec3 {
      return model.positions[corner.position] - model.positions[p];
    };
    volume[p] += from(a).dot(from(b).cross(from(c)));
  }
  for (Face& face : model.faces)
    if (volume[part[face.corners[0].position]] < 0) std::swap(face.corners[1], face.corners[2]);
}

}  // namespace

Model place(const Model& model, const Placement& placement) {
  const Eigen::Matrix3d turned = rotation(placement);
  Model placed = model;
  for (Vec3& p : placed.positions) p = turned * p;
  const Eigen::AlignedBox3d box = box_of(placed);
  const double side = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  if (!(side > 0) || !std::isfinite(side)) throw std::invalid_argument("the model has no extent");
  const Vec3 foot(box.center().x(), box.min().y(), box.center().z());
  for (Vec3& p : placed.positions) p = (p - foot) / side;

  const std::vector<int> first = merged(placed.positions, kMergeDistance);
  std::vector<Face> faces;
  for (Face face : placed.faces) {
    for (Corner& c : face.corners) c.position = first[c.position];
    const auto& [a, b, c] = face.corners;
    if (a.position != b.position && b.position != c.position && c.position != a.position) faces.push_back(face);
  }
  placed.faces = std::move(faces);
  drop_unused(placed);
  turn_inside_out_parts(placed);
  return placed;
}

}  // namespace carve::artist
