#include "report/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace carve::experiments {
namespace {

// Two-sided probability of a split at least as uneven as k of n under a fair coin.
double sign_test(int k, int n) {
  if (n == 0) return 1;
  double tail = 0;
  for (int i = 0; i <= std::min(k, n - k); ++i)
    tail += std::exp(std::lgamma(n + 1) - std::lgamma(i + 1) - std::lgamma(n - i + 1) - n * std::log(2.0));
  return std::min(1.0, 2 * tail);
}

}  // namespace

double mean(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(values.size());
}

double median(std::span<const double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

PairedDifference paired_difference(std::span<const double> a, std::span<const double> b) {
  PairedDifference result;
  std::vector<double> differences;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) differences.push_back(a[i] - b[i]);
  result.pairs = static_cast<int>(differences.size());
  if (differences.empty()) return result;
  for (const double d : differences) {
    result.better += d < 0;
    result.worse += d > 0;
  }
  result.mean = mean(differences);
  result.p = sign_test(result.better, result.better + result.worse);

  constexpr int kResamples = 10000;
  std::mt19937_64 random(1);
  std::vector<double> means(kResamples);
  for (double& m : means) {
    double sum = 0;
    // Not std::uniform_int_distribution: its values differ between standard libraries.
    for (std::size_t i = 0; i < differences.size(); ++i) sum += differences[(random() >> 11) % differences.size()];
    m = sum / static_cast<double>(differences.size());
  }
  std::sort(means.begin(), means.end());
  result.low = means[kResamples * 25 / 1000];
  result.high = means[kResamples * 975 / 1000];
  return result;
}

}  // namespace carve::experiments
