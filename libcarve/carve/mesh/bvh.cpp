#include "carve/mesh/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>

namespace carve {
namespace {

constexpr double kLargest = 1e100;  // squares of squares stay finite
constexpr int kBins = 32;
constexpr int kDeepest = 24;  // from here on halves, so that a traversal's stack is bounded

struct Box3 {
  std::array<float, 3> low, high;
  Box3() {
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
  }
  void add(const Box3& other) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
  float area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
  }
};

struct Item {
  Box3 box;
  std::int32_t triangle;
  float centre(int axis) const { return box.low[axis] + box.high[axis]; }
};

using Items = std::span<Item>;

struct Range {
  Items items;
  Box3 box;
};

Range range_of(Items items) {
  Range range{items, {}};
  for (const Item& item : items) range.box.add(item.box);
  return range;
}

// Nearest float at or beyond x; ends of boxes are rounded outwards with it.
float down(double x) {
  const float f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float up(double x) { return -down(-x); }

void validate(const Mesh& mesh) {
  if (mesh.triangles.empty()) throw std::invalid_argument("a reference mesh must have at least one triangle, got none");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (!(mesh.positions[i].cwiseAbs().maxCoeff() <= kLargest))
      throw std::invalid_argument("vertex " + std::to_string(i) + ": coordinates must be finite and within 1e100");
  const int count = static_cast<int>(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const int corner : mesh.triangles[i])
      if (corner < 0 || corner >= count)
        throw std::invalid_argument("triangle " + std::to_string(i) + ": indices must be in [0, " +
                                    std::to_string(count - 1) + "], got " + std::to_string(corner));
}

class Builder {
 public:
  explicit Builder(const Mesh& mesh) {
    validate(mesh);
    choose_frame(mesh);
    items_.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < items_.size(); ++t) {
      items_[t].triangle = static_cast<std::int32_t>(t);
      for (const int corner : mesh.triangles[t]) {
        const Vec3 p = bvh_.inside(mesh.positions[corner]);
        for (int k = 0; k < 3; ++k) {
          // The subtraction and product above are rounded too: one double step outwards covers them.
          const double slack = 4 * std::numeric_limits<double>::epsilon();
          items_[t].box.low[k] = std::min(items_[t].box.low[k], down(p[k] - slack));
          items_[t].box.high[k] = std::max(items_[t].box.high[k], up(p[k] + slack));
        }
      }
    }
  }

  Bvh build() && {
    add_node(range_of(items_), 0);
    return std::move(bvh_);
  }

 private:
  void choose_frame(const Mesh& mesh) {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Triangle& triangle : mesh.triangles)
      for (const int corner : triangle) {
        low = low.cwiseMin(mesh.positions[corner]);
        high = high.cwiseMax(mesh.positions[corner]);
      }
    bvh_.centre = (low + high) / 2;
    const double half = (high - low).maxCoeff() / 2;
    bvh_.scale = half > 1e-100 ? 1 / half : 1;
  }

  // Children: the widest range is split until there are eight or none holds more than a leaf.
  std::int32_t add_node(const Range& whole, int depth) {
    std::vector<Range> children{whole};
    while (children.size() < Bvh::kWidth) {
      auto widest = children.end();
      for (auto child = children.begin(); child != children.end(); ++child)
        if (child->items.size() > Bvh::kWidth && (widest == children.end() || child->box.area() > widest->box.area()))
          widest = child;
      if (widest == children.end()) break;
      const Items items = widest->items;
      const std::size_t left = depth < kDeepest ? split(*widest) : halve(*widest);
      *widest = range_of(items.first(left));
      children.push_back(range_of(items.subspan(left)));
    }
    const auto index = static_cast<std::int32_t>(bvh_.nodes.size());
    bvh_.nodes.emplace_back();
    BvhNode node;
    for (int i = 0; i < Bvh::kWidth; ++i) {
      const bool used = i < static_cast<int>(children.size());
      const Box3 box = used ? children[i].box : Box3();
      for (int k = 0; k < 3; ++k) node.low[k][i] = box.low[k], node.high[k][i] = box.high[k];
      node.child[i] = !used                                     ? 0
                      : children[i].items.size() <= Bvh::kWidth ? add_leaf(children[i].items)
                                                                : add_node(children[i], depth + 1);
    }
    bvh_.nodes[index] = node;
    return index;
  }

  std::int32_t add_leaf(Items items) {
    const auto leaf = static_cast<std::int32_t>(bvh_.slots.size() / Bvh::kWidth);
    for (std::size_t i = 0; i < Bvh::kWidth; ++i) bvh_.slots.push_back(items[std::min(i, items.size() - 1)].triangle);
    return ~leaf;
  }

  static int longest_axis(Items items, float& low, float& high) {
    std::array<float, 3> least, most;
    least.fill(std::numeric_limits<float>::infinity());
    most.fill(-std::numeric_limits<float>::infinity());
    for (const Item& item : items)
      for (int k = 0; k < 3; ++k) {
        least[k] = std::min(least[k], item.centre(k));
        most[k] = std::max(most[k], item.centre(k));
      }
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (most[k] - least[k] > most[axis] - least[axis]) axis = k;
    low = least[axis], high = most[axis];
    return axis;
  }

  static std::size_t halve(const Range& range) {
    float low, high;
    const int axis = longest_axis(range.items, low, high);
    const std::size_t middle = range.items.size() / 2;
    std::nth_element(range.items.begin(), range.items.begin() + middle, range.items.end(),
                     [axis](const Item& a, const Item& b) {
                       return std::pair(a.centre(axis), a.triangle) < std::pair(b.centre(axis), b.triangle);
                     });
    return middle;
  }

  // The cheapest of kBins - 1 planes; ranges of a few leaves are cut where leaves come out full.
  static std::size_t split(const Range& range) {
    if (range.items.size() <= 8 * Bvh::kWidth) return split_few(range);
    float low, high;
    const int axis = longest_axis(range.items, low, high);
    if (!(high > low)) return halve(range);
    const float bins_per_unit = kBins / (high - low);
    const auto bin_of = [&](const Item& item) {
      return std::min(kBins - 1, static_cast<int>((item.centre(axis) - low) * bins_per_unit));
    };
    std::array<Box3, kBins> boxes;
    std::array<int, kBins> counts{};
    for (const Item& item : range.items) {
      const int bin = bin_of(item);
      boxes[bin].add(item.box);
      ++counts[bin];
    }
    std::array<float, kBins> right_cost{};
    Box3 box;
    int count = 0;
    for (int i = kBins - 1; i > 0; --i) {
      box.add(boxes[i]);
      count += counts[i];
      right_cost[i] = count ? box.area() * count : 0;
    }
    box = {};
    count = 0;
    int best = -1;
    float best_cost = std::numeric_limits<float>::infinity();
    for (int i = 0; i + 1 < kBins; ++i) {
      box.add(boxes[i]);
      count += counts[i];
      if (count == 0 || count == static_cast<int>(range.items.size())) continue;
      const float cost = box.area() * count + right_cost[i + 1];
      if (cost < best_cost) best_cost = cost, best = i;
    }
    if (best < 0) return halve(range);
    const auto middle =
        std::partition(range.items.begin(), range.items.end(), [&](const Item& item) { return bin_of(item) <= best; });
    return middle - range.items.begin();
  }

  /// Leaves that so many triangles fill: what it costs to enter their box.
  static float leaves(std::size_t triangles) {
    const std::size_t count = (triangles + Bvh::kWidth - 1) / Bvh::kWidth;
    return static_cast<float>(count);
  }

  static std::size_t split_few(const Range& range) {
    float low, high;
    const int axis = longest_axis(range.items, low, high);
    std::sort(range.items.begin(), range.items.end(), [axis](const Item& a, const Item& b) {
      return std::pair(a.centre(axis), a.triangle) < std::pair(b.centre(axis), b.triangle);
    });
    const std::size_t count = range.items.size();
    std::array<float, 8 * Bvh::kWidth> right{};
    Box3 box;
    for (std::size_t i = count; i-- > 1;) {
      box.add(range.items[i].box);
      right[i] = box.area() * leaves(count - i);
    }
    box = {};
    std::size_t best = 0;
    float best_cost = std::numeric_limits<float>::infinity();
    for (std::size_t i = 1; i < count; ++i) {
      box.add(range.items[i - 1].box);
      const float cost = box.area() * leaves(i) + right[i];
      if (cost < best_cost) best_cost = cost, best = i;
    }
    return best ? best : count / 2;
  }

  Bvh bvh_;
  std::vector<Item> items_;
};

}  // namespace

Bvh build_bvh(const Mesh& mesh) { return Builder(mesh).build(); }

}  // namespace carve
