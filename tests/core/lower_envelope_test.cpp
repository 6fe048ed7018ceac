#include "carve/core/lower_envelope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace carve {
namespace {

/// Some values of either sign, some places without one.
std::vector<double> random_line(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> line(1 + random() % 60);
  const unsigned empty = random() % 5;
  for (double& value : line)
    value = random() % 4 < empty ? LowerEnvelope::kNone : static_cast<double>(random() % 801) - 400;
  return line;
}

class EnvelopeTest : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, EnvelopeTest, ::testing::Range(0u, 32u));

TEST_P(EnvelopeTest, EachPlaceTakesTheLowestParabola) {
  const std::vector<double> line = random_line(GetParam());
  std::vector<double> out(line.size());
  LowerEnvelope(static_cast<int>(line.size())).apply(line, out);
  for (int p = 0; p < static_cast<int>(line.size()); ++p) {
    double lowest = LowerEnvelope::kNone;
    for (int q = 0; q < static_cast<int>(line.size()); ++q) lowest = std::min(lowest, line[q] + (p - q) * (p - q));
    ASSERT_EQ(out[p], lowest) << p;
  }
}

TEST_P(EnvelopeTest, OneObjectServesManyLines) {
  LowerEnvelope envelope(60);
  for (unsigned seed = GetParam(); seed < GetParam() + 3; ++seed) {
    const std::vector<double> line = random_line(seed);
    std::vector<double> out(line.size()), fresh(line.size());
    envelope.apply(line, out);
    LowerEnvelope(static_cast<int>(line.size())).apply(line, fresh);
    EXPECT_EQ(out, fresh);
  }
}

}  // namespace
}  // namespace carve
