#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <Eigen/Geometry>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>

#include "artist/readers.h"
#include "artist/triangulate.h"
#include "carve/core/error.h"
#include "temporary_folder.h"

// libCoin drops 32 bytes of its own; the leak checker, where there is one, asks here what to overlook.
extern "C" const char* __lsan_default_suppressions() { return "leak:libCoin"; }

namespace carve::artist {
namespace {

using ::testing::HasSubstr;

// A file's bytes, little-endian, as the games' tools wrote them.
class Binary {
 public:
  template <class T>
  Binary& put(std::initializer_list<T> values) {
    for (const T value : values) bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  Binary& ints(std::initializer_list<std::int32_t> values) { return put(values); }
  Binary& floats(std::initializer_list<float> values) { return put(values); }
  Binary& name(const std::string& text, std::size_t length) {
    bytes_ += text + std::string(length - text.size(), '\0');
    return *this;
  }
  Binary& add(const Binary& other) {
    bytes_ += other.bytes_;
    return *this;
  }
  std::int32_t size() const { return static_cast<std::int32_t>(bytes_.size()); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// The tetrahedron 0, x, y, z. Counter-clockwise from outside: (0 2 1) (0 1 3) (0 3 2) (1 2 3).
double volume(const Model& model) {
  double sum = 0;
  for (const Face& f : model.faces) {
    const auto p = [&](int k) { return model.positions[f.corners[k].position]; };
    sum += p(0).dot(p(1).cross(p(2))) / 6;
  }
  return sum;
}

std::string md2() {
  Binary frame;
  frame.floats({2, 2, 2}).floats({10, 20, 30}).name("stand", 16);
  frame.put<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  Binary texcoords, triangles;
  texcoords.put<std::int16_t>({0, 0, 64, 0, 0, 32, 64, 32});
  triangles.put<std::uint16_t>({0, 1, 2, 0, 1, 2, 0, 3, 1, 0, 3, 1, 0, 2, 3, 0, 2, 3, 1, 3, 2, 1, 3, 2});
  const std::int32_t texcoord_at = 68, triangle_at = texcoord_at + texcoords.size();
  const std::int32_t frame_at = triangle_at + triangles.size(), end = frame_at + frame.size();
  Binary file;
  file.name("IDP2", 4).ints({8, 64, 32, frame.size(), 0, 4, 4, 4, 0, 1});
  file.ints({texcoord_at, texcoord_at, triangle_at, frame_at, end, end});
  return file.add(texcoords).add(triangles).add(frame).bytes();
}

std::string g3d() {
  Binary file;
  file.name("G3D", 3).put<std::uint8_t>({4}).put<std::uint16_t>({1}).put<std::uint8_t>({0});
  file.name("body", 64)
      .ints({1, 4, 12})
      .floats({0.5, 0.25, 1})
      .floats({0, 0, 0, 1, 1})
      .ints({0, 1})
      .name("skin.png", 64);
  file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});  // vertices
  file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});  // normals
  file.floats({0, 0, 1, 0, 0, 1, 1, 1});
  return file.ints({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}).bytes();
}

// Two frames: in the second everything is one unit further along x.
std::string md3(const std::string& surface_name, const std::string& tag) {
  Binary tags, surface;
  for (const float x : {0.0f, 1.0f}) tags.name(tag, 64).floats({x, 0, 5, 0, 1, 0, -1, 0, 0, 0, 0, 1});
  Binary triangles, texcoords, vertices;
  triangles.ints({0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2});
  texcoords.floats({0, 0, 1, 0, 0, 1, 1, 1});
  for (const std::int16_t x : {0, 64})
    for (const auto& [a, b, c] : {std::array<std::int16_t, 3>{0, 0, 0}, {64, 0, 0}, {0, 64, 0}, {0, 0, 64}})
      vertices.put<std::int16_t>({static_cast<std::int16_t>(a + x), b, c, 0});
  const std::int32_t texcoord_at = 108 + triangles.size(), vertex_at = texcoord_at + texcoords.size();
  surface.name("IDP3", 4).name(surface_name, 64).ints({0, 2, 0, 4, 4, 108, 108, texcoord_at, vertex_at});
  surface.ints({vertex_at + vertices.size()}).add(triangles).add(texcoords).add(vertices);
  Binary file;
  file.name("IDP3", 4).ints({15}).name("part", 64).ints({0, 2, 1, 1, 0, 108, 108, 108 + tags.size()});
  return file.ints({108 + tags.size() + surface.size()}).add(tags).add(surface).bytes();
}

std::string tga(bool runs) {  // 4 x 2, bottom row red, top row blue with alpha 128
  Binary file;
  file.put<std::uint8_t>({0, 0, static_cast<std::uint8_t>(runs ? 10 : 2), 0, 0, 0, 0, 0});
  file.put<std::uint16_t>({0, 0, 4, 2}).put<std::uint8_t>({32, 8});
  if (runs) return file.put<std::uint8_t>({0x83, 0, 0, 255, 255, 0x83, 255, 0, 0, 128}).bytes();
  for (int i = 0; i < 4; ++i) file.put<std::uint8_t>({0, 0, 255, 255});
  for (int i = 0; i < 4; ++i) file.put<std::uint8_t>({255, 0, 0, 128});
  return file.bytes();
}

void expect_tetrahedron(const Model& model, double scale) {
  EXPECT_EQ(model.positions.size(), 4u);
  EXPECT_EQ(model.faces.size(), 4u);
  EXPECT_NEAR(volume(model), scale * scale * scale / 6, 1e-9) << "wound the wrong way round?";
}

TEST(Md2, ScalesMovesAndTurnsItsTrianglesCounterClockwise) {
  const Model model = read_md2(md2(), "a.md2");
  expect_tetrahedron(model, 2);
  EXPECT_EQ(model.positions[1], Vec3(12, 20, 30));
  EXPECT_EQ(model.texcoords[0], Vec2(0, 1)) << "texture coordinates count from the bottom";
  EXPECT_EQ(model.texcoords[3], Vec2(1, 0));
}

TEST(G3d, HasColourAndTexture) {
  const Model model = read_g3d(g3d(), "a.g3d");
  expect_tetrahedron(model, 1);
  EXPECT_EQ(model.materials.at(0).colour, Vec3(0.5, 0.25, 1));
  EXPECT_EQ(model.materials.at(0).texture, "skin.png");
  EXPECT_EQ(model.texcoords[model.faces[0].corners[1].texcoord], Vec2(0, 1));
}

TEST(Md3, TakesTheFrameAskedFor) {
  expect_tetrahedron(read_md3(md3("body", "tag_torso"), "a.md3", 0).model, 1);
  const Md3 second = read_md3(md3("body", "tag_torso"), "a.md3", 1);
  EXPECT_EQ(second.model.positions[0], Vec3(1, 0, 0));
  ASSERT_EQ(second.tags.size(), 1u);
  EXPECT_EQ(second.tags[0].origin, Vec3(1, 0, 5));
  EXPECT_THROW(read_md3(md3("body", "tag_torso"), "a.md3", 2), IoError);
}

TEST(Md3, PartsOfAPlayerHangOnTheirTags) {
  TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::string& data) { std::ofstream(folder / name) << data; };
  write("lower.md3", md3("legs", "tag_torso"));
  write("upper.md3", md3("torso", "tag_head"));
  write("head.md3", md3("head", "tag_none"));
  write("lower_default.skin", "tag_torso,\r\nlegs,models/players/x/skin1.tga\r\n");
  write("upper_default.skin", "torso,models/players/x/skin2.tga");
  write("head_default.skin", "");
  const Model player = read_player(folder.path(), {0, 0, 0});
  ASSERT_EQ(player.positions.size(), 12u);
  EXPECT_NEAR(volume(player), 3 * (1.0 / 6), 1e-9);
  EXPECT_EQ(player.positions[4], Vec3(0, 0, 5));             // upper's origin at the lower part's tag
  EXPECT_TRUE(player.positions[5].isApprox(Vec3(0, 1, 5)));  // whose x axis is y
  EXPECT_EQ(player.positions[8], Vec3(0, 0, 10));
  EXPECT_TRUE(player.positions[9].isApprox(Vec3(-1, 0, 10)));
  EXPECT_EQ(player.materials[0].texture, "skin1.tga");
  EXPECT_EQ(player.materials[1].texture, "skin2.tga");
  EXPECT_EQ(player.materials[2].texture, "");
}

TEST(Tga, PlainAndRunsAreTheSamePicture) {
  const Picture plain = read_tga(tga(false), "a.tga");
  EXPECT_EQ(plain, read_tga(tga(true), "a.tga"));
  EXPECT_EQ(plain(0, 0), (Rgba{0, 0, 255, 128}));  // rows are stored from the bottom
  EXPECT_EQ(plain(3, 1), (Rgba{255, 0, 0, 255}));
}

struct Format {
  const char* name;
  std::string bytes;
  std::function<Model(std::string_view)> read;
};
Model no_model(const Picture&) { return {}; }

class BinaryFormat : public ::testing::TestWithParam<Format> {};

TEST_P(BinaryFormat, EveryTruncationIsRefused) {
  for (std::size_t n = 0; n < GetParam().bytes.size(); ++n)
    EXPECT_THROW(GetParam().read(GetParam().bytes.substr(0, n)), IoError) << n << " bytes";
}

TEST_P(BinaryFormat, ANumberThatLiesIsRefusedOrHarmless) {
  for (std::size_t at = 0; at + 4 <= GetParam().bytes.size(); at += 2)
    for (const std::uint32_t lie : {0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0x10000000u, 0x7fc00000u}) {
      std::string bytes = GetParam().bytes;
      std::memcpy(bytes.data() + at, &lie, sizeof(lie));
      try {
        const Model model = GetParam().read(bytes);
        for (const Face& face : model.faces)
          for (const Corner& c : face.corners) {
            ASSERT_LT(c.position, static_cast<int>(model.positions.size())) << lie << " at byte " << at;
            ASSERT_LT(c.texcoord, static_cast<int>(model.texcoords.size())) << lie << " at byte " << at;
            ASSERT_GE(c.position, 0);
            ASSERT_TRUE(model.positions[c.position].allFinite()) << lie << " at byte " << at;
          }
      } catch (const IoError& error) {
        EXPECT_THAT(error.what(), HasSubstr("file: "));
      }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Formats, BinaryFormat,
    ::testing::Values(Format{"Md2", md2(), [](auto data) { return read_md2(data, "file"); }},
                      Format{"G3d", g3d(), [](auto data) { return read_g3d(data, "file"); }},
                      Format{"Md3", md3("body", "tag"), [](auto data) { return read_md3(data, "file", 1).model; }},
                      Format{"TgaPlain", tga(false), [](auto data) { return no_model(read_tga(data, "file")); }},
                      Format{"TgaRuns", tga(true), [](auto data) { return no_model(read_tga(data, "file")); }}),
    [](const auto& info) { return info.param.name; });

TEST(Raw, IsTriangles) {
  const Model model = read_raw("3\n0 0 0 0 0\n1e0 0 0 1 0\n0 1 0 0.5 1\n", "a.raw");
  ASSERT_EQ(model.faces.size(), 1u);
  EXPECT_EQ(model.positions[2], Vec3(0, 1, 0));
  EXPECT_EQ(model.texcoords[2], Vec2(0.5, 1));
}

TEST(Raw, RefusesWhatIsNoTriangles) {
  for (const char* text : {"", "x", "3", "3 0 0 0", "4 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 1 1 0 0 0", "-3", "3000000000000",
                           "3 0 0 0 0 0 1 0 0 0 0 0 1 nan 0 0", "3 0 0 0 0 0 1 0 0 0 0 0 1 0 0 "})
    EXPECT_THROW(read_raw(text, "a.raw"), IoError) << text;
}

// Floats 0 0 0 1 0 0 0 1 0; indices 0 1 2.
const std::string kJsPositions =
    R"(exports.positions = require("./load")(Float32Array, "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"))";

TEST(Js, IsBase64OfTypedArrays) {
  const Model model = read_js(kJsPositions + R"(;exports.cells = require("./load")(Uint16Array, "AAABAAIA"))", "a.js");
  ASSERT_EQ(model.positions.size(), 3u);
  EXPECT_EQ(model.positions[1], Vec3(1, 0, 0));
  ASSERT_EQ(model.faces.size(), 1u);
  EXPECT_EQ(model.faces[0].corners[2].position, 2);
}

TEST(Js, RefusesOtherModulesAndCornersThatAreNotThere) {
  const std::string cells = R"(;exports.cells = require("./load")(Uint16Array, ")";
  for (const std::string& text :
       {std::string("exports.a = 1"), kJsPositions, kJsPositions + cells, kJsPositions + cells + "AAABAAMA\")",
        kJsPositions + cells + "AAAB??\")", "exports.cells = Float32Array;" + kJsPositions})
    EXPECT_THROW(read_js(text, "a.js"), IoError) << text;
}

class Obj : public ::testing::Test {
 protected:
  Model read(const std::string& text, const std::vector<std::string>& objects = {}) {
    std::ofstream(folder_ / "a.obj") << text;
    return read_obj(folder_ / "a.obj", objects);
  }
  TemporaryFolder folder_;
};

TEST_F(Obj, CountsFromTheFrontAndFromTheEnd) {
  const Model model = read("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvt 0 0\r\nf 1/1 2/1/7 -1/-1\r\n  f -3//1 2 3\r\n");
  ASSERT_EQ(model.faces.size(), 2u);
  EXPECT_EQ(model.faces[0].corners[2].position, 2);
  EXPECT_EQ(model.faces[0].corners[2].texcoord, 0);
  EXPECT_EQ(model.faces[1].corners[0].position, 0);
  EXPECT_EQ(model.faces[1].corners[0].texcoord, -1);
}

TEST_F(Obj, TakesOnlyTheObjectsAskedFor) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\no left\nf 1 2 3\no right side\nf 3 2 1\nf 1 3 2\n";
  EXPECT_EQ(read(text).faces.size(), 3u);
  EXPECT_EQ(read(text, {"right side"}).faces.size(), 2u);
  EXPECT_THROW(read(text, {"other"}), IoError);
}

TEST_F(Obj, NamesOfMaterialsAndTexturesMayHoldSpacesAndFolders) {
  std::ofstream(folder_ / "my colours.mtl")
      << "newmtl dark red\nKd 0.5 0 0\nmap_Kd -s 1 1 1 maps\\the skin.jpg\nnewmtl b\nKd 0 0 1\n";
  const Model model = read(
      "mtllib my colours.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl dark red\nf 1 2 3\nusemtl b\nf 3 2 1\nusemtl c\nf 1 2 "
      "3");
  ASSERT_EQ(model.materials.size(), 3u);
  EXPECT_EQ(model.materials[0].colour, Vec3(0.5, 0, 0));
  EXPECT_EQ(model.materials[0].texture, "the skin.jpg");
  EXPECT_EQ(model.materials[1].colour, Vec3(0, 0, 1));
  EXPECT_EQ(model.materials[2].colour, Material().colour) << "a material that no library has is grey";
  EXPECT_EQ(model.faces[1].material, 1);
}

TEST_F(Obj, ErrorsNameTheLine) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* line :
       {"f 1 2 4", "f 1 2", "f 1 2 0", "f 1 2 -4", "f 1 2 x", "f /1 2 3", "v 1 2", "v 1 2 nan", "f 1/1 2 3"}) {
    try {
      read(corners + line + "\n");
      ADD_FAILURE() << line;
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.obj: line 4: ")) << line;
    }
  }
  EXPECT_THROW(read_obj(folder_ / "missing.obj"), IoError);
}

class Polygons : public ::testing::TestWithParam<unsigned> {};

// Star-shaped about its middle, in a random plane: as a rule not convex.
TEST_P(Polygons, TrianglesCoverThePolygonOnce) {
  std::mt19937 random(GetParam());
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const int corners = 4 + static_cast<int>(GetParam());
  const Vec3 normal = Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized(),
             across = normal.unitOrthogonal();
  std::vector<Vec3> outline;
  Vec3 area = Vec3::Zero();
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    outline.push_back(Vec3(5, 6, 7) +
                      uniform(0.2, 1) * (std::cos(angle) * across + std::sin(angle) * normal.cross(across)));
    if (i > 1) area += (outline[i - 1] - outline[0]).cross(outline[i] - outline[0]) / 2;
  }
  double sum = 0;
  const auto triangles = triangulate(outline);
  EXPECT_EQ(triangles.size(), outline.size() - 2);
  for (const auto& [a, b, c] : triangles) {
    const double signed_area = (outline[b] - outline[a]).cross(outline[c] - outline[a]).dot(normal) / 2;
    EXPECT_GE(signed_area, -1e-12) << "turned over";
    sum += std::abs(signed_area);
  }
  EXPECT_NEAR(sum, area.norm(), 1e-9);
}
INSTANTIATE_TEST_SUITE_P(Seeds, Polygons, ::testing::Range(0u, 24u));

TEST(Inventor, ShapesAreTurnedAndColoured) {
  TemporaryFolder folder;
  std::ofstream(folder / "a.iv")
      << "#Inventor V2.1 ascii\nSeparator { Transform { translation 10 0 0 scaleFactor 1 2 3 }\n"
         "Material { diffuseColor 1 0.5 0 } Cube {}\nMaterial { diffuseColor 0 0 1 } Cone {} }\n";
  const Model model = read_inventor(folder / "a.iv");
  ASSERT_EQ(model.materials.size(), 2u);
  EXPECT_EQ(model.materials[0].colour, Vec3(1, 0.5, 0));
  Model cube = model;
  std::erase_if(cube.faces, [](const Face& f) { return f.material == 1; });
  EXPECT_EQ(cube.faces.size(), 12u);
  EXPECT_NEAR(volume(cube), 8 * 6, 1e-4);
  for (const Vec3& p : cube.positions) EXPECT_NEAR(p.x(), 10, 1.001);
}

TEST(Inventor, RefusesABrokenFile) {
  TemporaryFolder folder;
  std::ofstream(folder / "a.iv") << "#Inventor V2.1 ascii\nSeparator { Cube { width }";
  std::ofstream(folder / "b.iv") << "not at all";
  std::ofstream(folder / "c.iv") << "#Inventor V2.1 ascii\nSeparator { }";
  for (const char* name : {"a.iv", "b.iv", "c.iv", "missing.iv"})
    EXPECT_THROW(read_inventor(folder / name), IoError) << name;
}

TEST(AssimpFormats, OffAndCompressedPly) {
  TemporaryFolder folder;
  std::ofstream(folder / "a.off") << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  EXPECT_NEAR(volume(read_assimp(folder / "a.off")), 1.0 / 6, 1e-9);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const gzFile file = gzopen((folder / "a.ply.gz").c_str(), "wb");
  gzwrite(file, ply.data(), static_cast<unsigned>(ply.size()));
  gzclose(file);
  EXPECT_NEAR(volume(read_assimp(folder / "a.ply.gz")), 1.0 / 6, 1e-9);
  std::filesystem::resize_file(folder / "a.ply.gz", std::filesystem::file_size(folder / "a.ply.gz") - 9);
  EXPECT_THROW(read_assimp(folder / "a.ply.gz"), IoError);
  std::ofstream(folder / "b.off") << "OFF\n4 4 0\n0 0";
  EXPECT_THROW(read_assimp(folder / "b.off"), IoError);
  EXPECT_THROW(read_assimp(folder / "missing.3ds"), IoError);
}

}  // namespace
}  // namespace carve::artist
