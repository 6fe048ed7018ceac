#include "carve/photo/photo_files.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <fstream>
#include <sstream>

#include "carve/core/file.h"
#include "carve/image/read_image.h"
#include "photo/ball_photos.h"

namespace carve {
namespace {
namespace fs = std::filesystem;

class PhotoFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              ("photo_files_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    photos_ = BallScene{.colour = striped}.photos({.views = 4, .size = 48});
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
  std::vector<Photo> photos_;
};

// Pixel (i, j) of PMVS2 has its centre at (i, j), half a pixel before ours; of photos halved `level` times, too.
TEST_F(PhotoFiles, PmvsMatrixProjectsToHundredthsOfAPixel) {
  for (const int level : {0, 1, 2}) {
    write_pmvs(folder_, photos_, true, {.level = level});
    for (int k = 0; k < 4; ++k) {
      std::ifstream in(folder_ / "txt" / ("0000000" + std::to_string(k) + ".txt"));
      std::string word;
      Eigen::Matrix<double, 3, 4> matrix;
      in >> word;
      EXPECT_EQ(word, "CONTOUR");
      for (int i = 0; i < 12; ++i) in >> matrix(i / 4, i % 4);
      ASSERT_TRUE(in);
      const Vec3 x(0.2, 0.7, -0.1);
      const Vec2 there = (matrix * x.homogeneous()).hnormalized() / (1 << level);
      const Vec2 ours = project(photos_[k].camera, x) / (1 << level);
      EXPECT_LT((there + Vec2(0.5, 0.5) - ours).norm(), 0.01);
    }
  }
}

TEST_F(PhotoFiles, PmvsPicturesAreNearlyThePhotosAndMasksAreTheMasks) {
  write_pmvs(folder_, photos_);
  const Picture read = read_image(folder_ / "visualize" / "00000002.jpg");
  ASSERT_EQ(read.width, 48);
  double error = 0;
  for (std::size_t i = 0; i < read.pixels.size(); ++i)
    error += std::abs(read.pixels[i].g - photos_[2].picture.pixels[i].g);
  EXPECT_LT(error / static_cast<double>(read.pixels.size()), 3);
  const std::string pgm = read_file(folder_ / "masks" / "00000002.pgm");
  ASSERT_TRUE(pgm.starts_with("P5\n48 48\n255\n"));
  const std::string bytes = pgm.substr(pgm.size() - 48 * 48);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    ASSERT_EQ(static_cast<unsigned char>(bytes[i]), photos_[2].mask.pixels[i] ? 255 : 0);
  EXPECT_THAT(read_file(folder_ / "option.txt"), ::testing::HasSubstr("timages -1 0 4\n"));
}

TEST_F(PhotoFiles, WithoutMasksNoneAreThere) {
  write_pmvs(folder_, photos_, false);
  EXPECT_FALSE(fs::exists(folder_ / "masks"));
}

// Bundler: P = R X + t, p = -P / P.z, f p from the picture's middle, y up.
TEST_F(PhotoFiles, BundlersCamerasSeePointsWhereTheFileHasThem) {
  const std::vector<SeenPoint> points = {{Vec3(0.2, 0.7, 0.3), {0, 2}}, {Vec3(-0.1, 0.3, 0.4), {2, 1, 3}}};
  write_pmvs(folder_, photos_);
  write_bundle(folder_ / "bundle.rd.out", photos_, points);
  std::ifstream in(folder_ / "bundle.rd.out");
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "# Bundle file v0.3");
  std::size_t cameras = 0, count = 0;
  in >> cameras >> count;
  ASSERT_EQ(cameras, 4u);
  ASSERT_EQ(count, 2u);
  std::vector<double> focal(4), k1(4), k2(4);
  std::vector<Eigen::Matrix3d> rotation(4);
  std::vector<Vec3> translation(4);
  for (int k = 0; k < 4; ++k) {
    in >> focal[k] >> k1[k] >> k2[k];
    for (int i = 0; i < 9; ++i) in >> rotation[k](i / 3, i % 3);
    in >> translation[k].x() >> translation[k].y() >> translation[k].z();
    EXPECT_EQ(k1[k], 0);
    EXPECT_EQ(k2[k], 0);
    EXPECT_NEAR(rotation[k].determinant(), 1, 1e-9);
  }
  for (const SeenPoint& point : points) {
    Vec3 x, colour;
    std::size_t views = 0;
    in >> x.x() >> x.y() >> x.z() >> colour.x() >> colour.y() >> colour.z() >> views;
    EXPECT_EQ(x, point.position);
    ASSERT_EQ(views, point.photos.size());
    for (const int photo : point.photos) {
      int i = -1, key = -1;
      Vec2 at;
      in >> i >> key >> at.x() >> at.y();
      ASSERT_EQ(i, photo);
      const Vec3 p = rotation[i] * x + translation[i];
      EXPECT_LT(p.z(), 0);
      EXPECT_LT((focal[i] * Vec2(p.x(), p.y()) / -p.z() - at).norm(), 0.01);
      EXPECT_LT((Vec2(24 + at.x(), 24 - at.y()) - project(photos_[i].camera, x)).norm(), 0.01);
    }
  }
  EXPECT_TRUE(in);
  const std::vector<SeenPoint> wrong = {{Vec3::Zero(), {4}}};
  EXPECT_THROW(write_bundle(folder_ / "b", photos_, wrong), std::invalid_argument);
}

TEST_F(PhotoFiles, PmvsOptionsAreWrittenByTheirNames) {
  write_pmvs(folder_, photos_, true,
             {.level = 0, .csize = 3, .threshold = 0.65, .wsize = 9, .min_image_num = 4, .cpu = 2});
  EXPECT_THAT(read_file(folder_ / "option.txt"),
              ::testing::StartsWith("level 0\ncsize 3\nthreshold 0.65\nwsize 9\nminImageNum 4\nCPU 2\n"));
  EXPECT_THROW(write_pmvs(folder_, photos_, true, {.csize = 0}), std::invalid_argument);
}

TEST_F(PhotoFiles, ColmapPosesProjectToHundredthsOfAPixel) {
  write_colmap(folder_, photos_);
  std::ifstream cameras(folder_ / "sparse" / "cameras.txt"), images(folder_ / "sparse" / "images.txt");
  std::string line;
  std::getline(cameras, line), std::getline(images, line);
  for (int k = 0; k < 4; ++k) {
    std::string model, name;
    int id = 0, width = 0, height = 0, camera = 0;
    double fx = 0, fy = 0, cx = 0, cy = 0;
    Eigen::Quaterniond q;
    Vec3 t;
    cameras >> id >> model >> width >> height >> fx >> fy >> cx >> cy;
    EXPECT_EQ(model, "PINHOLE");
    images >> id >> q.w() >> q.x() >> q.y() >> q.z() >> t.x() >> t.y() >> t.z() >> camera >> name;
    ASSERT_TRUE(cameras && images);
    EXPECT_EQ(camera, k + 1);
    EXPECT_EQ(read_image(folder_ / "images" / name), photos_[k].picture);
    const Vec3 x(-0.1, 0.3, 0.4), y = q * x + t;
    EXPECT_LT((Vec2(fx * y.x() / y.z() + cx, fy * y.y() / y.z() + cy) - project(photos_[k].camera, x)).norm(), 0.01);
  }
}

TEST_F(PhotoFiles, NothingToWriteAndPicturesOfAnotherSizeAreRefused) {
  EXPECT_THROW(write_pmvs(folder_, {}), std::invalid_argument);
  photos_[1].mask = Mask(3, 3);
  EXPECT_THROW(write_colmap(folder_, photos_), std::invalid_argument);
}

}  // namespace
}  // namespace carve
