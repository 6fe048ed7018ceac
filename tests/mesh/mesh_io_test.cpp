#include "carve/mesh/mesh_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "mesh/solids.h"
#include "temporary_folder.h"

namespace carve {
namespace {

using ::testing::HasSubstr;
using ::testing::Property;
using ::testing::Throws;

// Positions as a format's numbers hold them.
Mesh as_floats(Mesh mesh) {
  for (Vec3& p : mesh.positions)
    for (double& x : p) {
      const volatile float rounded = static_cast<float>(x);  // g++ 12 leaves the rounding out where it vectorises
      x = rounded;
    }
  return mesh;
}

// The triangles' corners, for formats that do not keep the numbering.
std::vector<Vec3> corners(const Mesh& mesh) {
  std::vector<Vec3> all;
  for (const Triangle& t : mesh.triangles)
    for (const int i : t) all.push_back(mesh.positions[i]);
  return all;
}

class EveryFormat : public ::testing::TestWithParam<std::tuple<const char*, unsigned>> {
 protected:
  std::string ending() const { return std::get<0>(GetParam()); }
  unsigned seed() const { return std::get<1>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Seeds, EveryFormat,
                         ::testing::Combine(::testing::Values("ply", "obj", "off", "stl", "glb"),
                                            ::testing::Range(0u, 6u)));

TEST_P(EveryFormat, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Mesh mesh = random_solid(seed());
  write_mesh(folder / ("mesh." + ending()), mesh);
  const Mesh read = read_mesh(folder / ("mesh." + ending()));
  if (ending() == "stl")
    EXPECT_EQ(corners(read), corners(as_floats(mesh)));
  else
    EXPECT_EQ(read, ending() == "glb" ? as_floats(mesh) : mesh);
}

TEST_P(EveryFormat, TheSameMeshGivesTheSameBytes) {
  const TemporaryFolder folder;
  const Mesh mesh = random_solid(seed());
  write_mesh(folder / ("a." + ending()), mesh);
  write_mesh(folder / ("b." + ending()), mesh);
  EXPECT_EQ(read_file(folder / ("a." + ending())), read_file(folder / ("b." + ending())));
}

}  // namespace
}  // namespace carve
