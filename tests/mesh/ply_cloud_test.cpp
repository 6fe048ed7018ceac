#include "carve/mesh/ply_cloud.h"

#include <gmock/gmock.h>

#include <fstream>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/mesh/ply.h"
#include "mesh/solids.h"
#include "temporary_folder.h"

namespace carve {
namespace {
using testing::HasSubstr;

class PlyCloudTest : public testing::TestWithParam<std::size_t> {
 protected:
  std::filesystem::path file(const std::string& bytes) const {
    std::ofstream(folder_ / "bytes.ply", std::ios::binary) << bytes;
    return folder_ / "bytes.ply";
  }
  const TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Pieces, PlyCloudTest, testing::Values(1, 3, 7, 1000));

Mesh points(int count) {
  Mesh cloud;
  for (int i = 0; i < count; ++i) cloud.positions.emplace_back(i + 1 / 3.0, -i, 1e-9 * i);
  return cloud;
}

// Two vertices of three floats, the bytes of each number turned for big endian.
std::string two_points(const std::string& encoding, const std::string& tail = "") {
  std::string bytes =
      "ply\nformat " + encoding +
      " 1.0\nelement vertex 2\nproperty uchar red\nproperty float z\nproperty float x\nproperty float y\n" + tail +
      "end_header\n";
  for (const float v : {1.f, 2.f, 3.f, 4.f, 5.f, 6.f}) {
    if (v == 1 || v == 4) bytes += '\x7f';
    std::string number(reinterpret_cast<const char*>(&v), sizeof v);
    if (encoding == "binary_big_endian") std::reverse(number.begin(), number.end());
    bytes += number;
  }
  return bytes;
}

TEST_P(PlyCloudTest, ThePiecesTogetherAreTheCloud) {
  const Mesh cloud = points(20);
  const VertexProperty quality{"quality", std::vector<float>(20, 0.5f)};
  write_ply(folder_ / "cloud.ply", cloud, std::span(&quality, 1), {.strict = false});
  auto read = PlyCloud::open(folder_ / "cloud.ply");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->size(), 20u);
  std::vector<Vec3> all;
  for (auto piece = read->next(GetParam()); !piece.empty(); piece = read->next(GetParam())) {
    EXPECT_LE(piece.size(), GetParam());
    all.insert(all.end(), piece.begin(), piece.end());
  }
  EXPECT_EQ(all, cloud.positions);
}

TEST_P(PlyCloudTest, EitherEndiannessAndAnyOrderOfProperties) {
  for (const char* encoding : {"binary_little_endian", "binary_big_endian"}) {
    auto read = PlyCloud::open(file(two_points(encoding)));
    ASSERT_TRUE(read) << encoding;
    std::vector<Vec3> all;
    for (auto piece = read->next(GetParam()); !piece.empty(); piece = read->next(GetParam()))
      all.insert(all.end(), piece.begin(), piece.end());
    EXPECT_EQ(all, (std::vector<Vec3>{{2, 3, 1}, {5, 6, 4}})) << encoding;
  }
}

TEST_F(PlyCloudTest, WhatIsNoBinaryCloudIsLeftToReadMesh) {
  write_mesh(folder_ / "mesh.ply", tetrahedron_mesh());
  EXPECT_FALSE(PlyCloud::open(folder_ / "mesh.ply"));
  EXPECT_FALSE(PlyCloud::open(folder_ / "missing.ply"));
  EXPECT_FALSE(PlyCloud::open(folder_.path()));
  EXPECT_FALSE(PlyCloud::open(file("solid")));
  EXPECT_FALSE(PlyCloud::open(file(two_points("ascii"))));
  EXPECT_FALSE(PlyCloud::open(file(two_points("binary_little_endian", "property list uchar int friends\n"))));
  EXPECT_TRUE(PlyCloud::open(
      file(two_points("binary_little_endian", "element face 0\nproperty list uchar int vertex_indices\n"))));
}

TEST_F(PlyCloudTest, AFileThatEndsTooSoonIsRefusedBeforeItIsRead) {
  const std::string whole = two_points("binary_little_endian");
  try {
    PlyCloud::open(file(whole.substr(0, whole.size() - 1)));
    FAIL();
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bytes.ply: element 'vertex': the count must be in [0, 1]"));
  }
}

TEST_F(PlyCloudTest, ACoordinateThatIsNoNumberIsNamedByItsPlaceInTheFile) {
  std::string bytes = two_points("binary_little_endian");
  for (std::size_t i = bytes.size() - 4; i < bytes.size(); ++i) bytes[i] = '\xff';
  auto read = PlyCloud::open(file(bytes));
  EXPECT_EQ(read->next(1).size(), 1u);
  try {
    read->next(1);
    FAIL();
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'vertex' 1: 'y' must be finite, got nan"));
  }
}

}  // namespace
}  // namespace carve
