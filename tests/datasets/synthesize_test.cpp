#include "synthesize/synthesize.h"

#include <gmock/gmock.h>

#include "carve/core/parallel.h"
#include "datasets/drawing_measures.h"
#include "models/primitives.h"
#include "models/procedural.h"

namespace carve {
namespace {

const SynthesizeOptions kSmall{.size = 200, .margin = 5, .stroke = 3, .samples = 2};  // 180 pixels a unit

SynthesizeOptions with(SynthesizeOptions options, const std::function<void(SynthesizeOptions&)>& change) {
  change(options);
  return options;
}

Picture drawn(const Model& model, View view, SynthesizeOptions options, const DegradeOptions& degrade = {}) {
  options.views = {name(view)};
  return synthesize(model, options, degrade).at(view);
}

TEST(Synthesize, ASphereIsADiscWithARim) {
  for (const View view : kViews) {
    const Picture picture = drawn(sphere(), view, kSmall);
    double area = 0;
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const Rgba p = picture(x, y);
        const double r = std::hypot(x + 0.5 - 100, y + 0.5 - 100);
        area += p.a / 255.0;
        if (r < 89) {
          EXPECT_EQ(p.a, 255);
        }
        if (r > 91) {
          EXPECT_EQ(p.a, 0);
        }
        if (r > 88 && r < 89) {
          EXPECT_TRUE(black(p)) << x << ' ' << y;
        }
        if (r < 86) {
          EXPECT_EQ(p, (Rgba{201, 152, 110, 255})) << x << ' ' << y;
        }  // nothing is drawn inside
      }
    EXPECT_NEAR(area / (std::acos(-1.0) * 90 * 90), 1, 2e-3);
  }
}

TEST(Synthesize, ViewsAgreeInScaleAndExtent) {
  for (const char* name : {"couch", "axe", "head"}) {
    SynthesizeOptions options = kSmall;
    options.views = {"front", "side", "top", "back", "left", "bottom"};
    const auto drawings = synthesize(procedural_model(name), options);
    const Box front = covered_box(drawings.at(View::front)), side = covered_box(drawings.at(View::side)),
              top = covered_box(drawings.at(View::top));
    EXPECT_NEAR(front.width(), top.width(), 1);
    EXPECT_NEAR(front.height(), side.height(), 1);
    EXPECT_NEAR(side.width(), top.height(), 1);
    EXPECT_EQ(std::max({front.width(), front.height(), side.width()}), 180);
    const Box back = covered_box(drawings.at(View::back));
    EXPECT_EQ(back.width(), front.width());
    EXPECT_EQ(back.height(), front.height());
  }
}

TEST(Synthesize, AMirroredModelHasAMirroredFront) {
  Model model = axe(), mirror = axe();
  mirror.mesh = mirrored(mirror.mesh, 0);
  const Picture a = drawn(model, View::front, kSmall), b = drawn(mirror, View::front, kSmall);
  int different = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const Rgba p = a(x, y), q = b(199 - x, y);
      different += std::abs(p.r - q.r) > 8 || std::abs(p.a - q.a) > 8;
    }
  EXPECT_LE(different, 4);
}

TEST(Synthesize, TheSideIsSeenFromPlusX) {
  Model model;
  add(model, "body", {200, 100, 100}, box({-0.5, 0, -0.5}, {0.5, 0.5, 0.5}));
  add(model, "left hand", {100, 200, 100}, box({0.45, 0.5, 0.2}, {0.5, 1, 0.5}));  // +x, front
  EXPECT_EQ(drawn(model, View::front, kSmall)(185, 50).g, 200);
  EXPECT_EQ(drawn(model, View::side, kSmall)(40, 50).g, 200);   // image right is -z
  EXPECT_EQ(drawn(model, View::top, kSmall)(185, 160).g, 200);  // image up is -z
  EXPECT_EQ(drawn(model, View::back, kSmall)(14, 50).g, 200);
  EXPECT_EQ(drawn(model, View::left, kSmall)(160, 50).g, 200);
  EXPECT_EQ(drawn(model, View::bottom, kSmall)(150, 40).r, 200);
}

// The couch of models/furniture.cpp: 2 wide, 0.88 high, 0.9 deep; seat at 0.42, arms to 0.60, back 0.25 deep.
TEST(Synthesize, TheCouchHasItsStrokesWhereDepthJumps) {
  const Picture front = drawn(couch(), View::front, kSmall), side = drawn(couch(), View::side, kSmall),
                top = drawn(couch(), View::top, kSmall);
  const auto row = [](double y) { return static_cast<int>(100 + 90 * (0.44 - y)); };
  const auto row_of_top = [](double z) { return static_cast<int>(100 + 90 * z); };
  const auto near = [](const Picture& picture, int x0, int x1, int y, int reach) {
    return count_black(picture, {x0, y - reach, x1, y + reach});
  };
  EXPECT_GE(near(front, 40, 160, row(0.42), 2), 120);        // the seat's front edge
  EXPECT_EQ(near(front, 40, 160, row(0.42) - 10, 6), 0);     // the back
  EXPECT_EQ(near(front, 40, 160, row(0.30), 5), 0);          // cushion over frame: 2 mm are no jump
  EXPECT_GE(near(top, 40, 160, row_of_top(-0.20), 2), 120);  // the back's foot
  EXPECT_EQ(near(top, 40, 160, row_of_top(0.1), 15), 0);
  EXPECT_EQ(near(side, 75, 125, row(0.30), 10), 0);  // from the side the arm hides the seat
}

TEST(Synthesize, StrokesHaveTheirWidth) {
  for (const double width : {2.0, 4.0, 7.0}) {
    const Picture top =
        drawn(stairs(5, false), View::top, with(kSmall, [&](auto& o) { o.stroke = width, o.samples = 4; }));
    double ink = 0;  // across the edge of the second step, in the middle
    for (int y = 100 + 54 - 12; y < 100 + 54 + 12; ++y) ink += 1 - top(100, y).g / 186.0;
    EXPECT_NEAR(ink, width, 0.35);
    double outline = 0;
    for (int x = 0; x < 50; ++x) outline += top(x, 100).a / 255.0 * (1 - top(x, 100).g / 186.0);
    EXPECT_NEAR(outline, width, 0.35);
  }
}

TEST(Synthesize, OnlyJumpsAboveTheThresholdAreDrawn) {
  const Model pockets = box_pockets();  // the shallow pocket faces the side: 5 % of the longest side
  const auto inner = [&](double jump) {
    return count_black(drawn(pockets, View::side, with(kSmall, [&](auto& o) { o.jump = jump; })), {40, 40, 160, 160});
  };
  const double diagonal = std::sqrt(1 + 0.64 + 0.64);
  EXPECT_GT(inner(100 * 0.049 / diagonal), 200);
  EXPECT_EQ(inner(100 * 0.051 / diagonal), 0);
}

TEST(Synthesize, ASteepSlopeIsNoJumpButAStepBeforeItIs) {
  Model model;
  add(model, "cone", {200, 180, 160}, cone({0, 0, -3}, {0, 0, 3}, 0.5, 0.1, 200));  // 86 degrees
  model = placed(std::move(model));
  const SynthesizeOptions options =
      with(kSmall, [](auto& o) { o.samples = 4, o.margin = 0, o.size = 1024, o.jump = 0.5; });
  const Picture smooth = drawn(model, View::front, options);
  const Box box = covered_box(smooth);
  EXPECT_EQ(count_black(smooth, {box.x0 + 8, 505, box.x1 - 8, 519}), 0);
  add(model, "disc", {100, 180, 160}, cylinder({0, 0, 0.2}, {0, 0, 0.25}, 0.06, 200));
  const Picture stepped = drawn(model, View::front, options);
  EXPECT_GT(count_black(stepped, {box.x0 + 8, 505, box.x1 - 8, 519}), 2 * 14 * 2);
}

TEST(Synthesize, CreasesAreDrawnOnRequest) {
  Model model;
  add(model, "roof", {200, 120, 100}, prism(std::vector<Vec2>{{0, -0.5}, {0.3, 0}, {0, 0.5}}, 0, -0.5, 0.5));  // (y, z)
  const auto ridge = [&](std::optional<double> crease) {
    return count_black(drawn(model, View::top, with(kSmall, [&](auto& o) { o.crease = crease; })), {20, 95, 180, 105});
  };
  EXPECT_EQ(ridge({}), 0);
  EXPECT_EQ(ridge(65), 0);  // the ridge turns by 62 degrees
  EXPECT_GE(ridge(58), 160);
}

TEST(Synthesize, TexturesAreDrawnTheRightWayUp) {
  Model model;
  add(model, "wall", {1, 2, 3}, box({-0.5, 0, -0.1}, {0.5, 1, 0.1}));
  Picture texture(2, 2);
  texture(0, 0) = {250, 0, 0}, texture(1, 0) = {0, 250, 0}, texture(0, 1) = {0, 0, 250}, texture(1, 1) = {250, 250, 0};
  model.materials[0].texture = texture;
  for (const Triangle& t : model.mesh.triangles)
    for (const int k : t) model.uv.emplace_back(model.mesh.positions[k].x() + 0.5, model.mesh.positions[k].y());
  const Picture front = drawn(model, View::front, kSmall);
  EXPECT_GT(front(55, 55).r, 240);
  EXPECT_GT(front(145, 55).g, 240);
  EXPECT_GT(front(55, 145).b, 240);
  EXPECT_GT(front(145, 145).r, 240);
  EXPECT_GT(front(145, 145).g, 240);
}

TEST(Synthesize, BackgroundsFillWhatIsNotCovered) {
  const Picture white = drawn(sphere(), View::front, with(kSmall, [](auto& o) { o.background = "white"; }));
  const Picture blue = drawn(sphere(), View::front, with(kSmall, [](auto& o) { o.background = "#2040f0"; }));
  EXPECT_EQ(white(0, 0), (Rgba{255, 255, 255, 255}));
  EXPECT_EQ(blue(0, 0), (Rgba{0x20, 0x40, 0xf0, 255}));
  EXPECT_EQ(white(100, 100), blue(100, 100));
}

TEST(Synthesize, NearBlackSurfacesAreLiftedFromTheStrokes) {
  Model model;
  add(model, "coal", {10, 20, 5}, box({-0.5, 0, -0.5}, {0.5, 1, 0.5}));
  EXPECT_EQ(drawn(model, View::front, kSmall)(100, 100), (Rgba{70, 80, 65, 255}));
  EXPECT_EQ(drawn(model, View::front, with(kSmall, [](auto& o) { o.darkest = 0; }))(100, 100), (Rgba{10, 20, 5, 255}));
}

TEST(Synthesize, BytesDoNotDependOnTheThreads) {
  const DegradeOptions degrade{.jitter = 2, .broken = 0.2, .noise = 5};
  set_thread_count(1);
  const auto one = synthesize(armchair(), kSmall, degrade);
  set_thread_count(4);
  const auto four = synthesize(armchair(), kSmall, degrade);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(Synthesize, BadOptionsAreNamed) {
  const auto error = [](const std::function<void(SynthesizeOptions&)>& change, DegradeOptions degrade = {}) {
    try {
      synthesize(plain_box(), with(kSmall, change), degrade);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error([](auto& o) { o.size = 8; }), "size must be a whole number in [16, 16384], got 8");
  EXPECT_THAT(error([](auto& o) { o.views = {"front", "right"}; }), testing::EndsWith("got right"));
  EXPECT_EQ(error([](auto& o) { o.background = "#12345"; }),
            "background must be transparent, white or #rrggbb, got #12345");
  EXPECT_THAT(error([](auto&) {}, {.shift = 30}), testing::StartsWith("degrade.shift and degrade.rescale must leave"));
  EXPECT_THROW(synthesize(Model{}), std::invalid_argument);
}

class DegradeTest : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Seeds, DegradeTest, testing::Range(1, 5));

TEST_P(DegradeTest, ShiftMovesTheDrawingBySoManyPixels) {
  const DegradeOptions degrade{.seed = GetParam(), .shift = 7};
  for (const View view : kViews) {
    const Box straight = covered_box(drawn(axe(), view, kSmall));
    const Box moved = covered_box(drawn(axe(), view, kSmall, degrade));
    EXPECT_EQ(std::abs(moved.x0 - straight.x0), 7);
    EXPECT_EQ(std::abs(moved.y0 - straight.y0), 7);
    EXPECT_EQ(moved.width(), straight.width());
    EXPECT_EQ(moved.height(), straight.height());
  }
}

TEST_P(DegradeTest, RescaleMakesNeighbouringViewsDisagree) {
  const DegradeOptions degrade{.seed = GetParam(), .rescale = 5};
  const Box front = covered_box(drawn(sphere(), View::front, kSmall, degrade));
  const Box side = covered_box(drawn(sphere(), View::side, kSmall, degrade));
  EXPECT_EQ(std::max(front.width(), side.width()), 190);  // 180 * 1.05 = 189, on 190 half-covered columns
  EXPECT_NEAR(std::min(front.width(), side.width()), 171, 1);
}

TEST_P(DegradeTest, BrokenStrokesLoseTheirShare) {
  const Model model = stairs(8, true);
  const Picture whole = drawn(model, View::front, kSmall);
  for (const double share : {0.1, 0.3, 0.6}) {
    const DegradeOptions degrade{.seed = GetParam(), .broken = share, .gap = 8};
    const Picture broken = drawn(model, View::front, kSmall, degrade);
    EXPECT_NEAR(1 - static_cast<double>(count_black(broken)) / count_black(whole), share, 0.04);
    EXPECT_EQ(covered_box(broken), covered_box(whole));
  }
}

TEST_P(DegradeTest, NoiseHasItsDeviation) {
  const SynthesizeOptions plain = with(kSmall, [](auto& o) { o.stroke = 0; });
  const DegradeOptions degrade{.seed = GetParam(), .noise = 10};
  const Picture noisy = drawn(plain_box(), View::front, plain, degrade);
  double sum = 0, squares = 0, n = 0;
  for (int y = 60; y < 140; ++y)
    for (int x = 20; x < 180; ++x) {
      const double d = noisy(x, y).r - 201.0;
      sum += d, squares += d * d, ++n;
    }
  EXPECT_NEAR(sum / n, 0, 0.5);
  EXPECT_NEAR(std::sqrt(squares / n), 10, 0.5);
}

TEST_P(DegradeTest, JitterMovesStrokesButNotTheSilhouette) {
  const DegradeOptions degrade{.seed = GetParam(), .jitter = 4};
  const Picture straight = drawn(stairs(5, true), View::top, kSmall);
  const Picture wavy = drawn(stairs(5, true), View::top, kSmall, degrade);
  int changed = 0;
  for (std::size_t i = 0; i < wavy.pixels.size(); ++i) {
    EXPECT_EQ(wavy.pixels[i].a, straight.pixels[i].a);
    changed += black(wavy.pixels[i]) != black(straight.pixels[i]);
  }
  EXPECT_GT(changed, count_black(straight) / 4);
}

TEST_P(DegradeTest, TheSeedDecides) {
  const DegradeOptions a{.seed = GetParam(), .jitter = 2, .broken = 0.3, .noise = 8, .jpeg = 60};
  DegradeOptions b = a;
  b.seed += 1;
  const Picture first = drawn(couch(), View::front, kSmall, a);
  EXPECT_EQ(first, drawn(couch(), View::front, kSmall, a));
  EXPECT_NE(first, drawn(couch(), View::front, kSmall, b));
}

TEST(Degrade, AJpegRoundTripIsOpaqueAndWorseAtLowQuality) {
  const SynthesizeOptions white = with(kSmall, [](auto& o) { o.background = "white"; });
  const Picture clean = drawn(couch(), View::front, white);
  const auto error = [&](int quality) {
    const Picture lossy = drawn(couch(), View::front, kSmall, {.jpeg = quality});
    double sum = 0;
    for (std::size_t i = 0; i < lossy.pixels.size(); ++i) {
      EXPECT_EQ(lossy.pixels[i].a, 255);
      sum += std::abs(lossy.pixels[i].r - clean.pixels[i].r);
    }
    return sum;
  };
  const double good = error(95), bad = error(20);
  EXPECT_GT(good, 0);
  EXPECT_GT(bad, 2 * good);
}

}  // namespace
}  // namespace carve
