#include "eval/error_split.h"

#include <gmock/gmock.h>

#include <sstream>

#include "eval/meshes.h"

namespace carve {
namespace {

std::vector<Stage> stages(double hull, double voxels, double result) {
  return {{"hull limit", ball(30, hull)}, {"discretisation", ball(30, voxels)}, {"smoothing", ball(30, result)}};
}

TEST(ErrorSplit, OfBallsIsThatOfTheirRadii) {
  const Reference reference(ball(30), {.samples = 2000});
  for (const char* metric : {"chamfer_l1", "c2m_thesis", "c2m_max", "accuracy"}) {
    const auto split = split_error(reference, stages(1.2, 1.25, 1.1), metric);
    ASSERT_EQ(split.size(), 3u);
    EXPECT_NEAR(split[0].value, 0.2, 2e-3) << metric;
    EXPECT_NEAR(split[1].value, 0.05, 2e-3) << metric;
    EXPECT_NEAR(split[2].value, -0.15, 2e-3) << metric;
    EXPECT_NEAR(split[0].percent, 100 * 0.2 / reference.diagonal(), 0.1);
    EXPECT_EQ(split[0].moved_mean, 0);
    EXPECT_NEAR(split[1].moved_mean, 0.05, 2e-3);
    EXPECT_NEAR(split[2].moved_max, 0.15, 2e-3);
  }
}

class ErrorSplitSums : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, ErrorSplitSums, testing::Range(0u, 4u));

TEST_P(ErrorSplitSums, ToTheLastStagesMetric) {
  const Reference reference(potato(12, GetParam()), {.samples = 2000, .iou_resolution = 0});
  const std::vector<Stage> stages{{"a", potato(14, GetParam() + 1)}, {"b", potato(10, GetParam() + 2)}, {"c", cube()}};
  double sum = 0;
  for (const Contribution& part : split_error(reference, stages, "c2m_rms")) sum += part.value;
  EXPECT_NEAR(sum, *metric("c2m_rms").value(reference.compare(cube()), 0), 1e-15);
}

TEST(ErrorSplit, PrintsEveryStageAndTheSum) {
  std::ostringstream text;
  text << split_error(Reference(ball(10), {.samples = 100}), stages(1.2, 1.25, 1.1));
  for (const char* part : {"hull limit", "discretisation", "smoothing", "sum"})
    EXPECT_THAT(text.str(), testing::HasSubstr(part));
}

TEST(ErrorSplit, RefusesWhatDoesNotAddUp) {
  const Reference reference(ball(10), {.samples = 100});
  for (const char* metric : {"volume_iou", "f_score", "c2m_signed_mean", "chamfer_l2sq", "no such"})
    EXPECT_THROW(split_error(reference, stages(1, 1, 1), metric), std::invalid_argument) << metric;
  EXPECT_THROW(split_error(reference, {}), std::invalid_argument);
}

}  // namespace
}  // namespace carve
