#include "carve/image/drawing.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "carve/core/error.h"
#include "carve/image/read_image.h"
#include "image/encoders.h"
#include "image/sketch.h"

namespace carve {
namespace {

using ::testing::HasSubstr;

constexpr Rgba kWhite{255, 255, 255, 255}, kBlack{0, 0, 0, 255}, kRed{200, 60, 40, 255}, kTeal{40, 130, 140, 255},
    kCream{255, 250, 220, 255}, kSky{170, 205, 235, 255}, kNothing{0, 0, 0, 0};
constexpr Background kRules[] = {Background::alpha, Background::border, Background::flood};

bool is_object(Label label) { return label != Label::background; }

Mask object_of(const Drawing& drawing) {
  Mask mask(drawing.labels.width, drawing.labels.height);
  std::transform(drawing.labels.pixels.begin(), drawing.labels.pixels.end(), mask.pixels.begin(), is_object);
  return mask;
}

std::size_t count(const Drawing& drawing, Label label) {
  return std::count(drawing.labels.pixels.begin(), drawing.labels.pixels.end(), label);
}

double overlap(const Mask& a, const Mask& b) {
  std::size_t both = 0, either = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    both += a.pixels[i] && b.pixels[i];
    either += a.pixels[i] || b.pixels[i];
  }
  return either == 0 ? 1 : static_cast<double>(both) / static_cast<double>(either);
}

// 8-connected parts of the object.
int parts_of(Mask mask) {
  int parts = 0;
  std::vector<std::pair<int, int>> open;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (!mask(x, y)) continue;
      ++parts;
      open.emplace_back(x, y);
      while (!open.empty()) {
        const auto [u, v] = open.back();
        open.pop_back();
        if (!mask.contains(u, v) || !mask(u, v)) continue;
        mask(u, v) = 0;
        for (int i = 0; i < 9; ++i) open.emplace_back(u - 1 + i % 3, v - 1 + i / 3);
      }
    }
  return parts;
}

// What must hold of every drawing.
void expect_consistent(const Drawing& drawing) {
  Box bounds{drawing.labels.width, drawing.labels.height, 0, 0};
  std::size_t contradictions = 0;
  for (int y = 0; y < drawing.labels.height; ++y)
    for (int x = 0; x < drawing.labels.width; ++x) {
      const bool object = is_object(drawing.labels(x, y));
      contradictions += object != (drawing.coverage(x, y) >= 128);
      if (!object) continue;
      bounds = {std::min(bounds.x0, x), std::min(bounds.y0, y), std::max(bounds.x1, x + 1), std::max(bounds.y1, y + 1)};
    }
  EXPECT_EQ(contradictions, 0u);
  EXPECT_EQ(drawing.bounds, bounds);
}

// A coloured object with an outline, a part in front, an inner stroke and perhaps a hole.
Sketch random_object(unsigned seed, double size) {
  std::mt19937 random(seed);
  const Rgba colours[] = {kRed, kTeal, kCream, kSky, {120, 120, 120, 255}, {90, 60, 30, 255}};
  const auto colour = [&] { return colours[random() % 6]; };
  const Vec2 middle(size / 2, size / 2);
  const Shape body =
      seed % 2 ? blob(middle, 0.45 * size, colour(), seed) : star(middle, 0.45 * size, 14, colour(), seed);
  const double stroke = size / 64;
  Sketch sketch{body, outline(body, stroke),
                line({0.35 * size, 0.45 * size}, {0.6 * size, 0.55 * size}, stroke, kBlack)};
  const Shape part = blob({0.55 * size, 0.45 * size}, 0.12 * size, colour(), seed + 1);
  sketch.push_back(part);
  sketch.push_back(outline(part, stroke));
  if (seed % 3 == 0) {
    const Shape hole = disc({0.4 * size, 0.6 * size}, 0.08 * size, kNothing);
    sketch.push_back(hole);
    sketch.push_back(outline(hole, stroke));
  }
  return sketch;
}

class DrawingTest : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, DrawingTest, ::testing::Range(0u, 24u));

TEST_P(DrawingTest, LabelsCoverageAndBoundsAgree) {
  const Picture picture = drawn(random_object(GetParam(), 160), 160, 160);
  for (const Background rule : {Background::automatic, Background::alpha, Background::border, Background::flood}) {
    expect_consistent(understand_drawing(picture, {.background = rule}));
    if (rule != Background::alpha) expect_consistent(understand_drawing(on_paper(picture, kSky), {.background = rule}));
  }
}

TEST_P(DrawingTest, HardBordersAreTheSameByAlphaAndByPaper) {
  const Picture picture = drawn(random_object(GetParam(), 160), 160, 160, 1);
  const Drawing by_alpha = understand_drawing(picture);
  EXPECT_EQ(by_alpha.background, Background::alpha);
  for (const Rgba paper : {kWhite, Rgba{60, 200, 90, 255}}) {
    const Drawing by_paper = understand_drawing(on_paper(picture, paper));
    EXPECT_EQ(by_paper.background, Background::border);
    EXPECT_EQ(by_paper.border, paper);
    EXPECT_TRUE(by_paper.labels == by_alpha.labels);
    EXPECT_TRUE(by_paper.coverage == by_alpha.coverage);
  }
}

TEST_P(DrawingTest, WithoutHolesFloodAndBorderAreTheSame) {
  Sketch sketch = random_object(GetParam(), 160);
  if (GetParam() % 3 == 0) sketch.resize(sketch.size() - 2);
  const Picture picture = on_paper(drawn(sketch, 160, 160), kWhite);
  EXPECT_TRUE(understand_drawing(picture, {.background = Background::flood}).labels ==
              understand_drawing(picture, {.background = Background::border}).labels);
}

TEST_P(DrawingTest, CoverageFromColoursIsNearTheTrueOne) {
  const Picture picture = drawn(random_object(GetParam(), 160), 160, 160, 8);
  for (const Rgba paper : {kWhite, Rgba{60, 200, 90, 255}}) {
    const Drawing drawing = understand_drawing(on_paper(picture, paper));
    double sum = 0;
    int borders = 0;
    for (int y = 0; y < 160; ++y)
      for (int x = 0; x < 160; ++x) {
        const int alpha = picture(x, y).a;
        if (alpha == 0 || alpha == 255) continue;
        ++borders;
        sum += std::abs(alpha - drawing.coverage(x, y));
      }
    EXPECT_LT(sum / borders, 12) << "of 255, over " << borders << " pixels";
  }
}

TEST_P(DrawingTest, TurningThePictureTurnsTheLabels) {
  const Picture picture = drawn(random_object(GetParam(), 160), 160, 150);
  for (const Picture& p : {picture, on_paper(picture, kWhite),
                           decode_image(jpeg_file(samples_of(on_paper(picture, kWhite), 3), {.quality = 60}), "a")}) {
    const Drawing straight = understand_drawing(p), turned = understand_drawing(rotated(p));
    EXPECT_TRUE(turned.labels == rotated(straight.labels));
    EXPECT_TRUE(turned.coverage == rotated(straight.coverage));
  }
}

TEST_P(DrawingTest, EnlargingAHardPictureEnlargesTheSilhouette) {
  const Picture picture = drawn(random_object(GetParam(), 160), 160, 160, 1);
  for (const Picture& p : {picture, on_paper(picture, kWhite)})
    EXPECT_TRUE(object_of(understand_drawing(enlarged(p, 3))) == enlarged(object_of(understand_drawing(p)), 3));
}

TEST_P(DrawingTest, ALargerDrawingHasTheSameStrokes) {
  const Sketch sketch = random_object(GetParam(), 160);
  const Drawing small = understand_drawing(drawn(sketch, 160, 160));
  const Drawing large = understand_drawing(drawn(scaled(sketch, 4), 640, 640));
  const double share =
      static_cast<double>(count(large, Label::edge)) / 16 / static_cast<double>(count(small, Label::edge));
  EXPECT_NEAR(share, 1, 0.12);
}

TEST_P(DrawingTest, StrokesAreWhereTheyWereDrawn) {
  const Sketch sketch = random_object(GetParam(), 256);
  const Drawing drawing = understand_drawing(on_paper(drawn(sketch, 256, 256), kWhite));
  Sketch strokes = sketch;
  for (Shape& shape : strokes)
    if (shape.colour != kBlack && shape.colour != kNothing) shape.colour = kRed;
  const Picture truth = drawn(strokes, 256, 256);
  std::size_t wrong = 0, right = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const bool ink = truth(x, y).a >= 128 && truth(x, y).r < 80, fill = truth(x, y).a >= 128 && truth(x, y).r > 120;
      wrong += (ink && drawing.labels(x, y) == Label::surface) || (fill && drawing.labels(x, y) == Label::edge);
      right += ink && drawing.labels(x, y) == Label::edge;
    }
  EXPECT_LT(wrong, right / 25);  // where two strokes meet at a slant they are wider than a stroke
}

TEST_P(DrawingTest, WhiteFilledLineArtIsFilledWithoutBeingTold) {
  Sketch sketch = random_object(GetParam(), 200);
  if (GetParam() % 3 == 0) sketch.resize(sketch.size() - 2);
  const Drawing coloured = understand_drawing(on_paper(drawn(sketch, 200, 200), kWhite));
  for (Shape& shape : sketch)
    if (shape.colour != kBlack) shape.colour = kWhite;
  const Drawing drawing = understand_drawing(on_paper(drawn(sketch, 200, 200), kWhite));
  EXPECT_EQ(drawing.background, Background::flood);
  EXPECT_GT(overlap(object_of(drawing), object_of(coloured)), 0.999);
}

TEST_P(DrawingTest, StrokesOnATransparentSheetEncloseTheObject) {
  Sketch sketch = random_object(GetParam(), 200);
  if (GetParam() % 3 == 0) sketch.resize(sketch.size() - 2);
  const Drawing coloured = understand_drawing(drawn(sketch, 200, 200));
  for (Shape& shape : sketch)
    if (shape.colour != kBlack) shape.colour = kNothing;
  const Drawing drawing = understand_drawing(drawn(sketch, 200, 200));
  EXPECT_EQ(drawing.background, Background::flood);
  EXPECT_EQ(drawing.border.a, 0);
  expect_consistent(drawing);
  EXPECT_TRUE(object_of(drawing) == object_of(coloured));
}

TEST_P(DrawingTest, ColouredRingsKeepTheirHoles) {
  std::mt19937 random(GetParam());
  const double thickness = 12 + random() % 60;
  for (const bool stroked : {false, true}) {
    const Shape outer = disc({128, 128}, 110, kTeal), inner = disc({128, 128}, 110 - thickness, kNothing);
    Sketch sketch{outer, inner};
    if (stroked) sketch.push_back(outline(outer, 3)), sketch.push_back(outline(inner, 3));
    const Drawing drawing = understand_drawing(on_paper(drawn(sketch, 256, 256), kWhite));
    EXPECT_EQ(drawing.background, Background::border);
    EXPECT_EQ(drawing.labels(128, 128), Label::background);
  }
}

class JpegTest : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, JpegTest, ::testing::Range(0u, 8u));

TEST_P(JpegTest, NoiseMakesNoSpecks) {
  const Picture clean = on_paper(drawn(random_object(GetParam(), 256), 256, 256), kWhite);
  const Drawing truth = understand_drawing(clean);
  for (const int quality : {40, 60, 80, 95})
    for (const bool full_colour : {false, true}) {
      const std::string file = jpeg_file(samples_of(clean, 3), {.quality = quality, .full_colour = full_colour});
      const Drawing drawing = understand_drawing(decode_image(file, "a"));
      EXPECT_EQ(parts_of(object_of(drawing)), parts_of(object_of(truth))) << "quality " << quality;
      EXPECT_GT(overlap(object_of(drawing), object_of(truth)), 0.985) << "quality " << quality;
      EXPECT_NEAR(drawing.bounds.x0, truth.bounds.x0, 1);
      EXPECT_NEAR(drawing.bounds.x1, truth.bounds.x1, 1);
      EXPECT_NEAR(drawing.bounds.y0, truth.bounds.y0, 1);
      EXPECT_NEAR(drawing.bounds.y1, truth.bounds.y1, 1);
      EXPECT_EQ(drawing.background, truth.background);
    }
}

// ---- corners by name
// -------------------------------------------------------------------------------------------------

TEST(Drawing, EmptyImage) {
  EXPECT_THROW(understand_drawing(Picture()), std::invalid_argument);
  EXPECT_THROW(understand_drawing(Picture(1, 1, kWhite)), NoResult);
  EXPECT_THROW(understand_drawing(Picture(1, 1, kNothing)), NoResult);
}

TEST(Drawing, FullyBackground) {
  for (const Rgba colour : {kWhite, kRed, kNothing}) try {
      understand_drawing(Picture(40, 30, colour));
      ADD_FAILURE();
    } catch (const NoResult& error) {
      EXPECT_THAT(error.what(), HasSubstr("no object"));
    }
}

TEST(Drawing, FullyForeground) {
  try {
    understand_drawing(Picture(40, 30, kRed), {.background = Background::alpha});
    ADD_FAILURE();
  } catch (const NoResult& error) {
    EXPECT_THAT(error.what(), HasSubstr("no background"));
  }
}

TEST(Drawing, OnePixel) {
  for (const Picture& sheet : {Picture(9, 7, kNothing), Picture(9, 7, kWhite)}) {
    Picture picture = sheet;
    picture(4, 2) = kRed;
    const Drawing drawing = understand_drawing(picture);
    EXPECT_EQ(drawing.bounds, (Box{4, 2, 5, 3}));
    EXPECT_EQ(drawing.labels(4, 2), Label::surface);
  }
}

TEST(Drawing, AllBlackSilhouetteIsSolid) {
  // Thin legs, a hole, and anti-aliasing: all surface, as it has no other colour.
  const Sketch sketch{disc({100, 80}, 60, kBlack), rectangle(60, 100, 64, 190, kBlack),
                      rectangle(140, 100, 144, 190, kBlack), disc({100, 80}, 20, kNothing)};
  for (const Picture& picture : {drawn(sketch, 200, 200), on_paper(drawn(sketch, 200, 200), kWhite)}) {
    const Drawing drawing = understand_drawing(picture);
    EXPECT_EQ(count(drawing, Label::edge), 0u);
    EXPECT_EQ(drawing.labels(100, 80), Label::background);
    EXPECT_EQ(drawing.labels(62, 170), Label::surface);
  }
}

TEST(Drawing, ThinBlackLineOnAlpha) {
  // Alone it is a silhouette; beside a colour it is a stroke; in no case is it lost.
  for (const double width : {1.0, 1.5, 3.0}) {
    Sketch sketch{line({20, 30}, {180, 45}, width, kBlack)};
    EXPECT_EQ(count(understand_drawing(drawn(sketch, 200, 200)), Label::edge), 0u);
    EXPECT_EQ(parts_of(object_of(understand_drawing(on_paper(drawn(sketch, 200, 200), kWhite)))), 1);
    sketch.push_back(disc({100, 120}, 40, kRed));
    for (const Picture& picture : {drawn(sketch, 200, 200), on_paper(drawn(sketch, 200, 200), kWhite)}) {
      const Drawing drawing = understand_drawing(picture);
      EXPECT_GE(count(drawing, Label::edge), 120u * width);
      EXPECT_LE(drawing.bounds.x0, 21);
      EXPECT_GE(drawing.bounds.x1, 179);
    }
  }
}

TEST(Drawing, WhiteFilledLineArt) {
  const Shape box = rectangle(40, 40, 160, 140, kWhite);
  const Picture picture =
      on_paper(drawn({box, outline(box, 3), line({100, 40}, {100, 140}, 3, kBlack)}, 200, 180), kWhite);
  const Drawing drawing = understand_drawing(picture);
  EXPECT_EQ(drawing.background, Background::flood);
  EXPECT_EQ(drawing.labels(70, 90), Label::surface);
  EXPECT_EQ(drawing.labels(100, 90), Label::edge);
  EXPECT_EQ(drawing.labels(20, 90), Label::background);
  EXPECT_EQ(understand_drawing(picture, {.background = Background::border}).labels(70, 90), Label::background);
}

TEST(Drawing, TorusOnWhitePaper) {
  const Picture picture =
      on_paper(drawn({disc({100, 100}, 80, kRed), disc({100, 100}, 65, kNothing)}, 200, 200), kWhite);
  EXPECT_EQ(understand_drawing(picture).labels(100, 100), Label::background);
  EXPECT_EQ(understand_drawing(picture, {.background = Background::flood}).labels(100, 100), Label::surface);
}

TEST(Drawing, BlackTyreWithStrokes) {
  // A solid black wheel and a black bar are surface, the strokes that touch them stay strokes to where they touch.
  const Shape body = rectangle(40, 60, 260, 160, kTeal);
  const Sketch sketch{body,
                      outline(body, 4),
                      disc({100, 160}, 40, kBlack),
                      disc({100, 160}, 15, kSky),
                      rectangle(200, 100, 240, 140, kBlack),
                      line({140, 110}, {200, 110}, 4, kBlack)};
  const Drawing drawing = understand_drawing(drawn(sketch, 300, 220));
  EXPECT_EQ(drawing.labels(100, 190), Label::surface);
  EXPECT_EQ(drawing.labels(220, 120), Label::surface);
  for (const auto& [x, y] : {std::pair{200, 100}, {239, 139}}) EXPECT_EQ(drawing.labels(x, y), Label::surface);
  for (int x = 150; x < 195; ++x) EXPECT_EQ(drawing.labels(x, 110), Label::edge) << x;
  EXPECT_EQ(drawing.labels(180, 60), Label::edge);
  EXPECT_EQ(drawing.labels(170, 130), Label::surface);
}

TEST(Drawing, StrokesOnADarkAreaAreStrokes) {
  const Shape body = rectangle(40, 60, 260, 160, {45, 50, 58, 255});
  const Drawing drawing =
      understand_drawing(drawn({body, outline(body, 4), line({100, 110}, {200, 110}, 4, kBlack)}, 300, 220));
  EXPECT_EQ(drawing.labels(150, 90), Label::surface);
  EXPECT_EQ(drawing.labels(150, 110), Label::edge);
  EXPECT_EQ(drawing.labels(150, 60), Label::edge);
}

TEST(Drawing, WidthDecidesBetweenStrokeAndSurface) {
  for (const int width : {1, 2, 3, 5, 8, 9, 13, 30})
    for (const double limit : {3.0, 8.0, 9.0, 20.0})
      for (const bool upright : {false, true}) {
        Picture picture =
            drawn({rectangle(10, 10, 190, 190, kRed), rectangle(40, 90, 160, 90 + width, kBlack)}, 200, 200, 1);
        if (upright) picture = rotated(picture);
        const Drawing drawing = understand_drawing(picture, {.max_stroke = limit});
        const Label middle = upright ? drawing.labels(199 - 90 - width / 2, 100) : drawing.labels(100, 90 + width / 2);
        const bool thin = width <= limit, wide = width > limit + 1;
        EXPECT_TRUE(middle == Label::edge || !thin) << width << " at " << limit;
        EXPECT_TRUE(middle == Label::surface || !wide) << width << " at " << limit;
      }
}

TEST(Drawing, ObjectTouchesBorder) {
  for (const auto& [x0, y0, x1, y1] : {std::array{0, 40, 90, 110}, {60, 0, 140, 149}, {100, 60, 200, 150}}) {
    const Picture picture = drawn({rectangle(x0, y0, x1, y1, kRed)}, 200, 150, 1);
    for (const Picture& p : {picture, on_paper(picture, kWhite)})
      EXPECT_EQ(understand_drawing(p).bounds, (Box{x0, y0, x1, y1}));
  }
}

TEST(Drawing, AFewTransparentPixelsAreNoAlpha) {
  // Rounded corners of a screenshot.
  Picture picture = on_paper(drawn({disc({100, 100}, 60, kRed)}, 200, 200), kWhite);
  for (int i = 0; i < 4; ++i) picture(i % 2 * 199, i / 2 * 199) = kNothing;
  const Drawing drawing = understand_drawing(picture);
  EXPECT_EQ(drawing.background, Background::border);
  EXPECT_EQ(drawing.bounds, (Box{40, 40, 160, 160}));
}

TEST(Drawing, PalePaperAndPaleObjectAreToldApart) {
  const Rgba paper{250, 250, 248, 255}, pale{238, 240, 250, 255};
  const Drawing drawing = understand_drawing(on_paper(drawn({rectangle(40, 40, 80, 90, pale)}, 120, 120, 1), paper));
  EXPECT_EQ(drawing.bounds, (Box{40, 40, 80, 90}));
  EXPECT_THROW(
      understand_drawing(on_paper(drawn({rectangle(40, 40, 80, 90, pale)}, 120, 120, 1), paper), {.tolerance = 30}),
      NoResult);
}

TEST(Drawing, OptionsOutOfRangeAreRefused) {
  const Picture picture = drawn({disc({20, 20}, 10, kRed)}, 40, 40);
  EXPECT_THROW(understand_drawing(picture, {.tolerance = -1}), std::invalid_argument);
  EXPECT_THROW(understand_drawing(picture, {.ink = 300}), std::invalid_argument);
  EXPECT_THROW(understand_drawing(picture, {.max_stroke = 0.5}), std::invalid_argument);
}

TEST(Drawing, NoiseOfEveryKindIsUnderstoodWithoutACrash) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const int width = 1 + random() % 40, height = 1 + random() % 40;
    Picture picture(width, height);
    const Rgba few[] = {kWhite, kBlack, kRed, kNothing, {250, 250, 250, 255}};
    for (Rgba& p : picture.pixels)
      p = seed % 2
              ? few[random() % 5]
              : Rgba{static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                     static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random() | (seed % 4 ? 255 : 0))};
    for (const Background rule : kRules) try {
        expect_consistent(understand_drawing(picture, {.background = rule}));
      } catch (const NoResult&) {
      }
  }
}

}  // namespace
}  // namespace carve
