#pragma once
#include <array>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "carve/carving/cells.h"

namespace carve {

/// What makes one choice of cells better than another, in sides of drawn stroke of a grid of 128 voxels along the
/// longest side. On other grids the costs are scaled so that the choice is the same.
struct CellWeights {
  double unexplained = 1;  // a depth jump where no stroke is
  double colour = 0.5;     // a depth jump where only a colour boundary is
  double open = 0.5;       // an open stroke without a depth jump
  double area = 0.003;     // a voxel face of surface
  double volume = 0.0001;  // a dropped voxel
  double buried = 0.0045;  // a dropped voxel, times the views that it lacks to be seen empty in two
  double silhouette = 8;   // a pixel whose ray meets no voxel any more
  double agreement = 0.1;  // a pixel of a cell that two views show in different colours
  double symmetry = 0.01;  // a voxel that differs from its mirror image
};

template <class Visitor>
void visit_fields(CellWeights& o, Visitor&& field) {
  field("unexplained", o.unexplained, 0.0, 1e3, "cost of a depth jump away from strokes, a grid pixel's side");
  field("colour", o.colour, 0.0, 1e3,
        "cost of a depth jump at a colour boundary without a stroke, a grid pixel's side");
  field("open", o.open, 0.0, 1e3, "cost of an open stroke without a depth jump, a grid pixel's side");
  field("area", o.area, 0.0, 1e3, "cost of surface, a voxel's face");
  field("volume", o.volume, 0.0, 1e3, "cost of carving, a voxel");
  field("buried", o.buried, 0.0, 1e3, "cost of carving what fewer than two views see empty, a voxel and missing view");
  field("silhouette", o.silhouette, 0.0, 1e6, "cost of a pixel whose ray meets no voxel any more");
  field("agreement", o.agreement, 0.0, 1e3, "cost of showing a cell to two views in different colours, a grid pixel");
  field("symmetry", o.symmetry, 0.0, 1e3,
        "cost of carving one of two cells that the drawings show as mirror images, a voxel");
}

/// Items by a key 0 .. count-1, those of one key together and in the order in which they came.
template <class T>
class Lists {
 public:
  Lists() = default;
  Lists(int count, std::span<const std::pair<int, T>> entries) : begin_(count + 1, 0), items_(entries.size()) {
    for (const auto& [key, item] : entries) ++begin_[key + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (const auto& [key, item] : entries) items_[next[key]++] = item;
  }
  std::span<const T> operator[](int key) const {
    return {items_.data() + begin_[key], items_.data() + begin_[key + 1]};
  }

 private:
  std::vector<int> begin_{0};
  std::vector<T> items_;
};

/// The energy of keeping or dropping each cell, as a sum over few distinct rays.
///
/// Rays that meet the same cells in the same order are one class; what two neighbouring pixels' classes pay for their
/// first hits is a table. Everything is in whole numbers (1/1024), so that steps add up exactly.
class CellProblem {
 public:
  static constexpr double kUnit = 1024;

  CellProblem(const Cells& cells, std::span<const RegionMap> views, const CellWeights& weights);

  int cells() const { return static_cast<int>(keep_.size()); }
  std::span<const std::uint8_t> keep() const { return keep_; }
  std::int64_t energy() const { return energy_; }
  std::int64_t misfit() const { return strokes_ + jumps_ + uncovered_; }  // of it, what the drawings ask for
  std::int64_t strokes() const { return strokes_; }                       // of that: strokes without a depth jump
  std::int64_t jumps() const { return jumps_; }                           // depth jumps away from strokes
  std::int64_t flip(std::span<const int> cells);                          // toggles them; the change of energy
  std::int64_t looks() const { return looks_; }                           // at pairs of rays, by all flips so far
  int mirror(int cell) const { return mirror_[cell]; }                    // its mirror image; -1: none, or itself
  /// Calls use(other) for the cells that share a face with `cell`; -1: the outside.
  template <class Use>
  void each_neighbour(int cell, Use&& use) const {
    for (const Contact& contact : contacts_[cell]) use(contact.other);
  }

 private:
  /// Rays of one view that meet the same cells in the same order.
  struct Class {
    int begin, length;  // in order_
    int view;
    std::int64_t pixels = 0;
    std::int64_t empty = 0;  // cost if none
  };
  struct Member {
    int ray, position;  // a class, and where on its rays the cell is
  };
  struct Pay {
    std::int32_t stroke = 0, jump = 0;
  };
  /// Two neighbouring pixels: where their rays' depths begin, and what lies between them.
  struct PixelPair {
    int a, b;
    Border border;
  };
  /// What pairs of neighbouring pixels pay.
  struct Costs {
    int longest = 0;                   // a depth jump in voxels that there cannot be
    std::vector<Pay> jumps;            // by Border and depth jump; the longest stands for a ray that meets nothing
    std::vector<std::int16_t> depths;  // along each pixel's ray; -1 ends it
    std::vector<PixelPair> pairs;
    std::vector<Pay> tables;
    /// If the pixels see the k-th and the l-th cell of their rays.
    Pay of(const PixelPair& pair, int k, int l) const {
      const int a = depths[pair.a + k], b = depths[pair.b + l];
      const int jump = (a | b) < 0 ? longest : std::abs(a - b);
      return jumps[static_cast<int>(pair.border) * (longest + 1) + jump];
    }
  };
  /// All neighbouring pixels of two classes.
  struct Group {
    int a, b;
    int begin = 0;    // in tables, or in pairs
    int columns = 0;  // of a table: a row for each first cell of a and none, a column for each of b; one if a is b
    int pairs = 0;    // where there is no table
    Pay value = {};
  };
  struct Contact {
    int other;  // -1: outside
    std::int64_t cost;
  };
  struct Sight {
    std::int64_t pixels = 0, open = 0;  // rays that meet the cell; those that meet nothing before it
  };
  static std::vector<Pay> jump_costs(int longest, double side, const CellWeights& weights);
  std::vector<int> add_classes(const Rays& rays, int view, std::int64_t empty);
  int first_of(const Class& c, int from) const;
  void move_first(int ray, int position);
  std::int64_t own_cost(int cell) const;
  void set_open(const Class& c, int from, int to, int sign);
  void tabulate(Group& group, std::span<const PixelPair> pairs, Costs& costs) const;
  void drop_free_groups();
  Pay value_of(const Group& g, int a, int b) const;

  std::vector<std::uint8_t> keep_;
  std::vector<int> order_;
  std::vector<Class> classes_;
  std::vector<int> first_;  // per class, position of the first kept cell; its length if none
  std::vector<int> was_;    // the same before a flip
  std::vector<Group> groups_;
  std::shared_ptr<const Costs> costs_;  // of all copies
  Lists<Member> members_;               // per cell
  Lists<int> groups_of_;                // per class
  Lists<Contact> contacts_;             // per cell
  std::vector<std::int64_t> volume_cost_, volume_;
  double buried_ = 0;
  std::vector<std::array<Sight, 6>> sight_;  // per cell and view
  std::vector<std::int64_t> own_now_;
  std::vector<std::array<std::int64_t, 15>> clash_;  // per cell and pair of views: cost of a pixel shown in both
  std::vector<std::uint8_t> clashes_;                // per cell: one of them is not 0
  std::vector<int> mirror_;
  double symmetry_ = 0;
  std::vector<int> touched_, touch_mark_;
  std::vector<int> changed_, class_mark_;
  int stamp_ = 0;
  std::int64_t energy_ = 0, strokes_ = 0, jumps_ = 0, uncovered_ = 0, looks_ = 0;
};

}  // namespace carve
