// What read_mesh makes of other people's files, and of broken ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/mesh/adjacency.h"
#include "carve/mesh/formats.h"
#include "carve/mesh/mesh_io.h"
#include "carve/mesh/topology.h"
#include "mesh/solids.h"
#include "temporary_folder.h"

namespace carve {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

Mesh read_bytes(const std::string& name, const std::string& bytes) { return formats::read(name, bytes); }

// Reading fails, and the message is one short line with the file's name and `part`.
void expect_refused(const std::string& name, const std::string& bytes, const std::string& part) {
  try {
    read_bytes(name, bytes);
    ADD_FAILURE() << "read:\n" << bytes.substr(0, 300);
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(name), HasSubstr(part), Not(HasSubstr("\n"))));
    EXPECT_LT(std::string(error.what()).size(), 400u);
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

const std::string kPly =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

TEST(ReadPly, Ascii) { EXPECT_EQ(read_bytes("a.ply", kPly), tetrahedron_mesh()); }

TEST(ReadPly, LineEndsAndLineBreaksDoNotMatter) {
  std::string dos;
  for (const char c : kPly) dos += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(read_bytes("a.ply", dos), tetrahedron_mesh());
  EXPECT_EQ(read_bytes("a.ply", replaced(kPly, "1 0 0\n0 1 0\n", "1 0\n\n0 0 1\n0 ")), tetrahedron_mesh());
  EXPECT_EQ(read_bytes("a.ply", kPly.substr(0, kPly.size() - 1)), tetrahedron_mesh()) << "no line end at the end";
}

// Elements and properties of every kind around the ones that matter.
std::string binary_ply(bool big) {
  std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                      "_endian 1.0\nobj_info x\nelement material 2\nproperty list ushort double weights\n"
                      "element vertex 4\nproperty uchar red\nproperty short z\nproperty double x\nproperty list uchar "
                      "ushort tags\nproperty float32 y\nelement empty 7\nelement face 2\nproperty list int8 uint16 "
                      "vertex_index\nproperty int8 flag\nelement edge 1\nproperty int vertex1\nend_header\n";
  for (int i = 0; i < 2; ++i) {
    append<std::uint16_t>(bytes, static_cast<std::uint16_t>(i), big);
    for (int j = 0; j < i; ++j) append<double>(bytes, 0.5, big);
  }
  for (int i = 0; i < 4; ++i) {
    append<std::uint8_t>(bytes, 9, big);
    append<std::int16_t>(bytes, static_cast<std::int16_t>(-300 * i), big);
    append<double>(bytes, 0.1 * i, big);
    append<std::uint8_t>(bytes, static_cast<std::uint8_t>(i), big);
    for (int j = 0; j < i; ++j) append<std::uint16_t>(bytes, 77, big);
    append<float>(bytes, 0.25f * static_cast<float>(i), big);
  }
  for (const std::vector<std::uint16_t>& face : {std::vector<std::uint16_t>{0, 1, 2}, {0, 1, 2, 3}}) {
    append<std::int8_t>(bytes, static_cast<std::int8_t>(face.size()), big);
    for (const std::uint16_t corner : face) append(bytes, corner, big);
    append<std::int8_t>(bytes, -1, big);
  }
  append<std::int32_t>(bytes, 3, big);
  return bytes;
}

TEST(ReadPly, BinaryOfBothEndiannessesSkipsWhatIsNotGeometry) {
  Mesh expected;
  for (int i = 0; i < 4; ++i) expected.positions.emplace_back(0.1 * i, 0.25 * i, -300 * i);
  expected.triangles = {{0, 1, 2}, {0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(read_bytes("a.ply", binary_ply(false)), expected);
  EXPECT_EQ(read_bytes("a.ply", binary_ply(true)), expected);
}

TEST(ReadPly, SaysWhatIsWrong) {
  const auto refused = [](const std::string& from, const std::string& to, const std::string& part) {
    expect_refused("a.ply", replaced(kPly, from, to), part);
  };
  refused("ply\n", "plx\n", "must begin with ply");
  refused("ascii", "asci", "got 'asci'");
  refused("format ascii 1.0\n", "", "no format");
  refused("vertex 4", "vertex -4", "got '-4'");
  refused("vertex 4", "vertex 10000000000", "got 10000000000");
  refused("face 4", "face 18446744073709551615", "got 18446744073709551615");
  refused("face 4", "face 99999999999999999999", "whole number");
  refused("float z", "float w", "no property z");
  refused("float z", "half z", "got 'half'");
  refused("list uchar", "list float", "whole type");
  refused("int vertex_indices", "float vertex_indices", "list of a whole type");
  refused("vertex_indices", "corners", "no property vertex_indices");
  refused("end_header", "endheader", "unknown word");
  refused("element face", "element vertex", "twice");
  refused("3 0 2 1", "3 0 2 4", "must be in [0, 4), got 4");
  refused("3 0 2 1", "3 0 -2 1", "must be in [0, 4), got -2");
  refused("3 0 2 1", "2 0 2", "at least 3 corners, got 2");
  refused("3 0 2 1", "-3 0 2 1", "count from 0, got -3");
  refused("3 0 2 1", "3000 0 2 1", "ends before 'face' 0 of 4");
  refused("1 0 0", "1 nan 0", "must be finite, got nan");
  refused("1 0 0", "1 -inf 0", "must be finite, got inf");
  refused("1 0 0", "1 1e999 0", "got '1e999'");
  refused("1 0 0", "1 0,5 0", "got '0,5'");
  refused("3 0 3 2\n", "3 0 3", "ends before 'face' 3 of 4");
}

TEST(ReadObj, FacesOfEveryForm) {
  const Mesh mesh = read_bytes("a.obj",
                               "# comment\r\nmtllib a.mtl\r\no thing\r\nv 0 0 0\r\nv\t1 0 0 1.0\r\n v 0 +1 0 0.5 0.5 "
                               "0.5\r\nv 0 0 1e0 # end\r\nvt 0 0\r\nvn 0 0 1\r\ns off\r\nusemtl m\r\n\r\nf 1 3 2\r\nf "
                               "1/1 2/1 4/1\r\nf 2//1 3//1 4//1\r\nf -4/1/1 \\\r\n -1/1/1 -2/1/1\r\nl 1 2\r\n");
  EXPECT_EQ(mesh, tetrahedron_mesh());
}

TEST(ReadObj, PolygonsBecomeFans) {
  const Mesh mesh = read_bytes("a.obj", "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(ReadObj, FacesMayStandBeforeTheirVertices) {
  EXPECT_EQ(read_bytes("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0").triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(ReadObj, NegativeIndicesCountFromTheVerticesSoFar) {
  const Mesh mesh = read_bytes("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -4 -1 -2\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 2}}));
}

TEST(ReadObj, SaysWhatIsWrongAndWhere) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_refused("a.obj", start + "f 1 2 4\nv x", "a.obj:5: a coordinate must be a number, got 'x'");
  expect_refused("a.obj", start + "f 1 2 4\n", "a.obj:4: a face's corner must index one of 3 vertices, got 4");
  expect_refused("a.obj", start + "f 1 2 0\n", "got 0");
  expect_refused("a.obj", start + "f 1 2 -4\n", "got -4");
  expect_refused("a.obj", start + "f 1 2 99999999999\n", "got 99999999999");
  expect_refused("a.obj", start + "f 1 2 99999999999999999999\n", "got '99999999999999999999'");
  expect_refused("a.obj", start + "f 1 2\n", "at least 3 corners, got 2");
  for (const char* corner : {"x", "3/", "3//", "3/1/", "3/1/1/1", "/3", "3//x", "3/x/1", "3.0", "1-2"})
    expect_refused("a.obj", start + "f 1 2 " + corner + "\n", std::string("got '") + corner + "'");
  expect_refused("a.obj", "v 1 2\n", "a.obj:1: a coordinate must be a number, got the end of the line");
  expect_refused("a.obj", "v 1 2 nan\n", "finite");
  expect_refused("a.obj", "v 1 2 " + std::string(100000, '7') + "x\n", "...'");
}

const std::string kStl =
    "solid # a name\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n"
    " endfacet\n FACET NORMAL 0 0 -1\n  OUTER LOOP\n   VERTEX 0 0 0\n   VERTEX 0 1e0 0\n   VERTEX 1 -0 0\n  ENDLOOP\n"
    " ENDFACET\nendsolid\n";

TEST(ReadStl, AsciiIsTurnedAndMerged) {
  const Mesh mesh = read_bytes("a.stl", kStl);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 1}}));
}

TEST(ReadStl, BinaryMayBeginWithSolid) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.stl", tetrahedron_mesh());
  std::string bytes = read_file(folder / "a.stl");
  bytes.replace(0, 5, "solid");
  EXPECT_TRUE(topology(read_bytes("b.stl", bytes)).solid());
}

TEST(ReadStl, SaysWhatIsWrong) {
  expect_refused("a.stl", "", "at least 84 bytes, got 0");
  expect_refused("a.stl", replaced(kStl, "endsolid\n", ""), "ends before its endsolid");
  expect_refused("a.stl", replaced(kStl, "   vertex 1 0 0\n", ""), "a.stl:7: a facet must have 3 vertices, got 2");
  expect_refused("a.stl", replaced(kStl, "vertex 1 0 0", "vertex 1 0"), "a.stl:5: a coordinate");
  expect_refused("a.stl", replaced(kStl, "endloop", "endlop"), "got 'endlop'");
  std::string lies(84, '\0');
  lies[83] = '\x70';
  expect_refused("a.stl", lies, "declares 1879048192 triangles");
}

const std::string kOff =
    "OFF\n# comment\n4 4 6\n0 0 0\n1 0 0\n0 1 0 # here\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

TEST(ReadOff, PlainAndWithMoreThanItNeeds) {
  EXPECT_EQ(read_bytes("a.off", kOff), tetrahedron_mesh());
  EXPECT_EQ(read_bytes("a.off", replaced(kOff, "OFF\n# comment\n", "OFF")), tetrahedron_mesh());
  EXPECT_EQ(read_bytes("a.off", replaced(kOff, "OFF\n# comment\n", "OFF ")), tetrahedron_mesh());
  EXPECT_EQ(read_bytes("a.off", replaced(kOff, "4 4 6", "4 4")), tetrahedron_mesh());
  EXPECT_EQ(read_bytes("a.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2 0.5 0.5 0.5\n"),
            (Mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}}));
}

TEST(ReadOff, SaysWhatIsWrong) {
  expect_refused("a.off", "", "must begin with OFF");
  expect_refused("a.off", replaced(kOff, "OFF", "4OFF"), "got '4OFF'");
  expect_refused("a.off", replaced(kOff, "4 4 6", "10000000000 4 6"), "got '10000000000'");
  expect_refused("a.off", replaced(kOff, "4 4 6", "4 10000000000 6"), "got '10000000000'");
  expect_refused("a.off", replaced(kOff, "4 4 6", "4 -1 6"), "got '-1'");
  expect_refused("a.off", replaced(kOff, "4 4 6", "4 5 6"), "ends before face 4 of 5");
  expect_refused("a.off", replaced(kOff, "3 0 2 1", "3 0 2 4"), "must be in [0, 4), got 4");
  expect_refused("a.off", replaced(kOff, "3 0 2 1", "2 0 2"), "at least 3 corners, got 2");
  expect_refused("a.off", replaced(kOff, "3 0 2 1", "4 0 2 1"), "got the end of the line");
  expect_refused("a.off", replaced(kOff, "1 0 0", "1 inf 0"), "finite");
}

// A GLB file of one buffer, padded as the format wants it.
std::string glb(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  append<std::uint32_t>(bytes, 2);
  append(bytes, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(binary.size()));
  bytes += std::string("BIN\0", 4) + binary;
  return bytes;
}

// Four corners of a unit square in the xy plane and the byte indices 0 1 2 3.
std::string square(const std::string& nodes, const std::string& primitive = R"("indices":1,"mode":5)") {
  std::string binary;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 1.f, 1.f, 0.f}) append(binary, x);
  binary += std::string("\0\1\2\3", 4);
  return glb(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
                 R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},)" + primitive +
                 R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)" +
                 R"({"bufferView":1,"componentType":5121,"count":4,"type":"SCALAR"}],"bufferViews":[)" +
                 R"({"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":4}],)" +
                 R"("buffers":[{"byteLength":52}]})",
             binary);
}

TEST(ReadGlb, StripsAndFansAndMeshesWithoutIndices) {
  const auto triangles = [](const std::string& primitive) {
    return read_bytes("a.glb", square(R"({"mesh":0})", primitive)).triangles;
  };
  EXPECT_EQ(triangles(R"("indices":1,"mode":5)"), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(triangles(R"("indices":1,"mode":6)"), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(triangles(R"("mode":5)"), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_TRUE(triangles(R"("indices":1,"mode":1)").empty()) << "lines are no triangles";
}

TEST(ReadGlb, NodesPlaceTheirMeshesBelowTheirParents) {
  // Parent: moved by (10, 0, 0) and turned a quarter about z; children: plain, and mirrored along x and scaled.
  const Mesh mesh = read_bytes(
      "a.glb",
      square(R"({"translation":[10,0,0],"rotation":[0,0,0.7071067811865476,0.7071067811865476],"children":[1,2]},)"
             R"({"mesh":0},{"mesh":0,"matrix":[-2,0,0,0,0,2,0,0,0,0,2,0,0,0,5,1]})"));
  ASSERT_EQ(mesh.positions.size(), 8u);
  const Vec3 expected[] = {{10, 0, 0}, {10, 1, 0},  {9, 0, 0}, {9, 1, 0},
                           {10, 0, 5}, {10, -2, 5}, {8, 0, 5}, {8, -2, 5}};
  for (int i = 0; i < 8; ++i) EXPECT_LT((mesh.positions[i] - expected[i]).norm(), 1e-14) << i;
  // A mirrored mesh keeps its outside.
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {4, 6, 5}, {5, 6, 7}}));
}

TEST(ReadGlb, SaysWhatIsWrong) {
  const std::string good = square(R"({"mesh":0})");
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& part) {
    ASSERT_EQ(from.size(), to.size());
    expect_refused("a.glb", replaced(good, from, to), part);
  };
  refused("glTF", "gLTF", "not a GLB file");
  refused(std::string("glTF\2", 5), std::string("glTF\1", 5), "version must be 2, got 1");
  refused("\"asset\"", "\"asset'", "glTF JSON");
  refused("\"mesh\":0", "\"mesh\":1", "meshes[1] does not exist");
  refused("\"mesh\":0", "\"mesh\":-", "glTF JSON");
  refused("\"nodes\":[0]", "\"nodes\":[7]", "nodes[7] does not exist");
  refused("\"POSITION\":0", "\"POSITION\":1", "must be of type VEC3");
  refused("5126,\"count\":4", "5126,\"count\":5", "do not fit");
  refused("5121,\"count\":4", "5121,\"count\":9", "do not fit");
  refused("5121", "5120", "componentType 5120");
  refused("\"byteOffset\":48", "\"byteOffset\":51", "do not fit");
  refused("\"mode\":5", "\"mode\":4", "multiple of 3, got 4");
  refused("\"mode\":5", "\"mode\":7", "[0, 6], got 7");
  refused(std::string("\0\1\2\3", 4), std::string("\0\1\2\4", 4), "index 3 must be in [0, 4), got 4");
  expect_refused("a.glb", square(R"({"mesh":"0"})"), "mesh must be a whole number from 0, got string");
  expect_refused("a.glb", square(R"({"mesh":-1})"), "mesh must be a whole number from 0, got -1");
  expect_refused("a.glb", good + "x", "declares");
  expect_refused("a.glb", square(R"({"mesh":0,"children":[0]})"), "nodes[0] has two parents");
  expect_refused("a.glb", square(R"({"mesh":0,"translation":[1,2]})"), "glTF JSON");
  expect_refused("a.glb", square(R"({"mesh":0,"scale":[1e308,1e308,1e308],"translation":[1e308,1e308,1e308]})"),
                 "finite");
  expect_refused("a.glb", glb(std::string(1000000, '['), ""), "glTF JSON");
  expect_refused("a.glb",
                 glb(R"({"scenes":[{"nodes":)" + std::string(1000000, '[') + std::string(1000000, ']') + "}]}", ""),
                 "whole number");
  expect_refused("a.glb", glb(R"({"extensionsRequired":["KHR_draco_mesh_compression"]})", ""), "KHR_draco");
}

TEST(ReadGlb, AMeshShownTooOftenIsRefusedBeforeItFillsTheMemory) {
  // 4000 nodes that show one mesh of 40000 vertices: 160 million.
  std::string nodes, children, binary(12 * 40000, '\0');
  for (int i = 1; i <= 4000; ++i) {
    nodes += R"(,{"mesh":0})";
    children += (i > 1 ? "," : "") + std::to_string(i);
  }
  const std::string size = std::to_string(binary.size());
  const std::string json = R"({"scenes":[{"nodes":[0]}],"nodes":[{"children":[)" + children + "]}" + nodes +
                           R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}],"accessors":[)" +
                           R"({"bufferView":0,"componentType":5126,"count":40000,"type":"VEC3"}],"bufferViews":[)" +
                           R"({"buffer":0,"byteLength":)" + size + R"(}],"buffers":[{"byteLength":)" + size + "}]}";
  expect_refused("a.glb", glb(json, binary), "at most 67108864");
}

TEST(ReadMesh, MissingFilesAndFoldersAreRefused) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "b.obj");
  EXPECT_THAT([&] { read_mesh(folder / "a.obj"); }, ThrowsMessage<IoError>(HasSubstr("no such file")));
  EXPECT_THAT([&] { read_mesh(folder / "b.obj"); }, ThrowsMessage<IoError>(HasSubstr("not a regular file")));
}

// One small file of each kind.
std::vector<std::pair<std::string, std::string>> samples() {
  const TemporaryFolder folder;
  std::vector<std::pair<std::string, std::string>> all{{"ascii.ply", kPly},
                                                       {"big.ply", binary_ply(true)},
                                                       {"little.ply", binary_ply(false)},
                                                       {"ascii.stl", kStl},
                                                       {"hand.off", kOff},
                                                       {"strip.glb", square(R"({"mesh":0})")}};
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "a.glb"}) {
    write_mesh(folder / name, torus_mesh(4, 3));
    all.emplace_back(name, read_file(folder / name));
  }
  return all;
}

// Either an IoError or a mesh that is one.
void expect_no_crash(const std::string& name, const std::string& bytes) {
  try {
    check_mesh(read_bytes(name, bytes));
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(name), Not(HasSubstr("\n"))));
  }
}

TEST(ReadMesh, SamplesAreRead) {
  for (const auto& [name, bytes] : samples()) EXPECT_NO_THROW(check_mesh(read_bytes(name, bytes))) << name;
}

TEST(ReadMesh, TruncatedFilesAreRefusedOrRead) {
  for (const auto& [name, bytes] : samples())
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 400)
      expect_no_crash(name, bytes.substr(0, size));
}

TEST(ReadMesh, TruncatedBinaryFilesAreRefused) {
  for (const auto& [name, bytes] : samples()) {
    if (name != "a.ply" && name != "a.stl" && !name.ends_with(".glb")) continue;
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 200)
      EXPECT_THROW(read_bytes(name, bytes.substr(0, size)), IoError) << name << " " << size;
  }
}

class Corruption : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Files, Corruption, ::testing::Range(0, 11));

TEST_P(Corruption, NeverCrashes) {
  const auto [name, bytes] = samples().at(GetParam());
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    std::string broken = bytes;
    for (unsigned changes = 1 + random() % 8; changes > 0; --changes) {
      const std::size_t at = random() % broken.size();
      switch (random() % 4) {
        case 0:
          broken[at] = static_cast<char>(random());
          break;
        case 1:
          broken[at] = "0123456789.-e {}[]\",\n#\\"[random() % 22];
          break;
        case 2:
          broken.insert(at, 1 + random() % 5, static_cast<char>('0' + random() % 10));
          break;
        default:
          broken.erase(at, 1 + random() % 9);
      }
      if (broken.empty()) break;
    }
    expect_no_crash(name, broken);
  }
}

TEST(ReadMesh, CountsThatLieAreRefusedAtOnce) {
  const auto start = std::chrono::steady_clock::now();
  expect_refused("a.ply", replaced(binary_ply(false), "vertex 4", "vertex 10000000000"), "got 10000000000");
  expect_refused("a.ply", replaced(binary_ply(false), "face 2", "face 2000000000"), "got 2000000000");
  expect_refused("a.ply", replaced(kPly, "vertex 4", "vertex 2000000000"), "got 2000000000");
  expect_refused("a.off", replaced(kOff, "4 4 6", "2000000000 4 6"), "2000000000");
  expect_refused("a.glb", replaced(square(R"({"mesh":0})"), "5126,\"count\":4", "5126,\"count\":4000000000"), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

}  // namespace
}  // namespace carve
