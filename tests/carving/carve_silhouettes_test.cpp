#include "carve/carving/carve_silhouettes.h"

#include <gmock/gmock.h>

#include <random>

#include "carve/carving/consistency_report.h"
#include "carve/core/error.h"
#include "carve/core/parallel.h"
#include "carve/grid/shadow.h"
#include "shapes.h"

namespace carve {
namespace {

/// Carved at the masks' own resolution.
VoxelGrid hull(const std::map<View, Mask>& masks, const Vec3i& size) {
  return carve_silhouettes(views_of_masks(masks), {.grid = size.maxCoeff()}).grid;
}

/// Grids of different views can differ in their place by rounding.
bool same_voxels(const VoxelGrid& a, const VoxelGrid& b) { return contains(a, b) && contains(b, a); }

/// The hull of random masks that have one; the seeds that have none are passed over.
template <class Check>
void for_random_hulls(int seeds, Check&& check) {
  int found = 0;
  for (unsigned seed = 0; found < seeds; ++seed) {
    const Vec3i size(8 + static_cast<int>(seed % 60), 8 + static_cast<int>(seed % 7), 8 + static_cast<int>(seed % 5));
    const std::map<View, Mask> masks = random_masks(size, seed);
    try {
      check(masks, hull(masks, size), seed);
      ++found;
    } catch (const NoResult&) {
    }
    ASSERT_LT(seed, 20u * seeds);
  }
}

Mask mirrored(Mask mask) {
  for (int y = 0; y < mask.height; ++y) std::reverse(&mask(0, y), &mask(0, y) + mask.width);
  return mask;
}

Mask upside_down(const Mask& mask) {
  Mask result = mask;
  for (int y = 0; y < mask.height; ++y) std::copy_n(&mask(0, y), mask.width, &result(0, mask.height - 1 - y));
  return result;
}

TEST(Carving, AVoxelIsInsideIfEveryMaskShowsIt) {
  for_random_hulls(100, [](const auto& masks, const VoxelGrid& grid, unsigned seed) {
    const Vec3i& n = grid.size();
    for (int z = 0; z < n.z(); ++z)
      for (int y = 0; y < n.y(); ++y)
        for (int x = 0; x < n.x(); ++x) {
          const bool expected = masks.at(View::front)(x, n.y() - 1 - y) &&
                                masks.at(View::side)(n.z() - 1 - z, n.y() - 1 - y) && masks.at(View::top)(x, z);
          ASSERT_EQ(grid(x, y, z), expected) << seed;
        }
  });
}

TEST(Carving, GrowingAMaskNeverRemovesAVoxel) {
  for_random_hulls(50, [](auto masks, const VoxelGrid& before, unsigned seed) {
    std::mt19937 generator(seed);
    for (int i = 0; i < 5; ++i) {
      Mask& mask = masks.at(kThreeViews[generator() % 3]);
      mask.pixels[generator() % mask.pixels.size()] = 1;
    }
    EXPECT_TRUE(contains(hull(masks, before.size()), before)) << seed;
  });
}

TEST(Carving, TheHullsShadowLiesInsideEachMask) {
  for_random_hulls(50, [](const auto& masks, const VoxelGrid& grid, unsigned seed) {
    for (const auto& [view, mask] : masks) {
      const Mask reached = shadow(grid, view);
      for (std::size_t i = 0; i < mask.pixels.size(); ++i) ASSERT_LE(reached.pixels[i], mask.pixels[i]) << seed;
    }
  });
}

TEST(Carving, CarvingItsOwnShadowsChangesNothing) {
  for_random_hulls(50, [](const auto&, const VoxelGrid& grid, unsigned seed) {
    std::map<View, Mask> shadows;
    for (View view : kViews) shadows[view] = shadow(grid, view);
    EXPECT_TRUE(same_voxels(hull(shadows, grid.size()), grid)) << seed;
  });
}

TEST(Carving, MirroredDrawingsGiveTheMirroredSolid) {
  for (int pixels : {37, 64, 100})  // voxels of whole, half and odd numbers of pixels
    for (int n : {16, 25, 32, 50, 64, 128}) {
      const Vec3i size(pixels, pixels, pixels);
      std::map<View, Mask> masks = random_masks(size, static_cast<unsigned>(pixels + n));
      for (auto& [view, mask] : masks) mask(pixels / 2, pixels / 2) = mask(pixels / 2 - 1, pixels / 2) = 1;
      for (Patch patch : {Patch::centre, Patch::any}) {
        const VoxelGrid plain = carve_silhouettes(views_of_masks(masks), {.grid = n, .patch = patch}).grid;
        const std::map<View, Mask> turned{{View::front, mirrored(masks[View::front])},
                                          {View::side, masks[View::side]},
                                          {View::top, mirrored(masks[View::top])}};
        const VoxelGrid result = carve_silhouettes(views_of_masks(turned), {.grid = n, .patch = patch}).grid;
        for (int z = 0; z < n; ++z)
          for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) ASSERT_EQ(result(x, y, z), plain(n - 1 - x, y, z)) << pixels << " " << n;
      }
    }
}

TEST(Carving, SwappingFrontAndSideMirrorsTheSolid) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    constexpr int n = 12;
    std::map<View, Mask> masks = random_masks({n, n, n}, seed);
    for (auto& [view, mask] : masks) std::ranges::fill_n(mask.pixels.begin(), n * n / 2, 1);
    std::map<View, Mask> swapped{{View::front, masks[View::side]}, {View::side, masks[View::front]}};
    Mask& top = swapped[View::top] = Mask(n, n);  // x' = -z, z' = -x
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) top(i, j) = masks[View::top](n - 1 - j, n - 1 - i);
    const VoxelGrid plain = hull(masks, {n, n, n}), result = hull(swapped, {n, n, n});
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) ASSERT_EQ(result(n - 1 - z, y, n - 1 - x), plain(x, y, z)) << seed;
  }
}

TEST(Carving, TwoThreeAndSixViewsAreConsistent) {
  for_random_hulls(50, [](auto masks, const VoxelGrid& three, unsigned seed) {
    const VoxelGrid two = hull({{View::front, masks[View::front]}, {View::side, masks[View::side]}}, three.size());
    EXPECT_TRUE(contains(two, three)) << seed;
    masks[View::back] = mirrored(masks[View::front]);
    masks[View::left] = mirrored(masks[View::side]);
    masks[View::bottom] = upside_down(masks[View::top]);
    EXPECT_TRUE(same_voxels(hull(masks, three.size()), three)) << seed;
    masks.erase(View::front), masks.erase(View::side), masks.erase(View::top);
    EXPECT_TRUE(same_voxels(hull(masks, three.size()), three)) << seed;
  });
}

TEST(Carving, AFlippedSideCarvesLikeTheUnflippedOne) {
  const std::map<View, Drawing> drawings = draw(stairs());
  std::map<View, Drawing> flipped = drawings;
  flipped[View::side] = mirrored(flipped[View::side]);
  std::map<View, Drawing> from_left = drawings;
  from_left[View::side] = draw(stairs(), View::left);
  const VoxelGrid plain = carve_silhouettes(align(drawings), {.grid = 48}).grid;
  EXPECT_EQ(carve_silhouettes(align(flipped, {.flip = {"side"}}), {.grid = 48}).grid, plain);
  EXPECT_EQ(carve_silhouettes(align(from_left, {.side_from_left = true}), {.grid = 48}).grid, plain);
  EXPECT_NE(carve_silhouettes(align(flipped), {.grid = 48}).grid, plain);
}

TEST(Carving, ThreadsDoNotChangeTheResult) {
  const ViewSet views = aligned(torus(), kThreeViews, {.pixels = 150});
  set_thread_count(1);
  const Carving one = carve_silhouettes(views, {.grid = 200});
  set_thread_count(2);
  const Carving two = carve_silhouettes(views, {.grid = 200});
  set_thread_count(0);
  EXPECT_EQ(one.grid, two.grid);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(one.views[i].labels, two.views[i].labels);
    EXPECT_EQ(one.views[i].inside, two.views[i].inside);
  }
}

TEST(Carving, HullVolumesConverge) {
  for (const Shape& shape : all_shapes())
    for (int grid : {16, 50, 128}) {
      const VoxelGrid result = carve_silhouettes(aligned(shape, kThreeViews, {.pixels = 256}), {.grid = grid}).grid;
      const Vec3& s = shape.size;  // one layer of voxels on the box's surface
      const double layer = 2 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x()) * result.spacing();
      EXPECT_NEAR(result.volume(), shape.hull_volume, layer) << shape.name << " " << grid;
    }
}

TEST(Carving, OnePixel) {
  Mask mask(5, 5);
  mask(2, 3) = 1;
  const Drawing drawing = drawing_of(mask);  // aligned, the pixel is the whole object
  const Carving carving = carve_silhouettes(align({{View::front, drawing}, {View::side, drawing}}), {.grid = 9});
  EXPECT_EQ(carving.grid.count(), 9 * 9 * 9);

  const auto one = [](int x, int y) {
    Mask pixel(8, 8);
    pixel(x, y) = 1;
    return pixel;
  };
  const VoxelGrid grid = hull({{View::front, one(3, 5)}, {View::side, one(1, 5)}, {View::top, one(3, 6)}}, {8, 8, 8});
  EXPECT_EQ(grid.count(), 1);
  EXPECT_TRUE(grid(3, 2, 6));
}

TEST(Carving, EmptyMask) {
  const Vec3i size(8, 8, 8);
  std::map<View, Mask> masks{{View::front, Mask(8, 8, 1)}, {View::side, Mask(8, 8)}, {View::top, Mask(8, 8, 1)}};
  EXPECT_THROW(hull(masks, size), NoResult);
  masks[View::side](0, 0) = 1;
  EXPECT_EQ(hull(masks, size).count(), 8);
}

TEST(Carving, FullMask) {
  const Vec3i size(65, 9, 8);
  std::map<View, Mask> masks;
  for (View view : kViews) masks[view] = Mask(size[frame(view).right.axis], size[frame(view).up.axis], 1);
  EXPECT_EQ(hull(masks, size).count(), size.prod());
}

TEST(Carving, TwoComponents) {
  Mask mask(9, 9);
  for (int i : {0, 1, 7, 8})
    for (int j : {0, 1, 7, 8}) mask(i, j) = (i < 4) == (j < 4);
  EXPECT_EQ(hull({{View::front, mask}, {View::top, mask}}, {9, 9, 9}).count(), 16);
}

TEST(Carving, OptionsOutOfRangeAreRefused) {
  const ViewSet views = aligned(box(), kThreeViews, {.pixels = 16});
  const auto error = [&](int grid) {
    try {
      carve_silhouettes(views, {.grid = grid});
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error(7), "grid must be a whole number in [8, 2048], got 7");
  EXPECT_EQ(error(2049), "grid must be a whole number in [8, 2048], got 2049");
  EXPECT_EQ(error(8), "no error");
}

TEST(Agreement, AHullNeverExceedsTheDrawings) {
  for_random_hulls(50, [](const auto& masks, const VoxelGrid& grid, unsigned seed) {
    const ViewSet views = views_of_masks(masks);
    const std::vector<ViewAgreement> result = agreement(grid, views);
    ASSERT_EQ(result.size(), 3u);
    for (const ViewAgreement& a : result) {
      const Mask &drawn = masks.at(a.view), reached = shadow(grid, a.view);
      const auto lit = std::ranges::count(drawn.pixels, 1), hit = std::ranges::count(reached.pixels, 1);
      EXPECT_EQ(a.extra, 0) << seed;
      EXPECT_EQ(a.uncovered, lit - hit) << seed;
      EXPECT_DOUBLE_EQ(a.silhouette_iou, static_cast<double>(hit) / static_cast<double>(lit)) << seed;
    }
  });
}

TEST(Agreement, ConsistentDrawingsAreExplainedWhollyAndAFullGridExceedsThem) {
  const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 100});
  const VoxelGrid grid = carve_silhouettes(views, {.grid = 40}).grid;
  for (const ViewAgreement& a : agreement(grid, views)) EXPECT_EQ(a.silhouette_iou, 1) << name(a.view);
  for (const ViewAgreement& a : agreement(VoxelGrid(grid.size(), grid.low(), grid.spacing(), Fill::full), views)) {
    EXPECT_EQ(a.uncovered, 0);
    EXPECT_NEAR(a.silhouette_iou, 0.785, 0.02);
  }
}

}  // namespace
}  // namespace carve
