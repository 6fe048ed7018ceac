#include "photograph/photograph.h"

#include <gmock/gmock.h>

#include <set>

#include "carve/core/parallel.h"
#include "models/primitives.h"
#include "models/procedural.h"
#include "photo/ball_photos.h"

namespace carve {
namespace {

const Model& ball() {
  static const Model model = sphere();
  return model;
}
const RigOptions kRig{.views = 5, .size = 96};

std::vector<Photo> photos_of(PhotoStyle style, const RigOptions& options = kRig) {
  const auto [low, high] = bounds(ball().mesh);
  return photograph(ball(), rig(low, high, options), {.style = style, .samples = 1});
}

// Colours of places that two photos both see, the grey levels' differences' mean.
double difference_between_photos(PhotoStyle style) {
  const std::vector<Photo> photos = photos_of(style, {.views = 10, .top = false, .size = 96});
  const BallScene scene;
  double sum = 0;
  int count = 0;
  for (int j = 0; j < 96; ++j)
    for (int i = 0; i < 96; ++i) {
      const auto place = scene.hit(photos[0].camera, {i + 0.5, j + 0.5});
      if (!place) continue;
      const Vec2 there = project(photos[1].camera, *place);
      const auto seen = scene.hit(photos[1].camera, there);
      const Vec2 nearest = there.array().floor() + 0.5;
      const bool near_rim = !scene.hit(photos[1].camera, Vec2(nearest.array() + 2)) ||
                            !scene.hit(photos[1].camera, Vec2(nearest.array() - 2));
      if (!seen || (*seen - *place).norm() > 1e-6 || near_rim) continue;
      const Rgba a = photos[0].picture(i, j);
      const Rgba b = photos[1].picture(static_cast<int>(there.x()), static_cast<int>(there.y()));
      sum += std::abs(a.g - b.g), ++count;
    }
  EXPECT_GT(count, 300);
  return sum / count;
}

TEST(Photograph, MasksAreTheBallsDiscs) {
  const BallScene scene;
  for (const Photo& photo : photos_of(PhotoStyle::flat)) {
    int wrong = 0, inside = 0;
    for (int j = 0; j < 96; ++j)
      for (int i = 0; i < 96; ++i) {
        inside += photo.mask(i, j);
        wrong += (photo.mask(i, j) != 0) != scene.hit(photo.camera, {i + 0.5, j + 0.5}).has_value();
      }
    EXPECT_GT(inside, 2000);
    EXPECT_LT(wrong, inside / 100);  // the model is a polyhedron
  }
}

// Where a ball off the middle is seen, as the mean place of its light, against rays through sixteenths of pixels.
TEST(Photograph, ShowsABallWhereItsCameraProjectsIt) {
  const BallScene scene;
  const Camera camera = look_at({0.7, 1.1, 3}, {0.25, 0.35, 0}, {0, 1, 0}, 256, 256, 30);
  const Photo photo = photograph(ball(), {&camera, 1}, {.style = PhotoStyle::flat, .samples = 8})[0];
  Vec2 seen = Vec2::Zero(), expected = Vec2::Zero();
  double light = 0, hits = 0;
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 256; ++i) {
      seen += photo.picture(i, j).g * Vec2(i + 0.5, j + 0.5), light += photo.picture(i, j).g;
      for (int s = 0; s < 256; ++s) {
        const Vec2 place(i + (s % 16 + 0.5) / 16, j + (s / 16 + 0.5) / 16);
        if (scene.hit(camera, place)) expected += place, ++hits;
      }
    }
  ASSERT_GT(hits, 256 * 10000);
  EXPECT_LT((seen / light - expected / hits).norm(), 0.01);
}

TEST(Photograph, StylesDifferInWhatTwoPhotosAgreeOn) {
  EXPECT_LT(difference_between_photos(PhotoStyle::flat), 0.01);
  EXPECT_LT(difference_between_photos(PhotoStyle::plain), 4);
  EXPECT_GT(difference_between_photos(PhotoStyle::plain_turning), 8);
}

TEST(Photograph, TextureTellsPlacesApart) {
  const SolidTextureOptions options;
  double near = 0, far = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(0.001 * i, 0.3 + 0.0007 * i, -0.0003 * i);
    const Vec3 colour = noise_colour(p, 1, options);
    EXPECT_GE(colour.minCoeff(), 0);
    EXPECT_LE(colour.maxCoeff(), 1);
    near += (noise_colour(p + Vec3(0.0001, 0, 0), 1, options) - colour).norm() / 500;
    far += (noise_colour(p + Vec3(0.1, 0, 0), 1, options) - colour).norm() / 500;
  }
  EXPECT_LT(near, 0.05);
  EXPECT_GT(far, 0.3);
  EXPECT_NE(noise_colour({0.1, 0.2, 0.3}, 1, {.seed = 1}), noise_colour({0.1, 0.2, 0.3}, 1, {.seed = 2}));
}

TEST(Photograph, SamplesSoftenTheRim) {
  const auto [low, high] = bounds(ball().mesh);
  const auto cameras = rig(low, high, {.views = 1, .top = false, .size = 64});
  const auto levels = [&](int samples) {
    std::set<int> found;
    const auto photos = photograph(ball(), cameras, {.style = PhotoStyle::flat, .samples = samples});
    for (const Rgba& p : photos[0].picture.pixels) found.insert(p.g);
    return found.size();
  };
  EXPECT_EQ(levels(1), 2u);
  EXPECT_GT(levels(4), 8u);
}

TEST(Photograph, ThreadsDoNotChangeAByte) {
  set_thread_count(1);
  const std::vector<Photo> one = photos_of(PhotoStyle::textured);
  set_thread_count(4);
  const std::vector<Photo> four = photos_of(PhotoStyle::textured);
  set_thread_count(0);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].picture, four[i].picture);
    EXPECT_EQ(one[i].mask, four[i].mask);
  }
}

TEST(Photograph, RefusesWhatItCannotRead) {
  const std::vector<Camera> cameras = rig(Vec3::Zero(), Vec3::Ones(), {.views = 1});
  EXPECT_THROW(photograph({}, cameras), std::invalid_argument);
  EXPECT_THROW(photograph(ball(), cameras, {.background = "red"}), std::invalid_argument);
  EXPECT_THROW(photograph(ball(), cameras, {.samples = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace carve
