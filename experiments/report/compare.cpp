#include "report/compare.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace carve::experiments {
namespace {

std::string key_of(const Record& r) {
  return r.model + " / " + r.method + (r.swept.empty() ? "" : " / " + text_of(r.swept)) + " / seed " +
         std::to_string(r.seed);
}

struct Pair {
  const Record* a = nullptr;
  const Record* b = nullptr;
};

struct Moved {
  std::string key;
  double a, b;
};

std::map<std::string, Pair> pairs_of(const std::vector<Record>& a, const std::vector<Record>& b) {
  std::map<std::string, Pair> pairs;
  for (const Record& r : a) pairs[key_of(r)].a = &r;
  for (const Record& r : b) pairs[key_of(r)].b = &r;
  return pairs;
}

void compare_metric(std::ostream& out, const RunMetric& metric, const std::vector<std::string>& methods,
                    const std::map<std::string, Pair>& pairs) {
  std::vector<Moved> moved;
  out << "**" << metric.name << "**" << (metric.unit.empty() ? "" : " (" + metric.unit + ")") << ": " << metric.formula
      << "\n\n| method | runs | A | B | B − A | 95 % | p | |\n|---|---:|---:|---:|---:|---|---:|---|\n";
  for (const std::string& method : methods) {
    std::vector<double> left, right;
    for (const auto& [key, pair] : pairs) {
      if (!pair.a || !pair.b || pair.a->method != method) continue;
      const auto x = pair.a->metrics.find(metric.name), y = pair.b->metrics.find(metric.name);
      if (x == pair.a->metrics.end() || y == pair.b->metrics.end()) continue;
      left.push_back(x->second);
      right.push_back(y->second);
      if (x->second != y->second) moved.push_back({key, x->second, y->second});
    }
    if (left.empty()) continue;
    const PairedDifference d = paired_difference(right, left);
    const char* verdict = d.mean == 0 && d.better + d.worse == 0    ? "same"
                          : d.pairs < PairedDifference::kLeastPairs ? "too few runs to tell"
                          : d.beyond_noise()                        ? "beyond noise"
                                                                    : "within noise";
    out << "| " << method << " | " << d.pairs << " | " << short_text(mean(left)) << " | " << short_text(mean(right))
        << " | " << short_text(d.mean) << " | [" << short_text(d.low) << ", " << short_text(d.high) << "] | "
        << short_text(d.p) << " | " << verdict << " |\n";
  }
  std::stable_sort(moved.begin(), moved.end(),
                   [](const Moved& x, const Moved& y) { return std::abs(x.b - x.a) > std::abs(y.b - y.a); });
  out << "\n";
  for (std::size_t i = 0; i < std::min<std::size_t>(5, moved.size()); ++i)
    out << "- " << moved[i].key << ": " << short_text(moved[i].a) << " → " << short_text(moved[i].b) << "\n";
  out << "\n";
}

}  // namespace

std::string compare(const Overview& overview, const std::vector<Record>& a, const std::vector<Record>& b) {
  const auto pairs = pairs_of(a, b);
  std::ostringstream out;
  int both = 0;
  std::ostringstream differing;
  for (const auto& [key, pair] : pairs) {
    const bool in_a = pair.a && pair.a->done(), in_b = pair.b && pair.b->done();
    both += in_a && in_b;
    if (in_a != in_b)
      differing << "- " << key << ": A " << (pair.a ? pair.a->status : "not run") << ", B "
                << (pair.b ? pair.b->status : "not run") << "\n";
  }
  out << "# " << overview.title << "\n\n"
      << both << " of " << pairs.size() << " runs have a result on both sides.\n\n"
      << differing.str() << (differing.str().empty() ? "" : "\n");
  for (const RunMetric& metric : overview.metrics) compare_metric(out, metric, overview.methods, pairs);
  return out.str();
}

}  // namespace carve::experiments
