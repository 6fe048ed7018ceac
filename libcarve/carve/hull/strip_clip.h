#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "carve/hull/exact_point.h"

namespace carve::hull {

/// The line a s + b w + c = 0 of a strip's plane, s across the strip (0..1) and w along the view's axis.
/// |a|, |c| < 2^34, |b| < 2^18.
struct StripLine {
  std::int64_t a, b, c;
};

struct Fraction {
  std::int64_t n, d;  // d > 0
};
int compare(const Fraction& p, const Fraction& q);

/// The point (s, w) / d.
struct StripPoint {
  std::int64_t s;
  Int128 w;
  std::int64_t d;  // > 0
};

/// Intersection of two polygons in a strip 0 <= s <= 1, exact. The polygons are given by the parts of their sides that
/// lie in the strip; a side along w is only told by its place. Sides of one polygon do not cross.
///
/// A sweep over s: between neighbouring events (ends and crossings) sides are ordered by w, or coincide, so the inside
/// is read off by parity, and sides that coincide are passed together.
class StripClipper {
 public:
  void clear();
  /// A part of a side of polygon 0 or 1, from s = low to s = high (within [0, 1], low < high).
  void add_side(int polygon, StripLine line, Fraction low, Fraction high);
  void add_jump(Fraction s) { items_.push_back({s, Kind::jump, -1}); }

  /// Calls emit(from, to) for each side of the intersection, inside on the left.
  template <class Emit>
  void run(Emit&& emit) {
    find_pieces();
    for (const auto& [from, to] : pieces_) emit(from, to);
  }

 private:
  enum class Kind : std::uint8_t { low, high, jump, crossing };
  struct Item {
    Fraction s;
    Kind kind;
    int index;  // of a side or crossing
  };
  struct Side {
    StripLine line;
    int polygon;
    Fraction low, high;
    int last = -1;          // the event up to which an open piece reaches; -1: none is open
    bool leftward = false;  // the open piece's direction
    StripPoint start = {};
  };
  struct Crossing {
    int side[2];
    StripPoint at;
  };
  struct Event {
    Fraction s;
    bool jump = false, simple = false;  // simple: s is the end of a side or a jump, so a small fraction
    int first = 0, last = 0;            // its items
  };

  void find_crossings();
  void find_events();
  void find_pieces();
  void enter_and_leave(int event);
  void sort_active(int event);
  void scan(int event);
  void emit_side(int side, int event, bool leftward);
  void close(Side& side);
  void emit_jump(int event, const std::vector<int>& left, const std::vector<int>& right);
  int compare_at(const Side& p, const Side& q, const Fraction& s) const;
  StripPoint point_at(int side, int event) const;

  std::vector<Side> sides_;
  std::vector<Item> items_;
  std::vector<Crossing> crossings_;
  std::vector<Event> events_;
  std::vector<int> active_, border_, border_before_;
  std::vector<std::pair<StripPoint, StripPoint>> pieces_;
};

}  // namespace carve::hull
