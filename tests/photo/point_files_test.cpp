#include "carve/photo/point_files.h"

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>

#include "carve/core/error.h"
#include "photo/ball_photos.h"
#include "temporary_folder.h"

namespace carve {
namespace {
using testing::HasSubstr;
using testing::ThrowsMessage;

class PointFiles : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  const TemporaryFolder folder_;
};

const std::string kVertex =
    "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty float nx\n"
    "property float ny\nproperty float nz\nend_header\n";

void expect_two(const OrientedPoints& points) {
  ASSERT_EQ(points.positions.size(), 2u);
  EXPECT_EQ(points.positions[1], Vec3(-1, 0.5, 4));
  EXPECT_EQ(points.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(points.normals[1], Vec3(0, -1, 0));  // made one long
}

TEST_F(PointFiles, TextAndBinaryPlyAndPsetAreTheSame) {
  expect_two(read_oriented_points(
      file("a.ply", "ply\nformat ascii 1.0\n" + kVertex + "1 2 3 255 0 0 1\n-1 0.5 4 9 0 -2 0\n")));
  expect_two(read_oriented_points(file("a.pset", "1 2 3 0 0 1\n-1 0.5 4 0 -2 0\n")));
  std::string body;
  for (const auto& [p, n] : {std::pair(std::array{1.f, 2.f, 3.f}, std::array{0.f, 0.f, 1.f}),
                             std::pair(std::array{-1.f, 0.5f, 4.f}, std::array{0.f, -2.f, 0.f})}) {
    body.append(reinterpret_cast<const char*>(p.data()), 12);
    body.push_back('\7');
    body.append(reinterpret_cast<const char*>(n.data()), 12);
  }
  expect_two(read_oriented_points(file("b.ply", "ply\nformat binary_little_endian 1.0\n" + kVertex + body)));
  body.pop_back();
  EXPECT_THROW(read_oriented_points(file("c.ply", "ply\nformat binary_little_endian 1.0\n" + kVertex + body)), IoError);
}

TEST_F(PointFiles, WhatIsWrongIsNamed) {
  const auto reading = [&](const std::string& name, const std::string& bytes) {
    const auto path = file(name, bytes);
    return [path] { read_oriented_points(path); };
  };
  EXPECT_THROW(read_oriented_points(folder_ / "none.ply"), IoError);
  EXPECT_THAT(reading("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
              ThrowsMessage<IoError>(HasSubstr("no property y")));
  EXPECT_THAT(reading("b.ply", "ply\nformat ascii 1.0\n" + kVertex + "1 2 3 255 0 0 1\n1 2 3 4 5\n"),
              ThrowsMessage<IoError>(HasSubstr("b.ply:")));
  EXPECT_THAT(reading("c.pset", "1 2 3 0 0 1\n1 2 nan 0 0 1\n"), ThrowsMessage<IoError>(HasSubstr("c.pset:2")));
  EXPECT_THAT(reading("d.ply", "ply\nformat ascii 1.0\nelement vertex 1000000000\n" + kVertex.substr(17)),
              ThrowsMessage<IoError>(HasSubstr("as many as the file can hold")));
}

TEST_F(PointFiles, ColmapsPointsFaceThePhotosThatSeeThem) {
  const std::vector<Photo> photos = BallScene{}.photos({.views = 2, .top = false, .step = 90, .size = 32});
  std::string text = "# points\n";  // a square at z = 0 seen by the first photo, one at x = 0 by the second
  for (int i = 0; i < 100; ++i) {
    const std::string a = std::to_string(0.1 * (i % 10)), b = std::to_string(0.1 * (i / 10));
    text += std::to_string(i + 1) + " " + a + " " + b + " 0 1 2 3 0.5 1 7\n";
    text += std::to_string(i + 101) + " 20 " + a + " " + b + " 1 2 3 0.5 2 7\n";
  }
  const OrientedPoints points = read_colmap_points(file("points3D.txt", text), photos);
  ASSERT_EQ(points.positions.size(), 200u);
  for (std::size_t i = 0; i < 200; ++i)
    EXPECT_GT(points.normals[i].dot(points.positions[i].x() < 10 ? Vec3(0, 0, 1) : Vec3(-1, 0, 0)), 0.99);
  const auto path = file("bad.txt", "1 0 0 0 1 2 3 0.5 3 7\n");
  EXPECT_THAT([&] { read_colmap_points(path, photos); }, ThrowsMessage<IoError>(HasSubstr("must be in [1, 2], got 3")));
}

}  // namespace
}  // namespace carve
