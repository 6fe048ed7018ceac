#include "carve/carving/patch_labels.h"

#include <gtest/gtest.h>

#include <random>

#include "carve/grid/shadow.h"
#include "carve/image/outline.h"
#include "shapes.h"

namespace carve {
namespace {

struct Placed {
  AlignedView view;
  VoxelGrid grid;
};

/// A drawing of random labels and coverages, placed anywhere on a grid of any resolution.
Placed random_placed(unsigned seed) {
  std::mt19937 generator(seed);
  const auto below = [&](int n) { return static_cast<int>(generator() % static_cast<unsigned>(n)); };
  AlignedView view;
  view.view = kViews[below(6)];
  const int width = 1 + below(40), height = 1 + below(40);
  view.drawing.labels = Raster<Label>(width, height);
  view.drawing.coverage = Mask(width, height);
  for (int i = 0; i < width * height; ++i) {
    const int coverage = below(4) == 0 ? below(256) : below(2) * 255;
    view.drawing.coverage.pixels[i] = static_cast<std::uint8_t>(coverage);
    if (coverage >= 128) view.drawing.labels.pixels[i] = below(3) ? Label::surface : Label::edge;
  }
  const auto sign = [](SignedAxis axis) { return axis.sign; };
  view.column_per_unit = (10 + below(5000) / 97.0) * sign(frame(view.view).right);
  view.row_per_unit = -(10 + below(5000) / 89.0) * sign(frame(view.view).up);
  view.column0 = below(100) / 7.0;
  view.row0 = below(100) / 7.0;
  const Vec3i size(1 + below(50), 1 + below(50), 1 + below(50));
  return {view, VoxelGrid(size, Vec3(-0.4, -0.3, -0.5), 0.01 + below(1000) / 9973.0)};
}

TEST(PatchLabels, AreThoseOfThePixelsWhoseCentresLieInThePatch) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const auto [view, grid] = random_placed(seed);
    const Drawing& drawing = view.drawing;
    const ShadowLayout layout(grid.size(), view.view);
    const auto [right, up, toward] = layout.frame;
    const Outline outline(drawing.coverage);
    const PatchLabels centre = patch_labels(view, grid), any = patch_labels(view, grid, Patch::any);
    ASSERT_EQ(centre.labels.width, layout.width);
    ASSERT_EQ(centre.labels.height, layout.height);
    for (int j = 0; j < layout.height; ++j)
      for (int i = 0; i < layout.width; ++i) {
        Vec3i voxel = Vec3i::Zero();
        voxel[right.axis] = layout.right_index(i);
        voxel[up.axis] = layout.up_index(j);
        const Vec3 middle = grid.centre(voxel.x(), voxel.y(), voxel.z());
        const double column = view.column(middle[right.axis]), row = view.row(middle[up.axis]);
        const double half_width = std::abs(view.column_per_unit) * grid.spacing() / 2;
        const double half_height = std::abs(view.row_per_unit) * grid.spacing() / 2;

        const bool inside = outline.contains(column, row);
        ASSERT_EQ(centre.inside(i, j), inside) << seed;
        // Along each side: the pixels whose centres lie in the patch, or else the one it lies in.
        const auto in_patch = [](int pixel, double at, double half) {
          const double a = std::floor(at - half + 0.5), b = std::floor(at + half - 0.5);  // first and last centre
          return a <= b ? pixel >= a && pixel <= b : pixel == std::floor(at);
        };
        int labels = 0;
        for (int y = -60; y < 100; ++y)
          for (int x = -60; x < 100; ++x)
            if (drawing.labels.contains(x, y) && in_patch(x, column, half_width) && in_patch(y, row, half_height))
              labels |= 1 << static_cast<int>(drawing.labels(x, y));
        const bool object = labels & (kSurface | kEdge);
        if (labels == 0) labels = kBackground;
        if (inside && !object) labels |= kSurface;
        ASSERT_EQ(centre.labels(i, j) & ~kBackground, labels & ~kBackground) << seed;
        ASSERT_EQ(any.inside(i, j), object || inside) << seed;
      }
  }
}

TEST(PatchLabels, AnyKeepsALineThatCentresMiss) {
  Mask mask(64, 64);
  for (int i = 0; i < 64; ++i) mask(i, 0) = mask(i, 63) = mask(13, i) = 1;  // 13 is no voxel's centre at 8 pixels each
  const ViewSet views = views_of_masks({{View::front, mask}, {View::side, mask}});
  const VoxelGrid grid({8, 8, 8}, views.low(), 1.0 / 8);
  const AlignedView& front = *views.find(View::front);
  EXPECT_EQ(patch_labels(front, grid, Patch::centre).inside(1, 4), 0);
  EXPECT_EQ(patch_labels(front, grid, Patch::any).inside(1, 4), 1);
  EXPECT_EQ(patch_labels(front, grid, Patch::any).inside(2, 4), 0);
}

TEST(PatchLabels, CentresAreUnbiasedAndAnyInflatesByHalfAVoxelAtMost) {
  const ViewSet views = aligned(ball(), kThreeViews, {.pixels = 300});
  for (int n : {20, 50, 150}) {
    const VoxelGrid grid = grid_over(views.low(), views.high(), n);
    const auto area = [&](Patch patch) {
      const PatchLabels labels = patch_labels(views.views[0], grid, patch);
      return std::ranges::count(labels.inside.pixels, 1) * grid.spacing() * grid.spacing();
    };
    const double exact = 3.14159265 / 4, h = grid.spacing();
    EXPECT_NEAR(area(Patch::centre), exact, 0.1 * 3.14 * h);
    EXPECT_GT(area(Patch::any), area(Patch::centre));
    EXPECT_LT(area(Patch::any), exact + 3.15 * 0.71 * h);  // half the diagonal of a voxel all around
  }
}

}  // namespace
}  // namespace carve
