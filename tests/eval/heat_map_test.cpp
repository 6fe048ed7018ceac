#include "eval/heat_map.h"

#include <gmock/gmock.h>

#include <cstring>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/core/parallel.h"
#include "carve/mesh/mesh_io.h"
#include "carve/mesh/topology.h"
#include "eval/meshes.h"
#include "eval/text.h"
#include "temporary_folder.h"

namespace carve {
namespace {

constexpr double kDiagonal = 2;

HeatMap map_of(const Mesh& mesh, double distance) {
  return {"title", mesh, std::vector<double>(mesh.positions.size(), distance)};
}

TEST(Ramp, SaysShrunkNearInflatedAndFar) {
  const Rgba shrunk = colour(Ramp::thesis, -1, 1), near = colour(Ramp::thesis, 0, 1),
             inflated = colour(Ramp::thesis, 0.5, 1), far = colour(Ramp::thesis, 1, 1);
  EXPECT_GT(shrunk.b, std::max(shrunk.r, shrunk.g));
  EXPECT_GT(near.g, std::max(near.r, near.b));
  EXPECT_GT(std::min(inflated.r, inflated.g), 200);
  EXPECT_LT(inflated.b, 50);
  EXPECT_GT(far.r, std::max(far.g, far.b) + 100);
}

TEST(Ramp, DivergingIsLightestAtNothingAndSequentialGrowsLighter) {
  const auto light = [](Rgba c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; };
  for (double d = 0; d < 0.99; d += 0.05) {
    EXPECT_GT(light(colour(Ramp::diverging, d, 1)), light(colour(Ramp::diverging, d + 0.05, 1)));
    EXPECT_GT(light(colour(Ramp::diverging, -d, 1)), light(colour(Ramp::diverging, -d - 0.05, 1)));
    EXPECT_LT(light(colour(Ramp::sequential, d, 1)), light(colour(Ramp::sequential, d + 0.05, 1)));
  }
  EXPECT_EQ(colour(Ramp::sequential, 0.3, 1), colour(Ramp::sequential, -0.3, 1));
}

TEST(Ramp, ScalesWithTheRangeAndEndsThere) {
  for (const Ramp ramp : {Ramp::thesis, Ramp::diverging, Ramp::sequential}) {
    EXPECT_EQ(colour(ramp, 3, 10), colour(ramp, 0.3, 1));
    EXPECT_EQ(colour(ramp, 7, 2), colour(ramp, 2, 2));
    EXPECT_EQ(colour(ramp, -7, 2), colour(ramp, -2, 2));
  }
}

TEST(WithShortEdges, KeepsTheSurfaceAndLeavesNoLongEdge) {
  for (const Mesh& mesh : {cube(), globe(5, 7, [](double p, double a) { return 1 + 0.3 * std::sin(3 * p + a); })})
    for (const double longest : {10.0, 0.7, 0.31, 0.05}) {
      const Mesh fine = with_short_edges(mesh, longest);
      const Topology before = topology(mesh), after = topology(fine);
      EXPECT_NEAR(after.area, before.area, 1e-9);
      EXPECT_NEAR(after.volume, before.volume, 1e-9);
      EXPECT_TRUE(after.solid());
      for (const Triangle& t : fine.triangles)
        for (int k = 0; k < 3; ++k) EXPECT_LE((fine.positions[t[k]] - fine.positions[t[(k + 1) % 3]]).norm(), longest);
      EXPECT_TRUE(std::equal(mesh.positions.begin(), mesh.positions.end(), fine.positions.begin()));
    }
  EXPECT_EQ(with_short_edges(cube(), 10), cube());
}

TEST(Text, LeavesInkWhereItIsDrawnAndNowhereElse) {
  Picture picture(200, 40, Rgba{255, 255, 255, 255});
  const Picture blank = picture;
  draw_text(picture, 10, 25, 16, "");
  EXPECT_EQ(picture, blank);
  draw_text(picture, 10, 25, 16, "0.5 % µ \xff");
  EXPECT_NE(picture, blank);
  bool blotted = false;
  const double width = text_width(16, "0.5 % µ \xff");
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (x < 9 || x > 11 + width || y < 8 || y > 31) blotted |= picture(x, y) != blank(x, y);
  EXPECT_FALSE(blotted);
  draw_text(picture, 195, 25, 16, "cut off at the border");
  draw_text(picture, -50, -10, 16, "outside");
}

TEST(HeatMap, AutomaticRangeCoversAlmostAllAndIsShared) {
  HeatMap small = map_of(ball(10), 0.001), large = map_of(ball(10), -0.03);
  EXPECT_DOUBLE_EQ(heat_range({small}, kDiagonal, {}), 0.05 / 100 * kDiagonal);
  EXPECT_DOUBLE_EQ(heat_range({small, large}, kDiagonal, {}), 1.5 / 100 * kDiagonal);
  EXPECT_DOUBLE_EQ(heat_range({small, large}, kDiagonal, {.range = 3}), 3.0 / 100 * kDiagonal);
  EXPECT_EQ(saturated_share(large, 0.02), 1);
  EXPECT_EQ(saturated_share(large, 0.03), 0);
  EXPECT_GT(heat_range({map_of(ball(10), 0)}, kDiagonal, {}), 0);
}

TEST(HeatMap, APictureShowsTheColourOfTheDistance) {
  const auto green = [](const Picture& picture) {
    return std::count_if(picture.pixels.begin(), picture.pixels.end(),
                         [](Rgba c) { return c.g > c.r + 60 && c.g > c.b + 60; });
  };
  const auto red = [](const Picture& picture) {
    return std::count_if(picture.pixels.begin(), picture.pixels.end(),
                         [](Rgba c) { return c.r > c.g + 60 && c.r > c.b + 60; });
  };
  const HeatMapOptions options{.range = 1, .views = {"front", "0:30"}, .size = 100};
  const Picture near = draw_heat_maps({map_of(ball(20), 0)}, ball(20), kDiagonal, options);
  const Picture far = draw_heat_maps({map_of(ball(20), 0.5)}, ball(20), kDiagonal, options);
  EXPECT_GT(green(near), green(far) + 12000);  // two discs of 100 pixels across
  EXPECT_GT(red(far), red(near) + 12000);
}

TEST(HeatMap, StripsGrowByAColumnAMeshOnOneScale) {
  const HeatMapOptions options{.views = {"front"}, .size = 100};
  const auto width = [&](int meshes) {
    return draw_heat_maps(std::vector<HeatMap>(meshes, map_of(ball(10), 0.01)), ball(10), kDiagonal, options).width;
  };
  EXPECT_GT(width(3), width(2) + 100);
  EXPECT_EQ(width(4) - width(3), width(3) - width(2));
}

TEST(HeatMap, ThreadsDoNotChangeAPixel) {
  const auto picture = [] { return draw_heat_maps({map_of(potato(20, 1), 0.01)}, ball(10), kDiagonal, {.size = 100}); };
  set_thread_count(1);
  const Picture one = picture();
  set_thread_count(4);
  EXPECT_EQ(one, picture());
  set_thread_count(0);
}

TEST(HeatMap, RefusesUnknownViewsAndClouds) {
  const std::vector<HeatMap> maps{map_of(ball(10), 0)};
  EXPECT_THROW(draw_heat_maps({}, ball(10), kDiagonal), std::invalid_argument);
  for (const char* view : {"inside", "1:", ":", "1:2:3", "0:91"})
    EXPECT_THROW(draw_heat_maps(maps, ball(10), kDiagonal, {.views = {view}}), std::invalid_argument) << view;
  EXPECT_THROW(draw_heat_maps(maps, ball(10), kDiagonal, {.views = {}}), std::invalid_argument);
  EXPECT_THROW(draw_heat_maps(maps, ball(10), kDiagonal, {.size = 1}), std::invalid_argument);
  EXPECT_THROW(draw_heat_maps({map_of({{Vec3::Zero()}, {}}, 0)}, ball(10), kDiagonal), std::invalid_argument);
}

TEST(HeatFiles, APlyReadsBackAsItsMesh) {
  const TemporaryFolder folder;
  const Mesh mesh = potato(10, 1);
  write_heat_ply(folder / "a.ply", map_of(mesh, -0.25), Ramp::thesis, 1);
  EXPECT_EQ(read_mesh(folder / "a.ply"), mesh);
  const std::string bytes = read_file(folder / "a.ply");
  for (const char* property : {"float quality\n", "float scalar_C2M\n", "uchar red\n", "uchar green\n", "uchar blue\n"})
    EXPECT_THAT(bytes, testing::HasSubstr(property));
  // The first vertex: three doubles, then the distance twice, then its colour.
  const char* vertex = bytes.data() + bytes.find("end_header\n") + 11 + 24;
  float values[2];
  std::memcpy(values, vertex, 8);
  EXPECT_EQ(values[0], -0.25f);
  EXPECT_EQ(values[1], -0.25f);
  const Rgba expected = colour(Ramp::thesis, -0.25, 1);
  EXPECT_EQ(std::string(vertex + 8, 3), (std::string{char(expected.r), char(expected.g), char(expected.b)}));
}

// The appended arrays stand one after another, each behind its length.
TEST(HeatFiles, AVtpHoldsPointsDistancesAndTriangles) {
  const TemporaryFolder folder;
  const Mesh mesh = cube();
  write_heat_vtp(folder / "a.vtp", map_of(mesh, 0.125), Ramp::diverging, 1);
  const std::string bytes = read_file(folder / "a.vtp");
  const std::size_t data = bytes.find("\n_") + 2;
  const auto array = [&](std::size_t offset) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + data + offset, 8);
    return bytes.substr(data + offset + 8, length);
  };
  std::vector<std::string> arrays;
  for (std::size_t at = 0; (at = bytes.find("offset=\"", at)) != std::string::npos; at += 8)
    arrays.push_back(array(std::stoul(bytes.substr(at + 8))));
  ASSERT_EQ(arrays.size(), 5u);
  EXPECT_EQ(arrays[0].size(), 8 * 8u);
  double first = 0;
  std::memcpy(&first, arrays[0].data(), 8);
  EXPECT_EQ(first, 0.125);
  EXPECT_EQ(arrays[1].size(), 8 * 3u);
  EXPECT_EQ(arrays[2].size(), 8 * 24u);
  EXPECT_EQ(std::memcmp(arrays[2].data(), mesh.positions.data(), 8 * 24), 0);
  EXPECT_EQ(arrays[3].size(), 12 * 24u);
  EXPECT_EQ(arrays[4].size(), 12 * 8u);
}

}  // namespace
}  // namespace carve
