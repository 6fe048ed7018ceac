#include "eval/compare.h"

#include <gmock/gmock.h>

#include <sstream>

#include "carve/core/parallel.h"
#include "carve/mesh/ply.h"
#include "eval/meshes.h"
#include "eval/metrics.h"
#include "eval/report.h"
#include "temporary_folder.h"

namespace carve {
namespace {

constexpr int kSamples = 5000;
CompareOptions few() { return {.samples = kSamples, .iou_resolution = 32}; }

std::vector<Score> scored(const Mesh& compared, const Mesh& mesh, const CompareOptions& options = few()) {
  const Reference reference(mesh, options);
  return scores(reference.compare(compared), reference);
}

const Score& find(const std::vector<Score>& all, const std::string& name) {
  for (const Score& score : all)
    if (score.name() == name) return score;
  throw std::invalid_argument(name);
}

double value(const std::vector<Score>& all, const std::string& name) { return find(all, name).value.value(); }

class Compare : public testing::TestWithParam<unsigned> {
 protected:
  const Mesh a_ = potato(16, GetParam()), b_ = potato(20, GetParam() + 1);
};
INSTANTIATE_TEST_SUITE_P(Seeds, Compare, testing::Range(0u, 8u));

TEST_P(Compare, AMeshWithItselfIsPerfect) {
  const auto all = scored(a_, a_);
  for (const char* zero : {"c2m_thesis", "c2m_signed_mean", "c2m_rms", "c2m_p99", "c2m_max"})
    EXPECT_EQ(value(all, zero), 0) << zero;
  for (const char* rounding : {"accuracy", "completeness", "chamfer_l1", "chamfer_l2sq", "hausdorff"})
    EXPECT_LT(value(all, rounding), 1e-15) << rounding;
  for (const char* one : {"precision@0.5%", "recall@1%", "f_score@2%", "volume_iou", "closed", "manifold", "oriented"})
    EXPECT_EQ(value(all, one), 1) << one;
  EXPECT_NEAR(value(all, "normal_consistency"), 1, 1e-12);
  EXPECT_EQ(value(all, "self_intersections"), 0);
  EXPECT_EQ(value(all, "genus"), 0);
}

TEST_P(Compare, ASymmetricMetricIsSymmetric) {
  const auto ab = scored(a_, b_), ba = scored(b_, a_);
  EXPECT_EQ(value(ab, "accuracy"), value(ba, "completeness"));
  EXPECT_EQ(value(ab, "chamfer_l1"), value(ba, "chamfer_l1"));
  EXPECT_EQ(value(ab, "chamfer_l2sq"), value(ba, "chamfer_l2sq"));
  EXPECT_EQ(value(ab, "normal_consistency"), value(ba, "normal_consistency"));
  EXPECT_EQ(value(ab, "volume_iou"), value(ba, "volume_iou"));
}

TEST_P(Compare, ARigidMotionOfBothChangesNothing) {
  const auto motion = random_motion(GetParam());
  const auto move = [&](const Vec3& p) { return Vec3(motion * p); };
  const auto before = scored(a_, b_), after = scored(mapped(a_, move), mapped(b_, move));
  for (std::size_t i = 0; i < before.size(); ++i) {
    const std::string name = before[i].name();
    // The grid and the box whose diagonal scales the tolerances do not turn with the meshes; where an edge is nearest,
    // rounding decides which of its triangles gives the normal.
    const double slack = name == "volume_iou"              ? 0.01
                         : name == "normal_consistency"    ? 1e-3
                         : before[i].metric->per_tolerance ? 0.1
                                                           : 1e-12;
    EXPECT_NEAR(*before[i].value, *after[i].value, slack) << name;
  }
}

TEST_P(Compare, AScaleScalesLengthsAndNotPercentages) {
  const double factor = 37.5;
  const auto grow = [&](const Vec3& p) { return Vec3(factor * p); };
  const auto before = scored(a_, b_), after = scored(mapped(a_, grow), mapped(b_, grow));
  for (std::size_t i = 0; i < before.size(); ++i) {
    const std::string name = before[i].name();
    const Unit unit = before[i].metric->unit;
    const double by = unit == Unit::length ? factor : unit == Unit::squared_length ? factor * factor : 1;
    EXPECT_NEAR(*before[i].value * by, *after[i].value, 1e-3 * (unit == Unit::share) + 1e-10) << name;
    EXPECT_NEAR(before[i].percent.value_or(-1), after[i].percent.value_or(-1), 1e-10) << name;
  }
}

TEST_P(Compare, ThreadsDoNotChangeAByte) {
  const auto text = [&] {
    const Reference reference(b_, few());
    std::ostringstream out;
    write_csv(out, {"b", 0, 0, reference.diagonal(), few()}, {{"a", 0, 0, scores(reference.compare(a_), reference)}});
    return out.str();
  };
  set_thread_count(1);
  const std::string one = text();
  set_thread_count(4);
  EXPECT_EQ(one, text());
  set_thread_count(0);
}

TEST_P(Compare, MoreSamplesConverge) {
  CompareOptions options{.seed = static_cast<int>(GetParam()), .iou_resolution = 0};
  const auto accuracy = [&](int samples) {
    options.samples = samples;
    return value(scored(a_, b_, options), "accuracy");
  };
  const double exact = accuracy(100'000);
  EXPECT_LT(std::abs(accuracy(10'000) - exact), 1e-2 * exact);
  EXPECT_LT(std::abs(accuracy(1'000) - exact), 4e-2 * exact);
}

TEST(Compare, AShiftedPlaneIsItsShiftAway) {
  const double shift = 0.3;
  const Mesh above = mapped(square(8), [=](const Vec3& p) { return Vec3(p.x(), p.y(), shift); });
  const auto all = scored(above, square(5));
  for (const char* name : {"c2m_thesis", "c2m_signed_mean", "c2m_rms", "c2m_p50", "c2m_max", "accuracy", "completeness",
                           "chamfer_l1", "hausdorff"})
    EXPECT_NEAR(value(all, name), shift, 1e-15) << name;
  EXPECT_NEAR(value(all, "c2m_std"), 0, 1e-15);
  EXPECT_NEAR(value(all, "chamfer_l2sq"), 2 * shift * shift, 1e-15);
  EXPECT_NEAR(*find(all, "c2m_thesis").percent, 100 * shift / std::sqrt(2), 1e-12);
  EXPECT_EQ(value(all, "f_score@2%"), 0);
  EXPECT_FALSE(find(all, "volume_iou").value);
  EXPECT_EQ(value(all, "closed"), 0);
  EXPECT_NEAR(value(scored(mapped(above, [](const Vec3& p) { return Vec3(p.x(), p.y(), -p.z()); }), square(5)),
                    "c2m_signed_mean"),
              -shift, 1e-15);
}

TEST(Compare, ACloudHasDistancesOnly) {
  const auto all = scored({{{0.5, 0.5, 0.1}, {0.5, 0.5, -0.3}}, {}}, square(1));
  EXPECT_NEAR(value(all, "c2m_thesis"), 0.2, 1e-15);
  EXPECT_NEAR(value(all, "c2m_std"), 0.1, 1e-15);
  EXPECT_NEAR(value(all, "c2m_signed_mean"), -0.1, 1e-15);
  EXPECT_NEAR(value(all, "c2m_signed_std"), 0.2, 1e-15);
  EXPECT_NEAR(value(all, "accuracy"), 0.2, 1e-15);
  EXPECT_GT(value(all, "completeness"), 0.3);
  for (const char* none : {"volume_iou", "normal_consistency", "closed", "genus", "self_intersections"})
    EXPECT_FALSE(find(all, none).value) << none;
}

// Every figure bit for bit, however small the pieces.
TEST_P(Compare, ACloudReadInPiecesHasTheFiguresOfTheWhole) {
  const TemporaryFolder folder;
  const Mesh cloud{b_.positions, {}};
  write_ply(folder / "cloud.ply", cloud, {}, {.strict = false});
  const Reference reference(a_, few());
  const auto whole = scores(reference.compare(cloud), reference);
  for (const std::size_t piece : {97ul, cloud.positions.size(), 1ul << 20}) {
    auto file = PlyCloud::open(folder / "cloud.ply");
    const auto pieces = scores(reference.compare(*file, piece), reference);
    ASSERT_EQ(pieces.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i)
      EXPECT_EQ(pieces[i].value, whole[i].value) << whole[i].name() << " in pieces of " << piece;
  }
}

TEST(Spill, RanksAbsoluteValuesAsSortingDoes) {
  std::mt19937 random(7);
  std::vector<double> values = {0, -0.0, 1e-310, -1e-310, 1e300, 3, -3, 3};
  for (int i = 0; i < 1000; ++i)
    values.push_back(random_point(random).x() * std::pow(10, static_cast<int>(random() % 9)));
  Spill spill;
  spill.append(std::span(values).first(10));
  spill.append(std::span(values).subspan(10));
  for (double& value : values) value = std::abs(value);
  std::sort(values.begin(), values.end());
  for (std::size_t rank = 0; rank < values.size(); rank += 13) EXPECT_EQ(absolute_of_rank(spill, rank), values[rank]);
  EXPECT_EQ(absolute_of_rank(spill, values.size() - 1), values.back());
}

TEST(Compare, PercentilesInterpolateBetweenRanks) {
  const Distances d = summarise({4, 1, 2, 3, 0});
  EXPECT_EQ(d.percentile(0), 0);
  EXPECT_EQ(d.percentile(50), 2);
  EXPECT_DOUBLE_EQ(d.percentile(90), 3.6);
  EXPECT_EQ(d.percentile(100), 4);
  EXPECT_EQ(d.share_within(2), 0.6);
  EXPECT_EQ(d.mean, 2);
  EXPECT_EQ(d.mean_square, 6);
}

TEST(Compare, RefusesWhatHasNoAnswer) {
  EXPECT_THROW(Reference({}, few()), std::invalid_argument);
  EXPECT_THROW(Reference(Mesh{{Vec3::Ones()}, {{0, 0, 0}}}, few()), std::invalid_argument);
  EXPECT_THROW(Reference(cube(), {.samples = 0}), std::invalid_argument);
  EXPECT_THROW(Reference(cube(), {.tolerances = {"x"}}), std::invalid_argument);
  EXPECT_THROW(Reference(cube(), {.tolerances = {"-1"}}), std::invalid_argument);
  EXPECT_THROW(Reference(cube(), few()).compare({}), std::invalid_argument);
}

TEST(Metrics, AreNamedDefinedAndDirectedOnce) {
  std::set<std::string> names;
  for (const Metric& m : metrics()) {
    EXPECT_TRUE(names.insert(m.name).second) << m.name;
    EXPECT_GT(std::string(m.formula).size(), 8u);
    EXPECT_EQ(&metric(m.name), &m);
  }
  EXPECT_THROW(metric("no such"), std::invalid_argument);
}

TEST(Report, EveryFormNamesEveryMetricWithItsDefinition) {
  const Reference reference(cube(), few());
  const ReportHead head{"ref, \"1\".ply", 8, 12, reference.diagonal(), few()};
  const std::vector<Row> rows{{"a.ply", 8, 12, scores(reference.compare(ball(8)), reference)}};
  std::ostringstream text, csv;
  write_text(text, head, rows);
  write_csv(csv, head, rows);
  const std::string json = to_json(head, rows);
  for (const Metric& m : metrics())
    for (const std::string& form : {text.str(), csv.str(), json}) {
      EXPECT_THAT(form, testing::HasSubstr(m.name));
      EXPECT_THAT(form, testing::HasSubstr(m.formula));
    }
  EXPECT_THAT(csv.str(), testing::HasSubstr("\"ref, \"\"1\"\".ply\""));
}

}  // namespace
}  // namespace carve
