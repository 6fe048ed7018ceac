#include "eval/texture_scores.h"

#include <gmock/gmock.h>

#include "eval/meshes.h"
#include "eval/ramp.h"
#include "eval/render.h"
#include "eval/texture_sheet.h"
#include "texture/painted.h"

namespace carve {
namespace {

// A cube whose six sides lie side by side on the texture, each 1/8 wide, face up, nothing stretched.
TexturedMesh unfolded_cube() {
  TexturedMesh model{cube(), {}, {}, Picture(64, 64, {10, 200, 30, 255})};
  for (std::size_t t = 0; t < model.mesh.triangles.size(); ++t) {
    const Vec3 a = model.mesh.positions[model.mesh.triangles[t][0]];
    const Vec3 p = model.mesh.positions[model.mesh.triangles[t][1]] - a;
    const Vec3 q = model.mesh.positions[model.mesh.triangles[t][2]] - a;
    const Vec3 x = p.normalized(), y = p.cross(q).cross(p).normalized();
    const Vec2 place(static_cast<double>(t % 6) / 6 + 0.02, t < 6 ? 0.4 : 0.8);
    const int first = static_cast<int>(model.uvs.size());
    for (const Vec3& v : {Vec3(Vec3::Zero()), p, q}) model.uvs.push_back(place + Vec2(v.dot(x), -v.dot(y)) / 12);
    model.uv_triangles.push_back({first, first + 1, first + 2});
  }
  return model;
}

TEST(AtlasScores, OfAnUnfoldedCubeAreItsGeometry) {
  const AtlasScores scores = atlas_scores(unfolded_cube());
  EXPECT_EQ(scores.charts, 12);
  EXPECT_EQ(scores.flipped, 0);
  EXPECT_NEAR(scores.distortion, 4, 1e-9);
  EXPECT_NEAR(scores.packing, 6.0 / 144, 1e-9);
  EXPECT_NEAR(scores.seam_length, 12 + 6 * std::sqrt(2), 1e-9);
  EXPECT_NEAR(scores.seam_contrast, 0, 1e-4);
}

TEST(AtlasScores, CountTrianglesLaidFaceDownAndFeelStretch) {
  TexturedMesh model = unfolded_cube();
  for (Vec2& uv : model.uvs) uv.x() = 1 - uv.x();
  EXPECT_EQ(atlas_scores(model).flipped, 12);
  model = unfolded_cube();
  for (Vec2& uv : model.uvs) uv.y() /= 3;  // singular values 1 and 1/3, at one scale sqrt(3) and 1/sqrt(3)
  EXPECT_NEAR(atlas_scores(model).distortion, 2 * (3 + 1.0 / 3), 1e-9);
}

TEST(AtlasScores, CountOverlapsAndWhatLeavesTheTexture) {
  TexturedMesh model = unfolded_cube();
  EXPECT_EQ(atlas_scores(model).overlap, 0);
  EXPECT_EQ(atlas_scores(model).outside, 0);
  const Triangle first = model.uv_triangles[0], second = model.uv_triangles[1];
  for (int k = 0; k < 3; ++k) model.uvs[second[k]] = model.uvs[first[k]];
  EXPECT_NEAR(static_cast<double>(atlas_scores(model).overlap), 64.0 * 64 / 288, 9);  // half its border
  for (int k = 0; k < 3; ++k) model.uvs[second[k]].x() -= 0.5;
  EXPECT_EQ(atlas_scores(model).overlap, 0);
  EXPECT_EQ(atlas_scores(model).outside, 3);
}

TEST(AtlasScores, SeamContrastIsTheDistanceOfTheTwoSides) {
  TexturedMesh model = unfolded_cube();
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 64; ++x) model.texture(x, y) = {10, 200, 90, 255};
  const AtlasScores scores = atlas_scores(model);
  EXPECT_GT(scores.seam_contrast, 10);
  EXPECT_LT(scores.seam_contrast, 60);
}

Scene ball_scene(const Painter& painter) { return scene(ball(), painter, {.pixels = 160}, 48); }

TEST(RoundTrip, OfTheDrawingsThemselvesIsNearlyPerfectWhereTheyAgree) {
  // One pattern in space: all three drawings show the same colour at a point of the box's edges too.
  const Scene scene = carve::scene(
      box(),
      [](View view, int x, int y) {
        return Rgba{static_cast<std::uint8_t>(120 + x % 16 * 4), static_cast<std::uint8_t>(100 + y % 16 * 4),
                    static_cast<std::uint8_t>(60 * static_cast<int>(view)), 255};
      },
      {.pixels = 160}, 48);
  for (const int size : {512, 1024}) {
    const RoundTrip trip = round_trip(textured(scene, {}, {.size = size}), scene.views);
    EXPECT_GE(*trip.psnr, 30) << size;
    EXPECT_GE(*trip.psnr_all, 30) << size;
    EXPECT_GE(*trip.ssim, 0.95) << size;
  }
}

TEST(RoundTrip, BlendingGhostsAndChoosingDoesNot) {
  const Scene scene = ball_scene(plain);
  TextureOptions blend;
  blend.arm = TextureArm::blend;
  const RoundTrip mixed = round_trip(textured(scene, blend), scene.views);
  const RoundTrip chosen = round_trip(textured(scene), scene.views);
  EXPECT_GT(*mixed.ghosting, 0.5);
  EXPECT_LT(*chosen.ghosting, 0.01);
}

TEST(RoundTrip, AWrongTextureIsSeen) {
  const Scene scene = ball_scene(plain);
  TexturedMesh model = textured(scene);
  std::ranges::fill(model.texture.pixels, Rgba{0, 0, 0, 255});
  const RoundTrip trip = round_trip(model, scene.views);
  EXPECT_LT(*trip.psnr, 8);
  EXPECT_EQ(*trip.ghosting, 1);
  EXPECT_THROW(round_trip({scene.mesh, {}, {}, {}}, scene.views), std::invalid_argument);
}

TEST(Differences, AreYellowWhereTheTextureIsWrongAndDarkElsewhere) {
  const Scene scene = ball_scene([](View, int, int) { return Rgba{200, 150, 100, 255}; });
  TexturedMesh model = textured(scene);
  const Rgba none = colour(Ramp::sequential, 0, 128), all = colour(Ramp::sequential, 128, 128);
  const auto count = [&](Rgba c) { return std::ranges::count(differences(model, scene.views).pixels, c); };
  EXPECT_GT(count(none), 10000);
  EXPECT_EQ(count(all), 0);
  std::ranges::fill(model.texture.pixels, Rgba{0, 0, 0, 255});
  EXPECT_EQ(count(none), 0);
  EXPECT_GT(count(all), 10000);
}

TEST(Render, ShowsTheTextureAsItIs) {
  const Scene scene = carve::scene(box(), plain);
  const TexturedMesh model = textured(scene);
  const Picture picture = render(model, camera(View::top), {32, 32, -0.2, 0.4 / 32, 0.2, -0.4 / 32});
  EXPECT_EQ(std::ranges::count(picture.pixels, plain(View::top, 0, 0)), 32 * 32);
  EXPECT_EQ(texture_sheet(model, 50).width, 250);
}

}  // namespace
}  // namespace carve
