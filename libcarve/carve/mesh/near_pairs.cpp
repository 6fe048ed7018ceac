#include "carve/mesh/near_pairs.h"

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "carve/core/parallel.h"
#include "carve/mesh/triangle_tests.h"

namespace carve {
namespace {

constexpr double kLargest = 1e100;  // products of three stay finite
constexpr float kSlack = 1e-6f;     // more than a float's last place in [-1, 1]
constexpr std::size_t kLeaf = 32;   // boxes that are compared each with each
constexpr std::size_t kTask = 4096;
constexpr double kSplitGain = 0.8;       // share of the boxes that one side of a cut may keep
constexpr std::uint8_t kPlain = 1 << 6;  // of Box::is, above the six directions

using Pairs = std::vector<std::pair<int, int>>;

/// Each item once, in rising order.
template <class T>
void sort_once(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

struct Box {
  std::array<float, 3> low, high;
  int triangle;
  bool moved;
  std::uint8_t is;  // bit 2 k: the triangle faces along axis k; 2 k + 1: against it; kPlain: its vertices are plain
};

/// The boxes that reach into a region.
struct Part {
  std::vector<Box> boxes;
  std::array<float, 3> low, high;
};

/// The ends of a part's boxes one after another, for loops that compilers turn into SIMD instructions.
struct Lanes {
  std::array<std::vector<float>, 3> low, high;
  std::vector<int> hits, found;

  void fill(const std::vector<Box>& boxes) {
    for (int k = 0; k < 3; ++k) {
      low[k].resize(boxes.size()), high[k].resize(boxes.size());
      for (std::size_t i = 0; i < boxes.size(); ++i) low[k][i] = boxes[i].low[k], high[k][i] = boxes[i].high[k];
    }
    hits.resize(boxes.size()), found.resize(boxes.size());
  }
  /// Which of the first `count` boxes have points in common with `box`.
  std::span<const int> overlapping(const Box& box, int count) {
    const float *const x = low[0].data(), *const y = low[1].data(), *const z = low[2].data();
    const float *const u = high[0].data(), *const v = high[1].data(), *const w = high[2].data();
    const auto [a, b, c] = box.low;
    const auto [d, e, f] = box.high;
    int* const hit = hits.data();
    for (int j = 0; j < count; ++j)
      hit[j] = (x[j] <= d) & (u[j] >= a) & (y[j] <= e) & (v[j] >= b) & (z[j] <= f) & (w[j] >= c);
    int size = 0;
    for (int j = 0; j < count; ++j) found[size] = j, size += hit[j];
    return {found.data(), static_cast<std::size_t>(size)};
  }
};

class Finder {
 public:
  Finder(const Mesh& mesh, const VertexTriangles& around, std::span<const std::uint8_t> moved, double blur)
      : mesh_(mesh), moved_(moved), blur_(blur), plain_(mesh.positions.size()) {
    // Without a moved triangle around it a vertex only helps to find larger sheets.
    const bool few = !moved.empty() && std::ranges::count(moved, 0) > 7 * std::ssize(moved) / 8;
    parallel_ranges(0, static_cast<int>(plain_.size()), 1 << 12, [&](int first, int last) {
      for (int v = first; v < last; ++v)
        plain_[v] = (!few || std::ranges::any_of(around[v], [&](int t) { return has_moved(t); })) &&
                    is_plain(mesh, around[v], v, blur);
    });
  }

  Pairs pairs() {
    std::vector<Part> tasks;
    divide(whole(), kTask, [&](Part&& part) { tasks.push_back(std::move(part)); });
    Pairs all;
    std::mutex lock;
    parallel_ranges(0, static_cast<int>(tasks.size()), 1, [&](int first, int last) {
      Pairs found;
      Lanes lanes;
      for (int i = first; i < last; ++i)
        divide(std::move(tasks[i]), kLeaf, [&](Part&& part) { compare(part, lanes, found); });
      const std::scoped_lock hold(lock);
      all.insert(all.end(), found.begin(), found.end());
    });
    sort_once(all);  // boxes that reach into several parts
    return all;
  }

 private:
  bool has_moved(int triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return moved_.empty() || moved_[a] || moved_[b] || moved_[c];
  }
  /// In the frame of the boxes, where the mesh lies in [-1, 1]^3.
  Vec3 in_box(const Vec3& p) const { return (p - centre_) * scale_; }

  Part whole() {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Triangle& t : mesh_.triangles)
      for (const int v : t) low = low.cwiseMin(mesh_.positions[v]), high = high.cwiseMax(mesh_.positions[v]);
    if (!mesh_.triangles.empty() && !(std::max(-low.minCoeff(), high.maxCoeff()) <= kLargest))
      throw std::invalid_argument("mesh.positions must be within 1e100");
    centre_ = (low + high) / 2;
    const double half = (high - low).maxCoeff() / 2;
    scale_ = half > 1e-100 ? 1 / half : 1;
    const auto slack = kSlack + static_cast<float>(blur_ * scale_);
    Part part;
    part.low.fill(-2), part.high.fill(2);
    part.boxes.resize(mesh_.triangles.size());
    parallel_ranges(0, static_cast<int>(part.boxes.size()), 1 << 12, [&](int first, int last) {
      for (int t = first; t < last; ++t) {
        const auto& [a, b, c] = mesh_.triangles[t];
        const Vec3 &p = mesh_.positions[a], &q = mesh_.positions[b], &r = mesh_.positions[c];
        const Vec3 least = in_box(p.cwiseMin(q).cwiseMin(r));
        const Vec3 most = in_box(p.cwiseMax(q).cwiseMax(r));
        Box& box = part.boxes[t];
        for (int k = 0; k < 3; ++k) {
          box.low[k] = static_cast<float>(least[k]) - slack;
          box.high[k] = static_cast<float>(most[k]) + slack;
        }
        box.triangle = t, box.moved = has_moved(t);
        box.is = plain_[a] && plain_[b] && plain_[c] ? kPlain : 0;
        const Vec3i facing = faces(p, q, r, blur_);
        for (int k = 0; k < 3; ++k) box.is |= (facing[k] > 0) << 2 * k | (facing[k] < 0) << (2 * k + 1);
      }
    });
    return part;
  }

  /// Cuts a part into such of at most `most` boxes, where cuts separate. Those without a moved triangle, and those
  /// that are one sheet, are dropped.
  template <class Use>
  void divide(Part&& part, std::size_t most, const Use& use) const {
    std::array<double, 3> mean{}, square{}, spread;
    bool moved = false;
    std::uint8_t all = 0xff;
    for (const Box& box : part.boxes) {
      moved |= box.moved, all &= box.is;
      for (int k = 0; k < 3; ++k) {
        const double middle = box.low[k] + box.high[k];
        mean[k] += middle, square[k] += middle * middle;
      }
    }
    if (!moved) return;
    int along = -1;  // an axis that all triangles face
    if (all & kPlain)
      for (int bit = 0; bit < 6; ++bit) {
        if (!(all >> bit & 1)) continue;
        along = bit / 2;
        if (is_sheet(part, along)) return;
      }
    if (part.boxes.size() <= most) return use(std::move(part));
    const auto count = static_cast<double>(part.boxes.size());
    for (int k = 0; k < 3; ++k) mean[k] /= count, spread[k] = square[k] / count - mean[k] * mean[k];
    if (along >= 0) spread[along] = 0;  // a sheet should reach the region's sides, not its ends
    std::array<int, 3> axes{0, 1, 2};
    std::ranges::sort(axes, [&](int a, int b) { return spread[a] > spread[b]; });
    for (const int axis : axes) {
      auto [left, right] = halves(part, axis, static_cast<float>(mean[axis] / 2));
      if (static_cast<double>(std::max(left.boxes.size(), right.boxes.size())) > kSplitGain * count) continue;
      part = {};
      divide(std::move(left), most, use);
      divide(std::move(right), most, use);
      return;
    }
    use(std::move(part));
  }

  /// Whether every line along an axis meets what lies in a part's region at most once, so that nothing there meets. The
  /// triangles all face to the same side and have plain vertices, so the number of times is the same for all lines if
  /// none leaves the region by its ends: one line tells.
  bool is_sheet(const Part& part, int axis) const {
    const int right = (axis + 1) % 3, up = (axis + 2) % 3;
    for (const Box& box : part.boxes)
      if (box.low[axis] <= part.low[axis] || box.high[axis] >= part.high[axis]) return false;
    const auto within = [&](const Vec3& p, const auto& low, const auto& high) {
      return p[right] > low[right] && p[right] < high[right] && p[up] > low[up] && p[up] < high[up];
    };
    for (const Box& box : part.boxes) {
      const auto& [a, b, c] = mesh_.triangles[box.triangle];
      const Vec3 point = (mesh_.positions[a] + mesh_.positions[b] + mesh_.positions[c]) / 3;
      const Vec3 place = in_box(point);
      if (!within(place, part.low, part.high)) continue;
      int times = 0;
      for (const Box& other : part.boxes)
        if (within(place, other.low, other.high)) times += crossings(mesh_, other.triangle, point, axis, blur_);
      return times == 1;
    }
    return false;
  }

  static std::pair<Part, Part> halves(const Part& part, int axis, float cut) {
    Part left{{}, part.low, part.high}, right = left;
    left.high[axis] = right.low[axis] = cut;
    left.boxes.reserve(part.boxes.size() * 5 / 8), right.boxes.reserve(part.boxes.size() * 5 / 8);
    for (const Box& box : part.boxes) {
      if (box.low[axis] < cut) left.boxes.push_back(box);
      if (box.high[axis] >= cut) right.boxes.push_back(box);
    }
    return {std::move(left), std::move(right)};
  }

  void compare(const Part& part, Lanes& lanes, Pairs& found) const {
    lanes.fill(part.boxes);
    for (int i = 1; i < static_cast<int>(part.boxes.size()); ++i) {
      const Box& a = part.boxes[i];
      for (const int j : lanes.overlapping(a, i)) {
        const Box& b = part.boxes[j];
        if ((a.moved | b.moved) & !side_by_side(a.triangle, b.triangle) &&
            !are_apart(mesh_, a.triangle, b.triangle, blur_))
          found.push_back(std::minmax(a.triangle, b.triangle));
      }
    }
  }

  /// Whether they share a vertex that proves that they meet only in what they share.
  bool side_by_side(int i, int j) const {
    const Triangle &a = mesh_.triangles[i], &b = mesh_.triangles[j];
    bool plain = false;  // without branches, which nothing could foretell
    for (const int v : a) plain |= (int{v == b[0]} | int{v == b[1]} | int{v == b[2]}) & plain_[v];
    return plain;
  }

  const Mesh& mesh_;
  const std::span<const std::uint8_t> moved_;
  const double blur_;
  std::vector<std::uint8_t> plain_;  // bytes: written by several threads
  Vec3 centre_ = Vec3::Zero();
  double scale_ = 1;
};

}  // namespace

Pairs near_pairs(const Mesh& mesh, const VertexTriangles& around, std::span<const std::uint8_t> moved, double blur) {
  return Finder(mesh, around, moved, blur).pairs();
}

Pairs near_pairs(const Mesh& mesh, const VertexTriangles& around, const TriangleGrid& grid,
                 std::span<const int> vertices, double blur) {
  std::vector<int> moved;
  for (const int v : vertices) moved.insert(moved.end(), around[v].begin(), around[v].end());
  sort_once(moved);

  std::unordered_map<int, bool> plain;  // of the vertices asked for
  const auto side_by_side = [&](const Triangle& a, const Triangle& b) {
    return std::ranges::any_of(a, [&](int v) {
      if (v != b[0] && v != b[1] && v != b[2]) return false;
      const auto [found, fresh] = plain.try_emplace(v, false);
      if (fresh) found->second = is_plain(mesh, around[v], v, blur);
      return found->second;
    });
  };
  const auto low = [&](const Triangle& t) {
    return Vec3(mesh.positions[t[0]].cwiseMin(mesh.positions[t[1]]).cwiseMin(mesh.positions[t[2]]));
  };
  const auto high = [&](const Triangle& t) {
    return Vec3(mesh.positions[t[0]].cwiseMax(mesh.positions[t[1]]).cwiseMax(mesh.positions[t[2]]));
  };
  Pairs found;
  for (const int t : moved) {
    const Triangle& a = mesh.triangles[t];
    const Vec3 least = low(a).array() - 2 * blur, most = high(a).array() + 2 * blur;
    std::vector<int> others;
    grid.each_near(least, most, [&](int other) { others.push_back(other); });
    sort_once(others);
    for (const int other : others) {
      const Triangle& b = mesh.triangles[other];
      if (other == t || (low(b).array() > most.array()).any() || (high(b).array() < least.array()).any()) continue;
      if (!side_by_side(a, b) && !are_apart(mesh, t, other, blur)) found.push_back(std::minmax(t, other));
    }
  }
  sort_once(found);
  return found;
}

}  // namespace carve
