#pragma once
#include <optional>
#include <span>

namespace carve::experiments {

double mean(std::span<const double> values);    // NaN of nothing
double median(std::span<const double> values);  // NaN of nothing; the mean of the middle two of an even number

/// Differences of pairs, a - b.
struct PairedDifference {
  int pairs = 0, better = 0, worse = 0;  // better: a - b < 0
  double mean = 0;
  double low = 0, high = 0;  // 95 % bootstrap percentile interval of the mean difference
  double p = 1;              // two-sided exact sign test; ties are left out
  /// Below this not even pairs that all agree are unlikely by chance (sign test, 5 %).
  static constexpr int kLeastPairs = 6;
  /// The interval does not contain 0, and the sign test agrees: of few pairs an interval alone is too narrow.
  bool beyond_noise() const { return pairs >= kLeastPairs && (low > 0 || high < 0) && p <= 0.05; }
};

/// Bootstrap of 10,000 resamples with a fixed seed: the same differences give the same interval everywhere.
PairedDifference paired_difference(std::span<const double> a, std::span<const double> b);

}  // namespace carve::experiments
