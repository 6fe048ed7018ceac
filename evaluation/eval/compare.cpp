#include "eval/compare.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "carve/core/options.h"
#include "carve/mesh/self_intersections.h"
#include "eval/sample.h"
#include "eval/volume_iou.h"

namespace carve {
namespace {

// Compensated (Neumaier), so that a million equal distances have that distance as their mean.
template <class Term>
double sum(const std::vector<double>& values, Term term) {
  double total = 0, lost = 0;
  for (const double value : values) {
    const double next = term(value), grown = total + next;
    lost += std::abs(total) >= std::abs(next) ? (total - grown) + next : (next - grown) + total;
    total = grown;
  }
  return total + lost;
}

std::vector<double> lengths(const std::vector<Nearest>& nearest) {
  std::vector<double> out(nearest.size());
  std::transform(nearest.begin(), nearest.end(), out.begin(), [](const Nearest& n) { return n.distance; });
  return out;
}

Vec3 normal(const Mesh& mesh, int triangle) {
  const auto [a, b, c] = mesh.triangles[triangle];
  const Vec3 n = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
  return n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::Zero());
}

double normal_agreement(const Samples& samples, const Mesh& from, const std::vector<Nearest>& nearest, const Mesh& to) {
  std::vector<double> cosines(nearest.size());
  for (std::size_t i = 0; i < nearest.size(); ++i)
    cosines[i] = std::abs(normal(from, samples.triangles[i]).dot(normal(to, nearest[i].triangle)));
  return sum(cosines, [](double c) { return c; }) / static_cast<double>(cosines.size());
}

// A point is a triangle without extent: distances to a cloud are those to such a mesh.
Mesh points_as_triangles(const Mesh& cloud) {
  Mesh mesh{cloud.positions, {}};
  mesh.triangles.reserve(cloud.positions.size());
  for (int i = 0; i < static_cast<int>(cloud.positions.size()); ++i) mesh.triangles.push_back({i, i, i});
  return mesh;
}

std::vector<double> parse_tolerances(const std::vector<std::string>& texts) {
  std::vector<double> values;
  for (const std::string& text : texts) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= 1000))
      throw std::invalid_argument("tolerances must be numbers in [0, 1000] (% of the diagonal), got " + text);
    values.push_back(value);
  }
  return values;
}

}  // namespace

double box_diagonal(const Mesh& mesh) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Triangle& triangle : mesh.triangles)
    for (const int corner : triangle) {
      low = low.cwiseMin(mesh.positions[corner]);
      high = high.cwiseMax(mesh.positions[corner]);
    }
  return (high - low).norm();
}

double Distances::percentile(double p) const {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = p / 100 * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const double above = sorted[std::min(below + 1, sorted.size() - 1)];
  return sorted[below] + (rank - static_cast<double>(below)) * (above - sorted[below]);
}

double Distances::share_within(double tolerance) const {
  const auto end = std::upper_bound(sorted.begin(), sorted.end(), tolerance);
  return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

Distances summarise(std::vector<double> unsigned_distances) {
  Distances d{std::move(unsigned_distances)};
  const auto count = static_cast<double>(d.sorted.size());
  d.mean = sum(d.sorted, [](double x) { return x; }) / count;
  d.mean_square = sum(d.sorted, [](double x) { return x * x; }) / count;
  std::sort(d.sorted.begin(), d.sorted.end());
  return d;
}

Reference::Reference(Mesh mesh, const CompareOptions& options)
    : mesh_(std::move(mesh)), options_(options), distance_(mesh_), diagonal_(box_diagonal(mesh_)) {
  check("", options_);
  tolerances_ = parse_tolerances(options_.tolerances);
  if (!(diagonal_ > 0)) throw std::invalid_argument("the reference has no extent");
  closed_ = topology(mesh_).closed();
}

Comparison Reference::compare(const Mesh& compared) const {
  if (compared.positions.empty())
    throw std::invalid_argument("a compared mesh must have at least one vertex, got none");
  Comparison result;
  const std::vector<Nearest> vertices = distance_.nearest(compared.positions);
  result.vertex_signed = signed_distances(compared.positions, vertices, mesh_, options_.sign);
  result.vertex = summarise(lengths(vertices));

  const auto seed = static_cast<unsigned>(options_.seed);
  const Samples on_reference = sample_surface(mesh_, options_.samples, seed);
  const bool cloud = compared.triangles.empty();
  const MeshDistance to_compared(cloud ? points_as_triangles(compared) : compared);
  const std::vector<Nearest> backward = to_compared.nearest(on_reference.points);
  result.to_compared = summarise(lengths(backward));
  if (cloud) {
    result.to_reference = result.vertex;
    return result;
  }

  result.topology = topology(compared);
  if (result.topology->area > 0) {
    const Samples on_compared = sample_surface(compared, options_.samples, seed);
    const std::vector<Nearest> forward = distance_.nearest(on_compared.points);
    result.to_reference = summarise(lengths(forward));
    result.normal_agreement = (normal_agreement(on_compared, compared, forward, mesh_) +
                               normal_agreement(on_reference, mesh_, backward, compared)) /
                              2;
  }
  if (options_.iou_resolution > 0 && closed_ && result.topology->closed())
    result.volume_iou = volume_iou(compared, mesh_, options_.iou_resolution);
  if (options_.self_intersections)
    result.self_intersections = static_cast<std::int64_t>(self_intersections(compared).size());
  return result;
}

}  // namespace carve
