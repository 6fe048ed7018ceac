#include "carve/carving/geometric_consistency.h"

#include <gmock/gmock.h>

#include <map>
#include <random>
#include <set>

#include "carve/carving/cell_alternatives.h"
#include "carve/carving/cell_solver.h"
#include "carve/carving/region_strokes.h"
#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"
#include "carving/box_world.h"
#include "shapes.h"

namespace carve {
namespace {

constexpr Consistency kArms[] = {Consistency::none, Consistency::as_printed, Consistency::two_level,
                                 Consistency::solver};

Cells traced(const VoxelGrid& hull, std::span<const RegionMap> regions) {
  Cells cells = partition(hull, regions);
  cells.rays = trace(cells, regions);
  return cells;
}

/// The world sampled at a grid's centres.
VoxelGrid truth(const BoxWorld& world, const VoxelGrid& like) {
  VoxelGrid out(like.size(), like.low(), like.spacing());
  const double unit = 1.0 / world.size.maxCoeff();
  const Vec3 low(-world.size.x() * unit / 2, 0, -world.size.z() * unit / 2);
  for (int z = 0; z < out.size().z(); ++z)
    for (int y = 0; y < out.size().y(); ++y)
      for (int x = 0; x < out.size().x(); ++x) out.set(x, y, z, world.inside((out.centre(x, y, z) - low) / unit));
  return out;
}

double iou(const BoxWorld& world, Consistency arm, int grid, const BoxDrawing& drawing = {}) {
  const ViewSet views = views_of(world, kThreeViews, drawing);
  const Carving hull = carve_silhouettes(views, {.grid = grid});
  return intersection_over_union(apply_consistency(hull, views, {.arm = arm}).grid, truth(world, hull.grid));
}

TEST(Consistency, CouchIsCarvedByOnePassAndByTheSolver) {
  EXPECT_LT(iou(couch(), Consistency::none, 40), 0.85);
  EXPECT_GT(iou(couch(), Consistency::two_level, 40), 0.99);
  EXPECT_GT(iou(couch(), Consistency::solver, 40), 0.99);
}

TEST(Consistency, SolverClimbsWalledStairs) {
  for (const int steps : {3, 5, 8})
    EXPECT_GT(iou(walled_stairs_world(steps), Consistency::solver, 5 * steps + 10), 0.99);
}

TEST(Consistency, OnePassClimbsFewWalledStairs) {
  for (const int steps : {3, 5})
    EXPECT_GT(iou(walled_stairs_world(steps), Consistency::two_level, 5 * steps + 10), 0.99);
}

TEST(Consistency, BrokenStrokesAreClosed) {
  EXPECT_GT(iou(couch(), Consistency::solver, 40, {.broken = 4}), 0.99);
  EXPECT_GT(iou(walled_stairs_world(5), Consistency::solver, 35, {.broken = 4}), 0.99);
}

/// A square with an outline and a stroke across it, in which so many pixels of every 40 are missing.
Raster<Label> broken_square(int gap) {
  Raster<Label> label(200, 200, Label::background);
  for (int y = 20; y < 180; ++y)
    for (int x = 20; x < 180; ++x) {
      const bool level = std::min(y, 199 - y) < 23 || std::abs(y - 100) < 2, upright = std::min(x, 199 - x) < 23;
      const bool drawn = (level && x % 40 >= gap) || (upright && y % 40 >= gap);
      label(x, y) = drawn ? Label::edge : Label::surface;
    }
  return label;
}

TEST(Consistency, GapsAreMeasuredOnTheOutline) {
  for (const int gap : {2, 5, 9, 14}) EXPECT_EQ(outline_gap(broken_square(gap)), gap);
  EXPECT_EQ(outline_gap(broken_square(0)), 0);   // drawn all around
  EXPECT_EQ(outline_gap(broken_square(40)), 0);  // without an outline
}

TEST(Consistency, GapsUpToTheGivenOnesAreClosed) {
  const auto parts = [](int missing, double gap) {
    Raster<Label> label = broken_square(missing);
    Raster<int> component = stroke_components(label, gap);
    fill_specks(label, component, 100);
    std::set<int> names(component.pixels.begin(), component.pixels.end());
    names.erase(-1);
    return names.size();
  };
  for (const int gap : {4, 8, 12}) {
    EXPECT_EQ(parts(gap, gap), 2u);
    EXPECT_EQ(parts(gap, gap / 2.0), 1u);
  }
}

class ConsistencyTest : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, ConsistencyTest, ::testing::Range(0u, 8u));

TEST_P(ConsistencyTest, PocketsThatStrokesDetermineAreFound) {
  EXPECT_GT(iou(random_pockets(GetParam()), Consistency::solver, 36), 0.99);
}

TEST_P(ConsistencyTest, EveryArmKeepsInsideTheHullAndItsSilhouettes) {
  const std::map<View, Mask> masks = random_masks({24, 20, 28}, GetParam());
  ViewSet views = views_of_masks(masks);
  std::mt19937 random(GetParam());
  for (AlignedView& view : views.views)  // scribbles
    for (std::size_t i = 0; i < view.drawing.labels.pixels.size(); ++i)
      if (view.drawing.labels.pixels[i] == Label::surface && random() % 4 == 0)
        view.drawing.labels.pixels[i] = Label::edge;
  const Carving hull = carve_silhouettes(views, {.grid = 28});
  for (const Consistency arm : kArms) {
    const ConsistencyResult result = apply_consistency(hull, views, {.arm = arm});
    EXPECT_TRUE(contains(hull.grid, result.grid));
    EXPECT_GE(result.score.value(), result.hull_score.value());
    for (const View view : kThreeViews) EXPECT_EQ(shadow(result.grid, view), shadow(hull.grid, view));
  }
}

TEST(Consistency, ResultDoesNotDependOnThreads) {
  const ViewSet views = views_of(couch(), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 40});
  set_thread_count(1);
  const VoxelGrid one = apply_consistency(hull, views).grid;
  set_thread_count(0);
  EXPECT_EQ(apply_consistency(hull, views).grid, one);
}

TEST(Consistency, NodesAreBounded) {
  const ViewSet views = views_of(walled_stairs_world(8), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 50});
  const auto nodes = [&](Consistency arm, int limit) {
    return apply_consistency(hull, views, {.arm = arm, .grid = {}, .vote = false, .nodes = limit}).nodes;
  };
  const std::int64_t one_pass = nodes(Consistency::two_level, 0);
  EXPECT_LE(nodes(Consistency::solver, 100), 200 + one_pass);  // that it falls back to
  EXPECT_GT(nodes(Consistency::solver, 10000), 2000 + one_pass);
  EXPECT_LE(nodes(Consistency::solver, 10000), 10100);
}

TEST(Consistency, SolverWithoutNodesFallsBackToOnePassAndSaysSo) {
  const ViewSet views = views_of(couch(), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 40});
  const ConsistencyResult cut_short = apply_consistency(hull, views, {.nodes = 0});
  EXPECT_EQ(cut_short.ran, Consistency::two_level);
  EXPECT_EQ(cut_short.grid, apply_consistency(hull, views, {.arm = Consistency::two_level}).grid);
  EXPECT_EQ(apply_consistency(hull, views).ran, Consistency::solver);
}

TEST(Consistency, TheClockEndsASearchOnlyWhereAsked) {
  const ViewSet views = views_of(walled_stairs_world(8), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 50});
  const ConsistencyResult late = apply_consistency(hull, views, {.seconds = 0});
  EXPECT_FALSE(late.in_time);
  EXPECT_LT(late.nodes, apply_consistency(hull, views).nodes);
  EXPECT_TRUE(apply_consistency(hull, views).in_time);
}

TEST(Consistency, SymmetricDrawingsGiveSymmetricSolids) {
  for (const BoxWorld& world : {couch(), walled_stairs_world(5)}) {
    const ViewSet views = views_of(world, kThreeViews);
    const VoxelGrid solid = apply_consistency(carve_silhouettes(views, {.grid = 40}), views).grid;
    const Vec3i& n = solid.size();
    for (int z = 0; z < n.z(); ++z)
      for (int y = 0; y < n.y(); ++y)
        for (int x = 0; x < n.x(); ++x) ASSERT_EQ(solid(x, y, z), solid(n.x() - 1 - x, y, z));
  }
}

TEST(Consistency, StrokesExplainedByAsManyJumpsElsewhereAreNoGain) {
  const StrokeScore hull{.drawn = 100, .explained = 20, .unexplained = 10, .uncovered = 0};
  EXPECT_TRUE((StrokeScore{100, 60, 20, 0}).explains_more_than(hull));
  EXPECT_FALSE((StrokeScore{100, 60, 25, 0}).explains_more_than(hull));
  EXPECT_FALSE((StrokeScore{100, 60, 10, 1}).explains_more_than(hull));
}

TEST(Consistency, ABoxIsTheOnlySolidOfItsDrawings) {
  const ViewSet views = views_of({{4, 5, 6}, {{{0, 0, 0}, {4, 5, 6}}}}, kThreeViews);
  const ConsistencyResult box = apply_consistency(carve_silhouettes(views, {.grid = 24}), views);
  EXPECT_EQ(box.solids, 1);
  EXPECT_TRUE(box.all_solids);
  EXPECT_TRUE(box.open_cells.empty());
}

TEST_P(ConsistencyTest, WhatAddsJumpsAndExplainsTooFewStrokesIsRestored) {
  const ViewSet views = views_of(random_pockets(GetParam()), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 24});
  std::vector<RegionMap> regions;
  for (const AlignedView& view : views.views) regions.push_back(find_regions(view, hull.grid));
  const Cells cells = traced(hull.grid, regions);
  CellProblem problem(cells, regions, {});
  for (int c = 0; c < cells.count; ++c) {
    const std::int64_t strokes = problem.strokes(), jumps = problem.jumps();
    problem.flip(std::span(&c, 1));
    const bool supported = 4 * (problem.jumps() - jumps) <= strokes - problem.strokes();
    restore_unexplained(problem);
    EXPECT_EQ(problem.keep()[c] != 0, !supported) << c;
    if (supported) problem.flip(std::span(&c, 1));
  }
  EXPECT_EQ(std::ranges::count(problem.keep(), 1), cells.count);
}

TEST_P(ConsistencyTest, EnergyDoesNotDependOnTheGrid) {
  const ViewSet views = views_of(random_pockets(GetParam()), kThreeViews);
  const auto energy = [&](int grid) {
    const Carving hull = carve_silhouettes(views, {.grid = grid});
    std::vector<RegionMap> regions;
    for (const AlignedView& view : views.views) regions.push_back(find_regions(view, hull.grid));
    return static_cast<double>(CellProblem(traced(hull.grid, regions), regions, {}).energy());
  };
  const double coarse = energy(36), fine = energy(72);
  EXPECT_NEAR(coarse / fine, 1, 0.1);
}

TEST_P(ConsistencyTest, WhatIsDroppedDoesNotDependOnTheGrid) {
  const ViewSet views = views_of(random_pockets(GetParam()), kThreeViews);
  const auto dropped = [&](int grid) {
    const Carving hull = carve_silhouettes(views, {.grid = grid});
    return 1 - apply_consistency(hull, views, {.grid = 48}).grid.volume() / hull.grid.volume();
  };
  const double decided = dropped(48);
  EXPECT_NEAR(dropped(36), decided, 0.03);
  EXPECT_NEAR(dropped(96), decided, 0.03);
}

TEST_P(ConsistencyTest, WhatTwoOfThreeGridsDropIsDropped) {
  const ViewSet views = views_of(random_pockets(GetParam()), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 40});
  const auto carved = [&](int grid, bool vote) {
    return apply_consistency(hull, views, {.grid = grid, .vote = vote, .self_check = false}).grid;
  };
  const VoxelGrid one = carved(32, false), two = carved(24, false), three = carved(36, false);
  VoxelGrid most = hull.grid;
  for (std::size_t i = 0; i < most.words().size(); ++i) {
    const std::uint64_t a = one.words()[i], b = two.words()[i], c = three.words()[i];
    most.words()[i] = (a & b) | (a & c) | (b & c);
  }
  EXPECT_EQ(carved(32, true), most);
}

TEST_P(ConsistencyTest, SpaceThatCellsOfTwoGridsShareIsCountedVoxelByVoxel) {
  const ViewSet views = views_of(random_pockets(GetParam()), kThreeViews);
  const auto cut = [&](const VoxelGrid& hull) {
    std::vector<RegionMap> regions;
    for (const AlignedView& view : views.views) regions.push_back(find_regions(view, hull));
    return partition(hull, regions);
  };
  const VoxelGrid coarse = carve_silhouettes(views, {.grid = 30}).grid,
                  fine = carve_silhouettes(views, {.grid = 75}).grid;
  const Cells other = cut(coarse), own = cut(fine);
  const auto index = [](const Cells& cells, const Vec3i& at) {
    return (at.z() * cells.size.y() + at.y()) * cells.size.x() + at.x();
  };
  const auto cell_of_voxels = [&](const Cells& cells) {
    std::vector<int> cell(cells.size.prod(), -1);
    for (const CellRun& run : cells.runs)
      for (int x = run.x0; x < run.x1; ++x) cell[index(cells, {x, run.y, run.z})] = run.cell;
    return cell;
  };
  const std::vector<int> own_cell = cell_of_voxels(own), other_cell = cell_of_voxels(other);
  std::map<std::pair<int, int>, std::int64_t> shared;
  for (int z = 0; z < own.size.z(); ++z)
    for (int y = 0; y < own.size.y(); ++y)
      for (int x = 0; x < own.size.x(); ++x) {
        const Vec3 centre = fine.low() + fine.spacing() * (Vec3(x, y, z) + Vec3::Constant(0.5));
        const Vec3i there = ((centre - coarse.low()) / coarse.spacing()).array().floor().cast<int>();
        const Vec3i in = there.cwiseMax(0).cwiseMin(other.size - Vec3i::Ones());
        const int a = own_cell[index(own, {x, y, z})], b = other_cell[index(other, in)];
        if (a >= 0 && b >= 0) ++shared[{a, b}];
      }
  std::vector<SharedSpace> expected;
  for (const auto& [pair, voxels] : shared) expected.push_back({pair.first, pair.second, voxels});
  EXPECT_EQ(shared_space(own, fine, other, coarse), expected);

  // On its own grid, each cell shares all its space with itself.
  expected.clear();
  for (int c = 0; c < own.count; ++c) expected.push_back({c, c, own.volume[c]});
  EXPECT_EQ(shared_space(own, fine, own, fine), expected);
}

TEST(Cells, AreMarkedWhereMoreThanHalfOfTheirSpaceIs) {
  const std::vector<SharedSpace> shared = {{0, 0, 4}, {0, 1, 3}, {0, 2, 2}, {1, 1, 5}, {1, 2, 5}, {3, 2, 1}};
  const std::vector<std::uint8_t> marked = {0, 1, 1};
  // Cell 0: the largest piece is not marked, most of its space is. Cell 2 shares nothing.
  EXPECT_EQ(mostly(shared, 4, marked), (std::vector<std::uint8_t>{1, 1, 0, 1}));
  EXPECT_EQ(mostly(shared, 4, std::vector<std::uint8_t>{1, 1, 0}), (std::vector<std::uint8_t>{1, 0, 0, 0}));
}

TEST_P(ConsistencyTest, SolidsThatExplainAsMuchAreCounted) {
  const ViewSet views = views_of(random_pockets(GetParam()), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 24});
  std::vector<RegionMap> regions;
  for (const AlignedView& view : views.views) regions.push_back(find_regions(view, hull.grid));
  const Cells cells = traced(hull.grid, regions);
  if (cells.count > 12) GTEST_SKIP() << "too many to try all";
  CellProblem problem(cells, regions, {});
  search_cells(problem, cells, {.nodes = 20000});

  // All choices by their numbers; those that cost no more, as far as single cells lead to them.
  const std::vector<std::uint8_t> chosen(problem.keep().begin(), problem.keep().end());
  const std::int64_t most = problem.misfit();
  const auto choose = [&](unsigned number) {
    std::vector<int> other;
    for (int c = 0; c < cells.count; ++c)
      if (problem.keep()[c] != (number >> c & 1)) other.push_back(c);
    problem.flip(other);
  };
  unsigned first = 0, open = 0;
  for (int c = 0; c < cells.count; ++c) first |= unsigned{chosen[c]} << c;
  std::vector<unsigned> found{first};
  for (std::size_t k = 0; k < found.size(); ++k)
    for (int c = 0; c < cells.count; ++c) {
      const unsigned next = found[k] ^ 1u << c;
      choose(next);
      if (problem.misfit() > most || std::ranges::count(found, next)) continue;
      found.push_back(next);
      open |= next ^ first;
    }
  choose(first);

  const Alternatives others = find_alternatives(problem, 1 << 20);
  EXPECT_TRUE(others.all);
  EXPECT_EQ(others.solids, static_cast<std::int64_t>(found.size()));
  unsigned named = 0;
  for (const int c : others.cells) named |= 1u << c;
  EXPECT_EQ(named, open);
  EXPECT_TRUE(std::ranges::equal(problem.keep(), chosen));
}

TEST(Consistency, OptionsOutOfRangeAreNamed) {
  const ViewSet views = views_of(couch(), kThreeViews);
  const Carving hull = carve_silhouettes(views, {.grid = 20});
  EXPECT_THAT([&] { apply_consistency(hull, views, {.nodes = -1}); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("consistency.nodes must be")));
}

}  // namespace
}  // namespace carve
