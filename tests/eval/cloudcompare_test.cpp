// The figures of cloud_to_mesh beside those of CloudCompare's C2M on the same files. Its scalars and coordinates are
// floats, so coordinates are rounded to floats first and distances agree to a float's digits of the model's size.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "carve/core/as_floats.h"
#include "carve/mesh/mesh_io.h"
#include "eval/compare.h"
#include "eval/meshes.h"
#include "eval/point_triangle.h"
#include "program.h"

namespace carve {
namespace {

struct Figures {
  double mean = 0, deviation = 0, max = 0;  // of the unsigned distances
  double signed_mean = 0, signed_deviation = 0;
};

Figures figures_of(const std::vector<double>& distances) {
  Figures f;
  const auto count = static_cast<double>(distances.size());
  for (const double d : distances) {
    f.mean += std::abs(d) / count;
    f.signed_mean += d / count;
    f.max = std::max(f.max, std::abs(d));
  }
  for (const double d : distances) {
    f.deviation += (std::abs(d) - f.mean) * (std::abs(d) - f.mean) / count;
    f.signed_deviation += (d - f.signed_mean) * (d - f.signed_mean) / count;
  }
  f.deviation = std::sqrt(f.deviation);
  f.signed_deviation = std::sqrt(f.signed_deviation);
  return f;
}

Mesh in_floats(Mesh mesh) {
  for (Vec3& p : mesh.positions) p = as_floats(p);
  return mesh;
}

// A cube's surface in little squares: most of what is near it is nearest to an edge or a corner.
Mesh fine_cube(int n, double side) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0})
      mesh = joined(mesh, mapped(square(n), [=](const Vec3& p) {
                      Vec3 q;
                      q[axis] = sign * side / 2;
                      q[(axis + 1) % 3] = side * (sign > 0 ? p.x() - 0.5 : p.y() - 0.5);
                      q[(axis + 2) % 3] = side * (sign > 0 ? p.y() - 0.5 : p.x() - 0.5);
                      return q;
                    }));
  return mesh;
}

Mesh torus(int around, int across) {
  Mesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.positions.emplace_back(r * std::sin(u), 0.4 * std::sin(v), r * std::cos(u));
      const auto at = [&](int a, int b) { return a % around * across + b % across; };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  return mesh;
}

struct Pair {
  const char* name;
  Mesh compared, reference;
};

std::vector<Pair> pairs() {
  const auto scaled = [](double factor) { return [factor](const Vec3& p) { return Vec3(factor * p); }; };
  const auto lifted = [](const Vec3& p) { return Vec3(p.x(), p.y(), 0.25); };
  return {{"potatoes", potato(60, 1), potato(50, 2)},
          {"ball in ball", ball(40, 0.9), ball(60)},
          {"cube around cube", fine_cube(20, 1.2), fine_cube(12, 1)},
          {"tori", mapped(torus(80, 30), scaled(1.03)), torus(96, 40)},
          {"shifted plane", mapped(square(30), lifted), square(20)}};
}

// A corner so acute that some faces turn their backs on points outside, which are nearest to that corner.
Pair spike() {
  return {"spike",
          mapped(ball(20), [](const Vec3& p) { return Vec3(p + Vec3(3.4, 3.4, 1.4)); }),
          {{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {3, 3, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}}};
}

// CloudCompare's signed distances, a vertex each.
std::vector<double> by_cloudcompare(const TemporaryFolder& folder, const Pair& pair) {
  write_mesh(folder / "compared.ply", pair.compared, {.strict = false});
  write_mesh(folder / "reference.ply", pair.reference, {.strict = false});
  const Outcome outcome = run_program(
      "cd " + folder.path().string() + " && HOME=" + folder.path().string() +
      " QT_QPA_PLATFORM=offscreen CloudCompare -SILENT -NO_TIMESTAMP -AUTO_SAVE OFF -C_EXPORT_FMT PLY -O compared.ply "
      "-EXTRACT_VERTICES -CLEAR_MESHES -O reference.ply -C2M_DIST -SAVE_CLOUDS");
  const std::string bytes = read_file(folder / "compared.vertices_C2M_DIST.ply");
  if (outcome.code != 0 || bytes.find("property float scalar_C2M_signed_distances\nend_header\n") == std::string::npos)
    throw std::runtime_error("CloudCompare did not answer as expected: " + outcome.out);
  const std::size_t begin = bytes.find("end_header\n") + 11, count = pair.compared.positions.size();
  const std::size_t stride = (bytes.size() - begin) / count;
  std::vector<double> distances;
  for (std::size_t i = 0; i < count; ++i) {
    float value = 0;
    std::memcpy(&value, bytes.data() + begin + (i + 1) * stride - 4, 4);
    distances.push_back(value);
  }
  return distances;
}

struct Answers {
  std::vector<double> ours, theirs;
};

class CloudCompare : public testing::Test {
 protected:
  void SetUp() override {
    if (run_program("command -v CloudCompare").code != 0)
      GTEST_SKIP() << "CloudCompare is not installed: parity with its C2M distances is NOT checked here";
  }
  Answers ask(Pair& pair) const {
    pair.compared = in_floats(pair.compared);
    pair.reference = in_floats(pair.reference);
    const TemporaryFolder folder;
    const Reference reference(pair.reference, {.samples = 100, .iou_resolution = 0});
    return {reference.compare(pair.compared).vertex_signed, by_cloudcompare(folder, pair)};
  }
};

void expect_same(const char* pair, const char* figure, double ours, double theirs) {
  EXPECT_NEAR(ours, theirs, 5e-7 * std::abs(theirs) + 1e-14) << pair << ": " << figure;
  std::printf("| %-16s | %-18s | %12.9f | %12.9f | %8.1e |\n", pair, figure, ours, theirs, ours - theirs);
}

TEST_F(CloudCompare, GivesTheSameFiguresToSixDigits) {
  std::printf("| pair             | figure             |         ours | CloudCompare | differ   |\n");
  for (Pair& pair : pairs()) {
    const Answers answers = ask(pair);
    ASSERT_EQ(answers.ours.size(), answers.theirs.size());
    const Figures ours = figures_of(answers.ours), theirs = figures_of(answers.theirs);
    expect_same(pair.name, "mean", ours.mean, theirs.mean);
    expect_same(pair.name, "deviation", ours.deviation, theirs.deviation);
    expect_same(pair.name, "max", ours.max, theirs.max);
    expect_same(pair.name, "signed mean", ours.signed_mean, theirs.signed_mean);
    expect_same(pair.name, "signed deviation", ours.signed_deviation, theirs.signed_deviation);
    for (std::size_t i = 0; i < answers.ours.size(); ++i) ASSERT_NEAR(answers.ours[i], answers.theirs[i], 2e-7);
  }
}

// CloudCompare takes the sign from one of the nearest triangles; the pseudo-normal takes all of them into account. So
// signs may differ where an edge or a corner is nearest, and there ours is right: every point here is outside.
TEST_F(CloudCompare, DiffersInSignAtAcuteCornersOnly) {
  Pair pair = spike();
  const Answers answers = ask(pair);
  int differ = 0;
  const std::vector<Nearest> nearest = MeshDistance(pair.reference).nearest(pair.compared.positions);
  for (std::size_t i = 0; i < answers.ours.size(); ++i) {
    ASSERT_NEAR(answers.ours[i], std::abs(answers.theirs[i]), 2e-7);
    if (answers.theirs[i] > 0) continue;
    ++differ;
    const auto [a, b, c] = pair.reference.triangles[nearest[i].triangle];
    EXPECT_NE(closest_on_triangle(pair.compared.positions[i], pair.reference.positions[a], pair.reference.positions[b],
                                  pair.reference.positions[c])
                  .feature,
              Feature::face);
  }
  EXPECT_GT(differ, 0) << "CloudCompare's rule has changed: say so in eval/signed_distance.h";
  std::printf("| spike: %d of %zu points outside are inside to CloudCompare |\n", differ, answers.ours.size());
}

}  // namespace
}  // namespace carve
