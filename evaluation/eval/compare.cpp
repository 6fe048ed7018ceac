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
class Sum {
 public:
  void add(double value) {
    const double grown = total_ + value;
    lost_ += std::abs(total_) >= std::abs(value) ? (total_ - grown) + value : (value - grown) + total_;
    total_ = grown;
  }
  double mean(std::size_t count) const { return (total_ + lost_) / static_cast<double>(count); }

 private:
  double total_ = 0, lost_ = 0;
};

// `each` calls back with every value, always in the same order.
template <class Each>
double mean_of(const Each& each, std::size_t count) {
  Sum sum;
  each([&](double x) { sum.add(x); });
  return sum.mean(count);
}

// About the mean, which is taken off first: no cancellation where the deviation is small beside the mean.
template <class Each>
double deviation_of(const Each& each, double mean, std::size_t count) {
  Sum sum;
  each([&](double x) { sum.add((x - mean) * (x - mean)); });
  return std::sqrt(sum.mean(count));
}

template <class Each>
Distances summarise_each(const Each& each, std::size_t count) {
  Distances d;
  Sum length, square;
  each([&](double x) {
    length.add(x);
    square.add(x * x);
    d.max = std::max(d.max, x);
  });
  d.mean = length.mean(count);
  d.mean_square = square.mean(count);
  d.deviation = deviation_of(each, d.mean, count);
  return d;
}

template <class Each>
void summarise_signed(Comparison& comparison, const Each& each, std::size_t count) {
  comparison.signed_mean = mean_of(each, count);
  comparison.signed_deviation = deviation_of(each, comparison.signed_mean, count);
}

auto all_of(const std::vector<double>& values) {
  return [&values](const auto& body) {
    for (const double value : values) body(value);
  };
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
  return mean_of(all_of(cosines), cosines.size());
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
  const std::size_t size = spilled ? spilled->size() : sorted.size();
  if (size == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto ranked = [&](std::size_t rank) { return spilled ? absolute_of_rank(*spilled, rank) : sorted[rank]; };
  const double rank = p / 100 * static_cast<double>(size - 1);
  const auto below = static_cast<std::size_t>(rank);
  const double low = ranked(below), above = ranked(std::min(below + 1, size - 1));
  return low + (rank - static_cast<double>(below)) * (above - low);
}

double Distances::share_within(double tolerance) const {
  if (spilled) {
    std::size_t within = 0;
    spilled->each([&](double x) { within += std::abs(x) <= tolerance; });
    return static_cast<double>(within) / static_cast<double>(spilled->size());
  }
  const auto end = std::upper_bound(sorted.begin(), sorted.end(), tolerance);
  return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

Distances summarise(std::vector<double> unsigned_distances) {
  Distances d = summarise_each(all_of(unsigned_distances), unsigned_distances.size());
  std::sort(unsigned_distances.begin(), unsigned_distances.end());
  d.sorted = std::move(unsigned_distances);
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
  summarise_signed(result, all_of(result.vertex_signed), result.vertex_signed.size());
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
  if (options_.self_intersections) {
    const auto meeting = self_intersections(compared);
    result.self_intersections = std::ssize(meeting) - std::ssize(contacts(compared, meeting));
  }
  return result;
}

Comparison Reference::compare(PlyCloud& compared, std::size_t piece) const {
  const Samples on_reference = sample_surface(mesh_, options_.samples, static_cast<unsigned>(options_.seed));
  std::vector<double> to_compared(on_reference.points.size(), std::numeric_limits<double>::infinity());
  const auto spill = std::make_shared<Spill>();
  Mesh part;
  for (part.positions = compared.next(piece); !part.positions.empty(); part.positions = compared.next(piece)) {
    spill->append(signed_distances(part.positions, distance_.nearest(part.positions), mesh_, options_.sign));
    const std::vector<Nearest> backward = MeshDistance(points_as_triangles(part)).nearest(on_reference.points);
    for (std::size_t i = 0; i < backward.size(); ++i) to_compared[i] = std::min(to_compared[i], backward[i].distance);
  }
  Comparison result;
  const auto each = [&](const auto& body) { spill->each(body); };
  summarise_signed(result, each, spill->size());
  result.vertex =
      summarise_each([&](const auto& body) { spill->each([&](double x) { body(std::abs(x)); }); }, spill->size());
  result.vertex.spilled = spill;
  result.to_reference = result.vertex;
  result.to_compared = summarise(std::move(to_compared));
  return result;
}

}  // namespace carve
