#include "eval/mesh_distance.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "carve/core/parallel.h"
#include "carve/mesh/bvh.h"
#include "eval/morton.h"
#include "eval/point_triangle_kernel.h"
#include "eval/triangle_leaf.h"
#if defined(__x86_64__) && !defined(CARVE_PORTABLE)
#include <immintrin.h>
#endif

namespace carve {
namespace {

using kernel::Float8;
using kernel::TriangleLeaf;
using kernel::V3;
using Double8 = double __attribute__((vector_size(64)));
using Stored8 = float __attribute__((vector_size(32), may_alias));
constexpr int kWidth = Bvh::kWidth;

// Every float computed below differs from its exact value by less than this share of the largest coordinate:
// rounding of point and frame (1/2 ulp each), differences (1), three products and sums (5), twice over. Checked by
// tests/eval/mesh_distance_test.cpp against triangles of all shapes.
constexpr double kFloatError = 64.0 / (1 << 24);
constexpr double kDoubleError = 64.0 / (1ll << 52);
constexpr double kFar = 8;  // beyond this many half sizes floats tell too little: doubles all the way

using Corners = std::array<double, 9>;

}  // namespace

struct MeshDistanceTree {
  Bvh bvh;
  std::vector<TriangleLeaf> leaves;
  std::vector<Corners> corners;  // of every slot, as given
};

namespace {

template <class Real, class Real8>
[[gnu::always_inline]] inline Real8 squared_distances(const BvhNode& node, const Real* p) {
  Real8 sum{};
  for (int k = 0; k < 3; ++k) {
    const Real8 zero{};
    const Float8 low = *reinterpret_cast<const Stored8*>(node.low[k]);
    const Float8 high = *reinterpret_cast<const Stored8*>(node.high[k]);
    const Real8 below = __builtin_convertvector(low, Real8) - p[k], above = p[k] - __builtin_convertvector(high, Real8);
    Real8 gap = below > above ? below : above;
    gap = gap > zero ? gap : zero;
    sum += gap * gap;
  }
  return sum;
}

struct Portable {
  static unsigned bits(const Float8& values, float limit) {
    unsigned set = 0;
    for (int i = 0; i < kWidth; ++i) set |= static_cast<unsigned>(values[i] <= limit) << i;
    return set;
  }
};
#if defined(__x86_64__) && !defined(CARVE_PORTABLE)
struct Avx2 {
  [[gnu::always_inline]] static inline unsigned bits(const Float8& values, float limit) {
    const auto mask = values <= kernel::all(limit);
    return static_cast<unsigned>(__builtin_ia32_movmskps256((Float8)mask));
  }
};
#endif

struct Waiting {
  float squared;
  std::int32_t child;
};

// One thread's search; keeps the last winner as the next query's first guess.
template <class Isa>
class Search {
 public:
  explicit Search(const MeshDistanceTree& tree) : tree_(tree) {}

  [[gnu::always_inline]] inline Nearest operator()(const Vec3& p) {
    const Vec3 q = tree_.bvh.inside(p);
    const double size = std::max(1.0, q.cwiseAbs().maxCoeff());
    p_ = {p.x(), p.y(), p.z()};
    best_ = {std::numeric_limits<double>::infinity(), std::numeric_limits<std::int32_t>::max(), 0};
    if (size > kFar)
      search_far(q, size * kDoubleError);
    else
      search_near(q, static_cast<float>(size * kFloatError));
    seed_ = best_.slot / kWidth;
    return {std::sqrt(best_.squared), best_.triangle};
  }

 private:
  struct Best {
    double squared;
    std::int32_t triangle, slot;
  };

  [[gnu::always_inline]] inline void search_near(const Vec3& q, float error) {
    const float p[3] = {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
    error_ = error;
    candidate_count_ = 0;
    nearest_ = limit_ = std::numeric_limits<float>::max();
    visit_leaf(seed_, p);
    int top = 0;
    stack_[top++] = {0, 0};
    while (top > 0) {
      const Waiting next = stack_[--top];
      if (next.squared > limit_) continue;
      if (next.child < 0) {
        if (~next.child != seed_) visit_leaf(~next.child, p);
        continue;
      }
      const BvhNode& node = tree_.bvh.nodes[next.child];
      const Float8 squared = squared_distances<float, Float8>(node, p);
      push(squared, node, Isa::bits(squared, limit_), top);
    }
    settle();
  }

  // The nearest on top.
  [[gnu::always_inline]] inline void push(const Float8& squared, const BvhNode& node, unsigned set, int& top) {
    const int bottom = top;
    for (; set; set &= set - 1) {
      const int i = __builtin_ctz(set);
      const Waiting entry{squared[i], node.child[i]};
      int at = top++;
      for (; at > bottom && stack_[at - 1].squared < entry.squared; --at) stack_[at] = stack_[at - 1];
      stack_[at] = entry;
    }
  }

  [[gnu::always_inline]] inline void visit_leaf(std::int32_t leaf, const float* p) {
    const Float8 squared =
        kernel::squared_distances(tree_.leaves[leaf], kernel::all(p[0]), kernel::all(p[1]), kernel::all(p[2]));
    unsigned set = Isa::bits(squared, limit_);
    if (!set) return;
    if (candidate_count_ + kWidth > kCandidates) settle();
    for (; set; set &= set - 1) {
      const int i = __builtin_ctz(set);
      candidates_[candidate_count_++] = {squared[i], leaf * kWidth + i};
      if (squared[i] < nearest_) nearest_ = squared[i];
    }
    set_limit(std::sqrt(nearest_) + 2 * error_);
  }

  // A float distance beyond this cannot be that of the nearest triangle.
  [[gnu::always_inline]] inline void set_limit(float length) { limit_ = std::min(limit_, length * length * 1.000001f); }

  // Measures in double what the floats could not rule out.
  [[gnu::always_inline]] inline void settle() {
    std::int32_t batch[kWidth];
    int count = 0;
    for (int i = 0; i < candidate_count_; ++i) {
      if (candidates_[i].squared > limit_) continue;
      batch[count++] = candidates_[i].child;
      if (count == kWidth) measure(batch, count), count = 0;
    }
    if (count) measure(batch, count);
    candidate_count_ = 0;
    set_limit(static_cast<float>(std::sqrt(best_.squared) * tree_.bvh.scale * 1.0000001) + 2 * error_);
  }

  [[gnu::always_inline]] inline void measure(const std::int32_t* slots, int count) {
    for (int i = 0; i < count; ++i) {
      const Corners& c = tree_.corners[slots[i]];
      double squared;
      kernel::point_triangle<double>(p_, {c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}, squared);
      const std::int32_t triangle = tree_.bvh.slots[slots[i]];
      if (squared < best_.squared || (squared == best_.squared && triangle < best_.triangle))
        best_ = {squared, triangle, slots[i]};
    }
  }

  // Doubles throughout, for points so far away that floats cannot tell triangles apart.
  [[gnu::always_inline]] inline void search_far(const Vec3& q, double error) {
    const double p[3] = {q.x(), q.y(), q.z()};
    visit_leaf_far(seed_);
    int top = 0;
    far_stack_[top++] = {0, 0};
    while (top > 0) {
      const auto next = far_stack_[--top];
      const double reach = std::sqrt(best_.squared) * tree_.bvh.scale + error;
      if (next.squared > reach * reach * (1 + 1e-12)) continue;
      if (next.child < 0) {
        visit_leaf_far(~next.child);
        continue;
      }
      const BvhNode& node = tree_.bvh.nodes[next.child];
      const Double8 squared = squared_distances<double, Double8>(node, p);
      const int bottom = top;
      for (int i = 0; i < kWidth; ++i) {
        if (!(squared[i] <= std::numeric_limits<double>::max())) continue;
        int at = top++;
        for (; at > bottom && far_stack_[at - 1].squared < squared[i]; --at) far_stack_[at] = far_stack_[at - 1];
        far_stack_[at] = {squared[i], node.child[i]};
      }
    }
  }

  [[gnu::always_inline]] inline void visit_leaf_far(std::int32_t leaf) {
    std::int32_t batch[kWidth];
    for (int i = 0; i < kWidth; ++i) batch[i] = leaf * kWidth + i;
    measure(batch, kWidth);
  }

  static constexpr int kCandidates = 64;
  struct FarWaiting {
    double squared;
    std::int32_t child;
  };

  const MeshDistanceTree& tree_;
  V3<double> p_{};
  Best best_{};
  float nearest_ = 0, limit_ = 0, error_ = 0;
  std::int32_t seed_ = 0;
  int candidate_count_ = 0;
  Waiting candidates_[kCandidates];
  Waiting stack_[Bvh::kStack];
  FarWaiting far_stack_[Bvh::kStack];
};

template <class Isa>
[[gnu::always_inline]] inline void search_block(const MeshDistanceTree& tree, std::span<const Vec3> points,
                                                std::span<const std::int32_t> order, std::span<Nearest> out) {
  Search<Isa> search(tree);
  for (const std::int32_t i : order) out[i] = search(points[i]);
}

using Block = void (*)(const MeshDistanceTree&, std::span<const Vec3>, std::span<const std::int32_t>,
                       std::span<Nearest>);

void search_portable(const MeshDistanceTree& tree, std::span<const Vec3> points, std::span<const std::int32_t> order,
                     std::span<Nearest> out) {
  search_block<Portable>(tree, points, order, out);
}

#if defined(__x86_64__) && !defined(CARVE_PORTABLE)
__attribute__((target("avx2"))) void search_avx2(const MeshDistanceTree& tree, std::span<const Vec3> points,
                                                 std::span<const std::int32_t> order, std::span<Nearest> out) {
  search_block<Avx2>(tree, points, order, out);
}
#endif

Block widest_block() {
#if defined(__x86_64__) && !defined(CARVE_PORTABLE)
  if (__builtin_cpu_supports("avx2")) return search_avx2;
#endif
  return search_portable;
}

void validate(std::span<const Vec3> points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!(points[i].cwiseAbs().maxCoeff() <= 1e100))
      throw std::invalid_argument("point " + std::to_string(i) + ": coordinates must be finite and within 1e100");
}

}  // namespace

MeshDistance::MeshDistance(const Mesh& mesh) {
  auto tree = std::make_unique<MeshDistanceTree>();
  tree->bvh = build_bvh(mesh);
  const std::vector<std::int32_t>& slots = tree->bvh.slots;
  tree->leaves.resize(slots.size() / kWidth);
  tree->corners.resize(slots.size());
  parallel_ranges(0, static_cast<int>(slots.size()), 4096, [&](int first, int last) {
    for (int slot = first; slot < last; ++slot) {
      const auto [a, b, c] = mesh.triangles[slots[slot]];
      const Vec3 &pa = mesh.positions[a], &pb = mesh.positions[b], &pc = mesh.positions[c];
      tree->corners[slot] = {pa.x(), pa.y(), pa.z(), pb.x(), pb.y(), pb.z(), pc.x(), pc.y(), pc.z()};
      kernel::store_triangle(tree->leaves[slot / kWidth], slot % kWidth, tree->bvh.inside(pa), tree->bvh.inside(pb),
                             tree->bvh.inside(pc));
    }
  });
  tree_ = std::move(tree);
}

MeshDistance::~MeshDistance() = default;
MeshDistance::MeshDistance(MeshDistance&&) noexcept = default;
MeshDistance& MeshDistance::operator=(MeshDistance&&) noexcept = default;

std::vector<Nearest> MeshDistance::nearest(std::span<const Vec3> points) const {
  validate(points);
  std::vector<Nearest> out(points.size());
  const std::vector<std::int32_t> order = morton_order(points);
  const Block block = widest_block();
  parallel_ranges(0, static_cast<int>(points.size()), 4096, [&](int first, int last) {
    block(*tree_, points, std::span(order).subspan(first, last - first), out);
  });
  return out;
}

std::vector<double> distances(std::span<const Vec3> points, const Mesh& mesh) {
  const std::vector<Nearest> nearest = MeshDistance(mesh).nearest(points);
  std::vector<double> out(nearest.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = nearest[i].distance;
  return out;
}

}  // namespace carve
