#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/compare.h"

namespace carve {

/// Lengths are told in the model's unit and in % of the reference's bounding-box diagonal (squares: of its square).
enum class Unit { length, squared_length, share, count, flag };
enum class Better { lower, higher, zero, none };
inline const char* name(Unit unit) {
  static constexpr const char* all[] = {"length", "length^2", "share", "count", "flag"};
  return all[static_cast<int>(unit)];
}
inline const char* name(Better better) {
  static constexpr const char* all[] = {"lower", "higher", "zero", "-"};
  return all[static_cast<int>(better)];
}

/// One line of the table that text, JSON, CSV and the experiments' tables are made from. Notation: V = vertices of the
/// compared mesh C, S(M) = area-uniform samples of M, d(x, M) = distance to the nearest point of M, R = reference.
struct Metric {
  const char* name;
  const char* formula;
  Unit unit;
  Better better;
  bool per_tolerance;                                                              // once for every tolerance t
  std::optional<double> (*value)(const Comparison& comparison, double tolerance);  // t in the model's unit
};
std::span<const Metric> metrics();
const Metric& metric(const std::string& name);  // \throws std::invalid_argument: no such metric

struct Score {
  const Metric* metric;
  std::optional<double> tolerance;  // in % of the diagonal
  std::optional<double> value;      // nothing: not defined for these inputs
  std::optional<double> percent;    // of the diagonal, or of its square

  std::string name() const;  // "f_score@0.5%"
};

/// Every metric, in the table's order.
std::vector<Score> scores(const Comparison& comparison, const Reference& reference);

}  // namespace carve
