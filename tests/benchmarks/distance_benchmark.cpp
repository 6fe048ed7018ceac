// 1,000,000 points against 200,000 triangles: ours, CGAL, Embree, and CloudCompare where it is installed. Every answer
// is computed in a process of its own, so that its peak memory is its own; the inputs' share is taken off.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>

#include "carve/core/parallel.h"
#include "carve/mesh/mesh_io.h"
#include "eval/mesh_distance.h"
#include "eval/meshes.h"
#include "program.h"

namespace carve {
namespace {

// Bumps that differ a little between compared and reference, so that a point lies about 1 % of the size away.
Mesh bumpy(int rings, int sectors, double bumps, double size) {
  return globe(rings, sectors, [=](double polar, double azimuth) {
    return size * (1 + bumps * std::sin(5 * polar) * std::sin(polar) * std::cos(7 * azimuth));
  });
}

const Mesh& reference() {
  static const Mesh mesh = bumpy(251, 400, 0.10, 1);
  return mesh;
}
const Mesh& compared() {
  static const Mesh mesh = bumpy(1001, 1000, 0.12, 1.01);
  return mesh;
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Seconds of all threads; what a busy machine's clock cannot tell.
double cpu_now() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_utime.tv_sec + usage.ru_stime.tv_sec + 1e-6 * (usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

struct Answer {
  double build = 0, query = 0, query_cpu = 0;
};
using Distances = std::span<double>;

Answer ours(const Mesh& mesh, std::span<const Vec3> points, Distances out) {
  const double start = now();
  const MeshDistance distance(mesh);
  const double built = now(), cpu = cpu_now();
  const std::vector<Nearest> nearest = distance.nearest(points);
  const double done = now(), cpu_done = cpu_now();
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = nearest[i].distance;
  return {built - start, done - built, cpu_done - cpu};
}

Answer by_cgal(const Mesh& mesh, std::span<const Vec3> points, Distances out) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
  const auto point = [](const Vec3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  Triangles triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.emplace_back(point(mesh.positions[a]), point(mesh.positions[b]), point(mesh.positions[c]));
  const double start = now();
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(triangles.begin(), triangles.end());
  tree.accelerate_distance_queries();
  const double built = now(), cpu = cpu_now();
  parallel_ranges(0, static_cast<int>(points.size()), 4096, [&](int first, int last) {
    for (int i = first; i < last; ++i) out[i] = std::sqrt(tree.squared_distance(point(points[i])));
  });
  return {built - start, now() - built, cpu_now() - cpu};
}

struct EmbreeQuery {
  const std::vector<float>* vertices;
  const std::vector<unsigned>* indices;
  float nearest;
};

bool embree_triangle(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<EmbreeQuery*>(arguments->userPtr);
  const auto corner = [&](int k) {
    const float* v = query.vertices->data() + 3 * (*query.indices)[3 * arguments->primID + k];
    return Eigen::Vector3f(v[0], v[1], v[2]);
  };
  const Eigen::Vector3f p(arguments->query->x, arguments->query->y, arguments->query->z);
  // Ericson, Real-Time Collision Detection, 5.1.5, in floats as Embree's own example measures.
  const Eigen::Vector3f a = corner(0), b = corner(1), c = corner(2), ab = b - a, ac = c - a, ap = p - a;
  const float d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(p - b), d4 = ac.dot(p - b), d5 = ab.dot(p - c),
              d6 = ac.dot(p - c);
  const float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  Eigen::Vector3f q;
  if (d1 <= 0 && d2 <= 0)
    q = a;
  else if (d3 >= 0 && d4 <= d3)
    q = b;
  else if (d6 >= 0 && d5 <= d6)
    q = c;
  else if (vc <= 0 && d1 >= 0 && d3 <= 0)
    q = a + d1 / (d1 - d3) * ab;
  else if (vb <= 0 && d2 >= 0 && d6 <= 0)
    q = a + d2 / (d2 - d6) * ac;
  else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    q = b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  else
    q = a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
  const float distance = (p - q).norm();
  if (distance >= query.nearest) return false;
  query.nearest = arguments->query->radius = distance;
  return true;
}

Answer by_embree(const Mesh& mesh, std::span<const Vec3> points, Distances out) {
  std::vector<float> vertices;
  for (const Vec3& p : mesh.positions)
    for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(p[k]));
  vertices.push_back(0);  // Embree reads four floats at the last vertex
  std::vector<unsigned> indices;
  for (const Triangle& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  const double start = now();
  const RTCDevice device = rtcNewDevice(nullptr);
  const RTCScene scene = rtcNewScene(device);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0, 12,
                             mesh.positions.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices.data(), 0, 12,
                             mesh.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcCommitScene(scene);
  const double built = now(), cpu = cpu_now();
  parallel_ranges(0, static_cast<int>(points.size()), 4096, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      EmbreeQuery answer{&vertices, &indices, std::numeric_limits<float>::infinity()};
      RTCPointQuery query{static_cast<float>(points[i].x()), static_cast<float>(points[i].y()),
                          static_cast<float>(points[i].z()), 0, answer.nearest};
      RTCPointQueryContext context;
      rtcInitPointQueryContext(&context);
      rtcPointQuery(scene, &query, &context, embree_triangle, &answer);
      out[i] = answer.nearest;
    }
  });
  const double done = now(), cpu_done = cpu_now();
  rtcReleaseGeometry(geometry);
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  return {built - start, done - built, cpu_done - cpu};
}

Answer nothing(const Mesh&, std::span<const Vec3>, Distances out) {
  std::fill(out.begin(), out.end(), 0);
  return {};
}

// What a child process leaves behind: its times, its distances, its peak memory.
struct Result {
  Answer answer;
  std::vector<double> distances;
  double megabytes = 0;
};

template <class Work>
Result in_a_process(const Work& work, int threads) {
  const std::vector<Vec3>& points = compared().positions;
  reference();
  const std::size_t bytes = sizeof(Answer) + points.size() * sizeof(double);
  auto* shared = static_cast<char*>(mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  auto* distances = reinterpret_cast<double*>(shared + sizeof(Answer));
  const pid_t child = fork();
  if (child == 0) {
    set_thread_count(threads);
    *reinterpret_cast<Answer*>(shared) = work(reference(), points, Distances(distances, points.size()));
    _exit(0);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  Result result{*reinterpret_cast<Answer*>(shared), {distances, distances + points.size()}, usage.ru_maxrss / 1024.0};
  munmap(shared, bytes);
  if (status != 0) throw std::runtime_error("a measured process failed");
  return result;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

template <class Work>
void measure(benchmark::State& state, const Work& work) {
  static const std::vector<double> exact = in_a_process(ours, 0).distances;
  static const double inputs = in_a_process(nothing, 1).megabytes;
  for (auto _ : state) {
    const Result result = in_a_process(work, static_cast<int>(state.range(0)));
    state.SetIterationTime(result.answer.query);
    state.counters["query_cpu_s"] = result.answer.query_cpu;
    state.counters["build_s"] = result.answer.build;
    state.counters["MB"] = result.megabytes - inputs;
    state.counters["differs"] = largest_difference(exact, result.distances);
  }
}

void Ours(benchmark::State& state) { measure(state, ours); }
void Cgal(benchmark::State& state) { measure(state, by_cgal); }
void Embree(benchmark::State& state) { measure(state, by_embree); }

// The whole process from files to file, and of that what it says it computed for; its memory includes its libraries.
void CloudCompare(benchmark::State& state) {
  if (run_program("command -v CloudCompare").code != 0) return state.SkipWithError("CloudCompare is not installed");
  const TemporaryFolder folder;
  write_mesh(folder / "compared.ply", compared());
  write_mesh(folder / "reference.ply", reference());
  const std::string command = "cd " + folder.path().string() + " && HOME=" + folder.path().string() +
                              " QT_QPA_PLATFORM=offscreen exec CloudCompare -SILENT -NO_TIMESTAMP -AUTO_SAVE OFF "
                              "-C_EXPORT_FMT PLY -O compared.ply -EXTRACT_VERTICES -CLEAR_MESHES -O reference.ply "
                              "-C2M_DIST -MAX_TCOUNT " +
                              std::to_string(state.range(0)) + " -SAVE_CLOUDS";
  for (auto _ : state) {
    rusage before{}, after{};
    getrusage(RUSAGE_CHILDREN, &before);
    const double start = now();
    const Outcome outcome = run_program(command);
    state.counters["process_s"] = now() - start;
    const std::size_t at = outcome.out.rfind("[ComputeDistances] Time: ");
    if (outcome.code != 0 || at == std::string::npos) return state.SkipWithError("CloudCompare failed");
    state.SetIterationTime(std::atof(outcome.out.c_str() + at + 25));
    getrusage(RUSAGE_CHILDREN, &after);
    if (after.ru_maxrss > before.ru_maxrss) state.counters["MB"] = after.ru_maxrss / 1024.0;  // else hidden by a larger
  }
}

BENCHMARK(Ours)->Arg(1)->Arg(2)->UseManualTime()->Iterations(1)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(Cgal)->Arg(1)->Arg(2)->UseManualTime()->Iterations(1)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(Embree)->Arg(1)->Arg(2)->UseManualTime()->Iterations(1)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(CloudCompare)->Arg(1)->Arg(2)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace carve
