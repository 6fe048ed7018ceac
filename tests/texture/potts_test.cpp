#include "carve/texture/potts.h"

#include <gmock/gmock.h>

#include <numeric>
#include <random>

#include "carve/texture/packing.h"

namespace carve {
namespace {

std::int64_t energy(const PottsProblem& problem, const std::vector<int>& labels) {
  std::int64_t sum = 0;
  for (std::size_t node = 0; node < labels.size(); ++node) sum += problem.costs[node * problem.labels + labels[node]];
  for (const auto& [a, b, weight] : problem.edges) sum += labels[a] == labels[b] ? 0 : weight;
  return sum;
}

PottsProblem random_problem(unsigned seed, int nodes, int labels) {
  std::mt19937 random(seed);
  const auto below = [&](int bound) { return static_cast<int>(random() % static_cast<unsigned>(bound)); };
  PottsProblem problem{labels, {}, {}};
  for (int i = 0; i < nodes * labels; ++i)
    problem.costs.push_back(below(6) == 0 && i % labels != 0 ? PottsProblem::kImpossible : below(50));
  for (int i = 0; i < 2 * nodes; ++i) {
    const int a = below(nodes), b = below(nodes);
    if (a != b) problem.edges.push_back({a, b, below(40)});
  }
  return problem;
}

std::int64_t least_energy(const PottsProblem& problem, int nodes) {
  std::vector<int> labels(nodes);
  std::int64_t least = energy(problem, labels);
  for (;;) {
    int i = 0;
    while (i < nodes && ++labels[i] == problem.labels) labels[i++] = 0;
    if (i == nodes) return least;
    least = std::min(least, energy(problem, labels));
  }
}

class Potts : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Potts, ::testing::Range(0U, 40U));

TEST_P(Potts, OfTwoLabelsIsSolvedExactly) {
  const PottsProblem problem = random_problem(GetParam(), 12, 2);
  EXPECT_EQ(energy(problem, minimise(problem)), least_energy(problem, 12));
}

TEST_P(Potts, OfFourLabelsIsWithinTwiceTheLeast) {
  const PottsProblem problem = random_problem(GetParam(), 8, 4);
  const std::int64_t found = energy(problem, minimise(problem)), least = least_energy(problem, 8);
  EXPECT_GE(found, least);
  EXPECT_LE(found, 2 * least);
}

TEST_P(Potts, CutIsTheSmallest) {
  std::mt19937 random(GetParam());
  constexpr int kNodes = 10;
  std::vector<int> terminal(kNodes);
  Cut cut(kNodes);
  for (int i = 0; i < kNodes; ++i) cut.add_terminal(i, terminal[i] = static_cast<int>(random() % 41) - 20);
  std::vector<std::array<int, 3>> arcs;
  for (int i = 0; i < 25; ++i) {
    const int a = static_cast<int>(random() % kNodes), b = static_cast<int>(random() % kNodes),
              c = static_cast<int>(random() % 15);
    if (a == b) continue;
    arcs.push_back({a, b, c});
    cut.add_arc(a, b, c);
  }
  const auto value = [&](const std::vector<bool>& sink) {
    int sum = 0;
    for (int i = 0; i < kNodes; ++i) sum += sink[i] ? std::max(0, terminal[i]) : std::max(0, -terminal[i]);
    for (const auto& [a, b, c] : arcs) sum += !sink[a] && sink[b] ? c : 0;
    return sum;
  };
  int least = std::numeric_limits<int>::max();
  for (int bits = 0; bits < 1 << kNodes; ++bits) {
    std::vector<bool> sink(kNodes);
    for (int i = 0; i < kNodes; ++i) sink[i] = bits >> i & 1;
    least = std::min(least, value(sink));
  }
  EXPECT_EQ(value(cut.sink_side()), least);
}

TEST_P(Potts, PackedShapesDoNotMeet) {
  std::mt19937 random(GetParam());
  std::vector<Mask> shapes;
  int cells = 0;
  for (int i = 0; i < 40; ++i) {
    Mask shape(1 + static_cast<int>(random() % 90), 1 + static_cast<int>(random() % 20));
    for (std::uint8_t& cell : shape.pixels) cells += cell = random() % 3 == 0;
    shapes.push_back(shape);
  }
  const auto places = pack(shapes, 200);
  ASSERT_TRUE(places);
  Raster<int> sheet(200, 200);
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (int y = 0; y < shapes[i].height; ++y)
      for (int x = 0; x < shapes[i].width; ++x)
        if (shapes[i](x, y)) {
          ASSERT_TRUE(sheet.contains((*places)[i].x + x, (*places)[i].y + y));
          EXPECT_EQ(sheet((*places)[i].x + x, (*places)[i].y + y)++, 0);
        }
  EXPECT_EQ(std::accumulate(sheet.pixels.begin(), sheet.pixels.end(), 0), cells);
  EXPECT_FALSE(pack(shapes, 60));
}

}  // namespace
}  // namespace carve
