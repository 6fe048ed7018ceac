#include "carve/photo/settle_cells.h"

#include <gmock/gmock.h>

#include "photo/ball_photos.h"

namespace carve {
namespace {

const RigOptions kFive{.views = 5, .top = false, .step = 20, .size = 320};  // an arc
const BallScene kBall{.colour = striped};

VoxelGrid region() { return grid_over({-0.6, -0.1, -0.6}, {0.6, 1.1, 0.6}, 48, Fill::full); }

// The voxels that `inside` says, by their centres.
template <class Inside>
VoxelGrid voxels(Inside&& inside) {
  VoxelGrid grid = region();
  for (int z = 0; z < grid.size().z(); ++z)
    for (int y = 0; y < grid.size().y(); ++y)
      for (int x = 0; x < grid.size().x(); ++x) grid.set(x, y, z, inside(grid.centre(x, y, z)));
  return grid;
}

OpenCell cell_of(const VoxelGrid& grid, bool kept) {
  OpenCell cell;
  cell.kept = kept;
  for (int z = 0; z < grid.size().z(); ++z)
    for (int y = 0; y < grid.size().y(); ++y)
      for (int x = 0; x < grid.size().x(); ++x)
        if (grid(x, y, z)) cell.runs.push_back({y, z, x, x + 1, 0}), ++cell.voxels;
  return cell;
}

double distance(const Vec3& p) { return (p - kBall.centre).norm(); }
const VoxelGrid kSolid = voxels([](const Vec3& p) { return distance(p) < kBall.radius; });
// An eighth of the ball's shell.
const VoxelGrid kPart = voxels([](const Vec3& p) {
  return distance(p) < kBall.radius && distance(p) > 0.4 && p.x() > 0 && p.y() > 0.5 && p.z() > 0;
});

// A lump of air before the ball, within all its silhouettes.
const VoxelGrid kAir = voxels([](const Vec3& p) {
  const Vec3 middle(std::sin(40 * M_PI / 180), 0, std::cos(40 * M_PI / 180));
  return distance(p) > kBall.radius + 0.02 && distance(p) < 0.62 && (p - kBall.centre).dot(middle) > 0.95 * distance(p);
});

VoxelGrid with(VoxelGrid a, const VoxelGrid& b, bool inside) {
  for (std::size_t w = 0; w < a.words().size(); ++w)
    a.words()[w] = inside ? a.words()[w] | b.words()[w] : a.words()[w] & ~b.words()[w];
  return a;
}

TEST(SettleCells, WhatIsThereStaysAndWhatIsNotGoes) {
  const std::vector<Photo> photos = kBall.photos(kFive);
  ASSERT_GT(kAir.count(), 100);
  const OpenCell cells[] = {cell_of(kPart, true), cell_of(kAir, true)};
  const SettledCells settled = settle_cells(photos, with(kSolid, kAir, true), cells);
  EXPECT_EQ(settled.grid, kSolid);
  EXPECT_EQ(settled.kept, 1);
  EXPECT_EQ(settled.dropped, 1);
}

TEST(SettleCells, SilhouettesAloneDropWhatStandsOut) {
  const VoxelGrid corner = voxels([](const Vec3& p) { return p.x() > 0.45 && p.y() > 0.9 && p.z() > 0.45; });
  const OpenCell cells[] = {cell_of(corner, true)};
  EXPECT_EQ(settle_cells(BallScene{}.photos(kFive), with(kSolid, corner, true), cells).grid, kSolid);
}

TEST(SettleCells, WithoutTextureWhatFitsTheSilhouettesStays) {
  const std::vector<Photo> photos = BallScene{}.photos(kFive);
  const VoxelGrid solid = with(kSolid, kAir, true);
  const OpenCell cells[] = {cell_of(kAir, true)};
  EXPECT_EQ(settle_cells(photos, solid, cells).grid, solid);
}

TEST(SettleCells, WhatNoPhotoSeesStaysAsItIs) {
  const VoxelGrid core = voxels([](const Vec3& p) { return distance(p) < 0.2; });
  for (const bool kept : {false, true}) {
    const VoxelGrid solid = with(kSolid, core, kept);
    const OpenCell cells[] = {cell_of(core, kept)};
    EXPECT_EQ(settle_cells(kBall.photos(kFive), solid, cells).grid, solid);
  }
}

TEST(SettleCells, NothingOpenChangesNothing) {
  const SettledCells settled = settle_cells(kBall.photos(kFive), region(), {});
  EXPECT_EQ(settled.grid, region());
  EXPECT_EQ(settled.kept + settled.dropped, 0);
}

TEST(SettleCells, RefusesCellsOutsideTheGrid) {
  OpenCell cell;
  cell.runs = {{0, 0, 0, 49, 0}};
  EXPECT_THROW(settle_cells(kBall.photos(kFive), kSolid, std::span(&cell, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace carve
