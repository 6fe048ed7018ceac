#include "eval/metrics.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace carve {
namespace {

using C = const Comparison&;
using Value = std::optional<double>;
constexpr double kNone = 0;

bool two_way(C c) { return c.to_reference && c.to_compared; }

double harmonic(double precision, double recall) {
  return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
}

template <class F>
Value of(const std::optional<Distances>& d, F f) {
  return d ? Value(f(*d)) : std::nullopt;
}
template <class F>
Value of(const std::optional<Topology>& t, F f) {
  return t ? Value(static_cast<double>(f(*t))) : std::nullopt;
}

// clang-format off
const Metric kMetrics[] = {
  {"c2m_thesis", "mean of d(v, R) over v in V (CloudCompare's C2M, unsigned)", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return c.vertex.mean; }},
  {"c2m_std", "standard deviation of d(v, R), population", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return c.vertex.deviation; }},
  {"c2m_signed_mean", "mean of d(v, R), negative inside R", Unit::length, Better::zero, false,
   [](C c, double) -> Value { return c.signed_mean; }},
  {"c2m_signed_std", "standard deviation of the signed d(v, R), population", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return c.signed_deviation; }},
  {"c2m_rms", "sqrt(mean of d(v, R)^2)", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return std::sqrt(c.vertex.mean_square); }},
  {"c2m_p50", "median of d(v, R)", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return c.vertex.percentile(50); }},
  {"c2m_p90", "90th percentile of d(v, R)", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return c.vertex.percentile(90); }},
  {"c2m_p95", "95th percentile of d(v, R)", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return c.vertex.percentile(95); }},
  {"c2m_p99", "99th percentile of d(v, R)", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return c.vertex.percentile(99); }},
  {"c2m_max", "max of d(v, R)", Unit::length, Better::lower, false,
   [](C c, double) -> Value { return c.vertex.max; }},
  {"accuracy", "mean of d(x, R) over x in S(C); of a cloud, over its points", Unit::length, Better::lower, false,
   [](C c, double) { return of(c.to_reference, [](const Distances& d) { return d.mean; }); }},
  {"completeness", "mean of d(y, C) over y in S(R)", Unit::length, Better::lower, false,
   [](C c, double) { return of(c.to_compared, [](const Distances& d) { return d.mean; }); }},
  {"chamfer_l1", "(accuracy + completeness) / 2", Unit::length, Better::lower, false,
   [](C c, double) { return two_way(c) ? Value((c.to_reference->mean + c.to_compared->mean) / 2) : Value(); }},
  {"chamfer_l2sq", "mean of d(x, R)^2 + mean of d(y, C)^2", Unit::squared_length, Better::lower, false,
   [](C c, double) { return two_way(c) ? Value(c.to_reference->mean_square + c.to_compared->mean_square) : Value(); }},
  {"hausdorff", "max of d(x, R) and d(y, C) over the samples and V: a lower bound", Unit::length, Better::lower, false,
   [](C c, double) { return two_way(c) ? Value(std::max({c.to_reference->max, c.to_compared->max,
                                                         c.vertex.max})) : Value(); }},
  {"precision", "share of S(C) with d(x, R) <= t", Unit::share, Better::higher, true,
   [](C c, double t) { return of(c.to_reference, [t](const Distances& d) { return d.share_within(t); }); }},
  {"recall", "share of S(R) with d(y, C) <= t", Unit::share, Better::higher, true,
   [](C c, double t) { return of(c.to_compared, [t](const Distances& d) { return d.share_within(t); }); }},
  {"f_score", "2 precision recall / (precision + recall); 0 where both are 0", Unit::share, Better::higher, true,
   [](C c, double t) { return two_way(c) ? Value(harmonic(c.to_reference->share_within(t),
                                                          c.to_compared->share_within(t))) : Value(); }},
  {"normal_consistency", "mean |cos| of the normals at x, y and at their nearest points, both ways", Unit::share,
   Better::higher, false, [](C c, double) { return c.normal_agreement; }},
  {"volume_iou", "volume of C and R together over that of either; both closed", Unit::share, Better::higher, false,
   [](C c, double) { return c.volume_iou; }},
  {"closed", "every edge of C has two triangles or more", Unit::flag, Better::higher, false,
   [](C c, double) { return of(c.topology, [](const Topology& t) { return t.closed(); }); }},
  {"manifold", "C is a 2-manifold", Unit::flag, Better::higher, false,
   [](C c, double) { return of(c.topology, [](const Topology& t) { return t.manifold(); }); }},
  {"oriented", "neighbours in C turn the same way", Unit::flag, Better::higher, false,
   [](C c, double) { return of(c.topology, [](const Topology& t) { return t.oriented(); }); }},
  {"components", "connected components of C", Unit::count, Better::none, false,
   [](C c, double) { return of(c.topology, [](const Topology& t) { return t.components; }); }},
  {"genus", "handles of C, all components together; C closed and manifold", Unit::count, Better::none, false,
   [](C c, double) { return c.topology && c.topology->solid() ? Value(static_cast<double>(c.topology->genus))
                                                              : Value(); }},
  {"self_intersections", "pairs of C's triangles that meet elsewhere than in what they share or a single point", Unit::count,
   Better::lower, false, [](C c, double) { return c.self_intersections ? Value(static_cast<double>(*c.self_intersections))
                                                                       : Value(); }},
  {"degenerate", "triangles of C without area", Unit::count, Better::lower, false,
   [](C c, double) { return of(c.topology, [](const Topology& t) { return t.degenerate_triangles; }); }},
};
// clang-format on

std::string text_of(double value) {
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

}  // namespace

std::span<const Metric> metrics() { return kMetrics; }

const Metric& metric(const std::string& name) {
  for (const Metric& m : kMetrics)
    if (name == m.name) return m;
  throw std::invalid_argument("no metric is called " + name);
}

std::string Score::name() const {
  return tolerance ? std::string(metric->name) + "@" + text_of(*tolerance) + "%" : metric->name;
}

std::vector<Score> scores(const Comparison& comparison, const Reference& reference) {
  std::vector<Score> all;
  const double diagonal = reference.diagonal();
  const auto add = [&](const Metric& m, std::optional<double> tolerance) {
    Score score{&m, tolerance, m.value(comparison, tolerance ? *tolerance / 100 * diagonal : kNone), {}};
    if (score.value && m.unit == Unit::length) score.percent = 100 * *score.value / diagonal;
    if (score.value && m.unit == Unit::squared_length) score.percent = 100 * *score.value / (diagonal * diagonal);
    all.push_back(score);
  };
  for (const Metric& m : kMetrics)
    if (!m.per_tolerance)
      add(m, {});
    else
      for (const double tolerance : reference.tolerances()) add(m, tolerance);
  return all;
}

}  // namespace carve
