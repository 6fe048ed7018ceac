#include "carve/texture/texture.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "carve/core/error.h"
#include "carve/core/parallel.h"
#include "carve/mesh/neighbours.h"
#include "carve/texture/paint.h"
#include "texture/painted.h"

namespace carve {

std::vector<int> charts_of(const TexturedMesh& model) {
  std::vector<int> root(model.uvs.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& [a, b, c] : model.uv_triangles) root[find(a)] = find(b), root[find(c)] = find(b);
  std::vector<int> chart;
  for (const Triangle& t : model.uv_triangles) chart.push_back(find(t[0]));
  return chart;
}

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TextureOptions arm(TextureArm arm, Mirror mirror = Mirror::automatic) {
  TextureOptions options;
  options.arm = arm;
  options.mirror = mirror;
  return options;
}

// Every coordinate in [0, 1], no texel in two triangles, all triangles face up, charts `gutter` apart.
void expect_sound(const TexturedMesh& model, int gutter) {
  ASSERT_EQ(model.uv_triangles.size(), model.mesh.triangles.size());
  for (const Vec2& uv : model.uvs) {
    ASSERT_GE(uv.minCoeff(), 0);
    ASSERT_LE(uv.maxCoeff(), 1);
  }
  for (const auto& [i, j, k] : model.uv_triangles) {
    const Vec2 a = model.uvs[j] - model.uvs[i], b = model.uvs[k] - model.uvs[i];
    ASSERT_LE(a.x() * b.y() - a.y() * b.x(), 1e-12) << "laid out face down";
  }
  const Raster<int> cover = covering(model);
  const std::vector<int> chart = charts_of(model);
  for (int y = 0; y < cover.height; ++y)
    for (int x = 0; x < cover.width; ++x) {
      ASSERT_NE(cover(x, y), -2) << "two triangles on texel " << x << ", " << y;
      if (cover(x, y) < 0) continue;
      for (int v = y; v <= std::min(y + gutter, cover.height - 1); ++v)
        for (int u = std::max(0, x - gutter); u <= std::min(x + gutter, cover.width - 1); ++u) {
          const bool near = (u - x) * (u - x) + (v - y) * (v - y) < gutter * gutter;
          ASSERT_FALSE(near && cover(u, v) >= 0 && chart[cover(u, v)] != chart[cover(x, y)])
              << "gutter at " << x << ", " << y;
        }
    }
}

class TextureOfShapes : public ::testing::TestWithParam<int> {
 protected:
  Shape shape() const { return all_shapes()[GetParam()]; }
};
INSTANTIATE_TEST_SUITE_P(Shapes, TextureOfShapes, ::testing::Range(0, static_cast<int>(all_shapes().size())),
                         [](const auto& info) { return all_shapes()[info.param].name; });

TEST_P(TextureOfShapes, IsLaidOutSoundly) {
  const Scene scene = carve::scene(shape(), plain);
  for (const int gutter : {1, 4, 9}) expect_sound(textured(scene, {}, {.size = 400, .gutter = gutter}), gutter);
  expect_sound(textured(scene, {}, {.size = 256, .exact = false}), 4);
  expect_sound(textured(scene, arm(TextureArm::blend), {.size = 64}), 4);
  expect_sound(textured(scene, {}, {.arm = AtlasArm::clusters, .size = 400}), 4);
}

int chart_count(const TexturedMesh& model) {
  std::vector<int> charts = charts_of(model);
  std::ranges::sort(charts);
  return static_cast<int>(std::unique(charts.begin(), charts.end()) - charts.begin());
}

TEST(Clusters, AreJoinedAsFarAsDistortionAndNumberSay) {
  const Scene scene = carve::scene(ball(), plain);
  const auto count = [&](int max_clusters, double max_distortion) {
    AtlasOptions options{.arm = AtlasArm::clusters, .size = 512};
    options.max_clusters = max_clusters, options.max_distortion = max_distortion;
    return chart_count(textured(scene, {}, options));
  };
  EXPECT_EQ(count(60, 1), 60);
  EXPECT_LT(count(1, 0.05), count(1, 0.01));
  EXPECT_LT(count(1, 0.01), count(1, 0.001));
}

TEST(Clusters, OfABoxAreItsSides) {
  Mesh mesh = carve::scene(box(), plain, {}, 16).mesh;
  const ViewSet views = carve::scene(box(), plain, {}, 16).views;
  mesh = mesh_of(views, 16, 0);
  const Charts charts = cluster_charts(mesh, views, {.max_distortion = 1e-4, .max_clusters = 1});
  // Sides are flat: whatever lies inside one is joined; bevels at edges of the grid stay apart.
  std::map<std::pair<int, int>, std::set<int>> on_side;
  const auto normals = triangle_normals(mesh);
  for (std::size_t t = 0; t < normals.size(); ++t)
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(normals[t][axis]) > 0.999) on_side[{axis, normals[t][axis] > 0}].insert(charts.chart[t]);
  EXPECT_EQ(on_side.size(), 6U);
  for (const auto& [side, found] : on_side) EXPECT_EQ(found.size(), 1U);
}

TEST_P(TextureOfShapes, OfOneColourHasThatColourEverywhere) {
  const Rgba colour{93, 171, 60, 255};
  const Scene scene = carve::scene(shape(), [&](View, int, int) { return colour; }, {.stroke = 3});
  for (const TextureArm a : {TextureArm::blend, TextureArm::best_view})
    for (const Mirror mirror : {Mirror::automatic, Mirror::no}) {
      const TexturedMesh model = textured(scene, arm(a, mirror));
      EXPECT_EQ(std::ranges::count(model.texture.pixels, colour), std::ssize(model.texture.pixels));
    }
}

TEST_P(TextureOfShapes, ThreadsDoNotChangeIt) {
  const Scene scene = carve::scene(shape(), noise);
  set_thread_count(1);
  const TexturedMesh one = textured(scene);
  set_thread_count(3);
  const TexturedMesh three = textured(scene);
  set_thread_count(0);
  EXPECT_EQ(one.texture, three.texture);
  EXPECT_EQ(one.uvs, three.uvs);
  EXPECT_EQ(one.uv_triangles, three.uv_triangles);
}

class TextureOfSilhouettes : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, TextureOfSilhouettes, ::testing::Range(0U, 10U));

TEST_P(TextureOfSilhouettes, IsLaidOutSoundly) {
  Scene scene{views_of_masks(random_masks({14, 12, 10}, GetParam())), {}};
  scene.mesh = mesh_of(scene.views, 28, static_cast<int>(GetParam() % 3));
  expect_sound(textured(scene, {}, {.size = 512, .gutter = 2}), 2);
}

// What a texel shows is a pixel of a drawing, not a mixture: where charts fit one to one, every colour of the texture
// away from seams is one that was drawn.
TEST(ViewCharts, KeepTheDrawingsPixels) {
  const Scene scene = carve::scene(box(), noise, {.pixels = 100});
  TextureOptions options = arm(TextureArm::best_view);
  options.level = 0;
  const TexturedMesh model = textured(scene, options, {.size = 320});  // too small for two texels a pixel
  const ViewChoice choice = choose_views(scene.mesh, scene.views, Drawings(scene.views, options), options);
  const Raster<int> cover = covering(model);
  std::map<int, int> found, all;
  for (std::size_t i = 0; i < cover.pixels.size(); ++i) {
    if (cover.pixels[i] < 0) continue;
    const int view = choice.projections[choice.projection[cover.pixels[i]]].view;
    if (view < 0) continue;
    const Drawing& drawing = scene.views.views[view].drawing;
    ++all[view];
    found[view] += std::ranges::count(drawing.picture.pixels, model.texture.pixels[i]) > 0;
  }
  EXPECT_EQ(all.size(), 3U);
  for (const auto& [view, count] : all) EXPECT_GT(found[view], 0.99 * count) << name(scene.views.views[view].view);
}

Rgba texel_at(const TexturedMesh& model, int triangle) {
  Vec2 centre = Vec2::Zero();
  for (const int i : model.uv_triangles[triangle]) centre += model.uvs[i] / 3;
  return model.texture(static_cast<int>(centre.x() * model.texture.width),
                       static_cast<int>(centre.y() * model.texture.height));
}

// The triangles whose centres are within `reach` of a point.
template <class Visit>
int for_triangles_near(const Mesh& mesh, const Vec3& point, double reach, const Visit& visit) {
  int count = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const int v : mesh.triangles[t]) centre += mesh.positions[v] / 3;
    if ((centre - point).norm() < reach) visit(t), ++count;
  }
  return count;
}

TEST(BestView, GivesEachSideItsDrawing) {
  const Scene scene = carve::scene(box({1, 0.75, 0.5}), plain);
  const TexturedMesh model = textured(scene, arm(TextureArm::best_view, Mirror::no));
  const std::pair<View, Vec3> sides[] = {
      {View::front, {0, 0.375, 0.25}}, {View::side, {0.5, 0.375, 0}}, {View::top, {0, 0.75, 0}}};
  for (const auto& [view, centre] : sides)
    EXPECT_GT(
        for_triangles_near(model.mesh, centre, 0.1,
                           [&, view = view](int t) { EXPECT_EQ(texel_at(model, t), plain(view, 0, 0)) << name(view); }),
        4);
}

TEST(BestView, WhatIsHiddenInADrawingTakesNothingFromIt) {
  // From above the torus hides its lower half, whose inner wall looks up nowhere but is reached by the front only from
  // outside: with walled stairs, the front wall's inner side is hidden in the front drawing.
  const Shape shape = walled_stairs(4);
  const Scene scene = carve::scene(shape, plain, {.pixels = 160}, 64);
  const ViewChoice choice =
      choose_views(scene.mesh, scene.views, Drawings(scene.views, {}), arm(TextureArm::best_view, Mirror::no));
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const int view = choice.projections[choice.projection[t]].view;
    if (view < 0) continue;
    const SignedAxis toward = frame(scene.views.views[view].view).toward;
    Vec3 centre = Vec3::Zero();
    for (const int v : scene.mesh.triangles[t]) centre += scene.mesh.positions[v] / 3;
    // Nothing of the mesh lies in front of the triangle, by more than the drawing's pixels.
    for (const Vec3& p : scene.mesh.positions) {
      Vec3 off = p - centre;
      const double before = toward.sign * off[toward.axis];
      off[toward.axis] = 0;
      ASSERT_FALSE(before > 0.1 && off.norm() < 0.004)
          << "triangle " << t << " from " << name(scene.views.views[view].view);
    }
  }
}

TEST(BestView, TheLeftSideMirrorsTheRightOneUnlessTold) {
  const Scene scene = carve::scene(box(), plain);
  const Vec3 left(-0.5, 0.375, 0);
  const TexturedMesh mirrored = textured(scene), filled = textured(scene, arm(TextureArm::best_view, Mirror::no));
  for_triangles_near(scene.mesh, left, 0.1, [&](int t) {
    EXPECT_EQ(texel_at(mirrored, t), plain(View::side, 0, 0));
    EXPECT_FALSE(texel_at(filled, t) == plain(View::side, 0, 0));
  });
}

TEST(BestView, TheBackTakesTheFrontOnlyWhereThin) {
  for (const double depth : {0.04, 0.5}) {
    const Scene scene = carve::scene(box({1, 0.75, depth}), plain, {}, 64);
    const TexturedMesh automatic = textured(scene), yes = textured(scene, arm(TextureArm::best_view, Mirror::yes));
    EXPECT_GT(for_triangles_near(scene.mesh, {0, 0.375, -depth / 2}, 0.1,
                                 [&](int t) {
                                   EXPECT_EQ(texel_at(automatic, t) == plain(View::front, 0, 0), depth < 0.1);
                                   EXPECT_EQ(texel_at(yes, t), plain(View::front, 0, 0));
                                 }),
              4);
  }
}

TEST(BestView, WhatADrawingShowsAtAnAngleWinsOverAGuess) {
  // The back of the box slants, so that the side's drawing sees it at 68 degrees; the front's would be a guess.
  Scene scene = carve::scene(box({1, 0.75, 0.5}), plain);
  for (Vec3& p : scene.mesh.positions) p.z() = 0.25 - (0.25 - p.z()) * (0.6 - 0.8 * p.x());
  for (const double agree : {0.0, TextureOptions{}.agree}) {
    TextureOptions options = arm(TextureArm::best_view, Mirror::yes);
    options.agree = agree;
    const ViewChoice choice = choose_views(scene.mesh, scene.views, Drawings(scene.views, options), options);
    const View taken = agree > 0 ? View::side : View::front;
    EXPECT_GT(
        for_triangles_near(
            scene.mesh, {0.1, 0.375, -0.01}, 0.1,
            [&](int t) { EXPECT_EQ(scene.views.views[choice.projections[choice.projection[t]].view].view, taken); }),
        4);
  }
}

TEST(BestView, StrokesDoNotReachTheTexture) {
  const Scene scene = carve::scene(stairs(4), plain, {.pixels = 160, .stroke = 4}, 64);
  const TexturedMesh model = textured(scene);
  const auto is_dark = [](Rgba p) { return p.r < 36 && p.g < 36 && p.b < 36; };
  EXPECT_EQ(std::ranges::count_if(model.texture.pixels, is_dark), 0);
  TextureOptions raw = arm(TextureArm::best_view);
  raw.inpaint = false;
  EXPECT_GT(std::ranges::count_if(textured(scene, raw).texture.pixels, is_dark), 20);
}

TEST(BestView, UnseenPartsStayWithinTheColoursAroundThem) {
  const Scene scene = carve::scene(box({1, 0.75, 0.5}), [](View view, int x, int) {
    return Rgba{static_cast<std::uint8_t>(100 + x % 50), 120, static_cast<std::uint8_t>(view == View::top ? 90 : 140),
                255};
  });
  const TexturedMesh model = textured(scene, arm(TextureArm::best_view, Mirror::no));
  for (const Rgba p : model.texture.pixels) {
    ASSERT_THAT(p.r, AllOf(::testing::Ge(99), ::testing::Le(151)));
    ASSERT_THAT(p.g, AllOf(::testing::Ge(119), ::testing::Le(121)));
    ASSERT_THAT(p.b, AllOf(::testing::Ge(89), ::testing::Le(141)));
  }
}

TEST(BestView, UnseenPartsTakeFlatColoursNotMixtures) {
  const Scene scene = carve::scene(box({1, 0.75, 0.5}), plain);
  const TexturedMesh model = textured(scene, arm(TextureArm::best_view, Mirror::no));
  const Raster<int> cover = covering(model);
  int flat = 0, all = 0;
  for (std::size_t i = 0; i < cover.pixels.size(); ++i) {
    if (cover.pixels[i] < 0) continue;
    ++all;
    flat += std::ranges::any_of(kThreeViews, [&](View view) { return model.texture.pixels[i] == plain(view, 0, 0); });
  }
  EXPECT_GT(flat, 0.9 * all);
}

TEST(BestView, UnseenPartsTakeWhatIsAsHighRatherThanWhatIsAbove) {
  const Scene scene = carve::scene(box({1, 0.75, 0.5}), plain);
  const TexturedMesh model = textured(scene);  // the back's middle: 0.5 beside the sides, 0.35 below the top
  EXPECT_GT(for_triangles_near(model.mesh, {0, 0.4, -0.25}, 0.1,
                               [&](int t) { EXPECT_EQ(texel_at(model, t), plain(View::side, 0, 0)); }),
            4);
}

TEST(Level, MovesBothSidesOfAFaintSeamToMeetAndLeavesStrongOnesAlone) {
  for (const int difference : {20, 120}) {
    const auto painter = [&](View view, int, int) {
      return Rgba{static_cast<std::uint8_t>(view == View::top ? 80 + difference : 80), 90, 90, 255};
    };
    const Scene scene = carve::scene(box(), painter, {}, 48);
    const TexturedMesh model = textured(scene);
    int between = 0;
    for (const Rgba p : model.texture.pixels) between += p.r > 84 && p.r < 76 + difference;
    const TexturedMesh sharp = textured(scene, [] {
      TextureOptions options;
      options.level = 0;
      return options;
    }());
    int without = 0;
    for (const Rgba p : sharp.texture.pixels) without += p.r > 84 && p.r < 76 + difference;
    if (difference < 32) {
      EXPECT_GT(between, without + 100);
    } else {
      EXPECT_EQ(between, without);
    }
  }
}

TEST(Blend, WeighsDrawingsByTheNormal) {
  const Scene scene = carve::scene(ball(), plain, {}, 48);
  const auto paints = paint_by_normal(scene.mesh, scene.views, Mirror::no);
  const auto mirrored = paint_by_normal(scene.mesh, scene.views, Mirror::yes);
  for (std::size_t t = 0; t < paints.size(); ++t) {
    const auto [a, b, c] = scene.mesh.triangles[t];
    const Vec3& p = scene.mesh.positions[a];
    Vec3 n = (scene.mesh.positions[b] - p).cross(scene.mesh.positions[c] - p).normalized();
    for (const bool mirror : {false, true}) {
      Vec3 weight = n.cwiseMax(0);
      if (mirror) weight.x() = std::abs(n.x());
      const double sum = weight.sum();
      for (const Layer& layer : mirror ? mirrored[t] : paints[t]) {
        if (layer.view < 0) continue;
        const int axis = frame(scene.views.views[layer.view].view).toward.axis;
        EXPECT_NEAR(layer.weight, sum > 0 ? weight[axis] / sum : 0, 1e-5);
      }
    }
  }
}

TEST(TextureOptions, OutOfRangeAreRefusedInOneLine) {
  const Scene scene = carve::scene(box(), plain, {}, 16);
  EXPECT_THAT(
      [&] { textured(scene, {}, {.size = 9000}); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("atlas.size must be a whole number in [16, 8192], got 9000")));
  EXPECT_THAT([&] { textured(scene, {}, {.gutter = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("atlas.gutter must be a whole number in [1, 64], got 0")));
  EXPECT_THAT([&] { texture(scene.mesh, scene.views, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("texture.arm must be blend or best_view")));
  EXPECT_THAT([&] { texture({}, scene.views, arm(TextureArm::best_view)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("must have triangles")));
  EXPECT_THAT([&] { textured(scene, {}, {.size = 16, .gutter = 64}); },
              ThrowsMessage<NoResult>(HasSubstr("atlas.size must be larger")));
}

}  // namespace
}  // namespace carve
