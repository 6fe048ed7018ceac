#include "carve/hull/strip_clip.h"

#include <algorithm>
#include <stdexcept>

namespace carve::hull {
namespace {

int sign(Int128 x) { return (x > 0) - (x < 0); }

StripPoint intersection(const StripLine& p, const StripLine& q) {
  std::int64_t d = p.a * q.b - q.a * p.b, s = p.b * q.c - q.b * p.c;
  Int128 w = static_cast<Int128>(p.c) * q.a - static_cast<Int128>(q.c) * p.a;
  return d > 0 ? StripPoint{s, w, d} : StripPoint{-s, -w, -d};
}

bool passes(const StripLine& line, const StripPoint& p) {
  return static_cast<Int128>(line.a) * p.s + line.b * p.w + static_cast<Int128>(line.c) * p.d == 0;
}

bool same_w(const StripPoint& p, const StripPoint& q) { return p.w * q.d == q.w * p.d; }
bool below(const StripPoint& p, const StripPoint& q) { return p.w * q.d < q.w * p.d; }

}  // namespace

int compare(const Fraction& p, const Fraction& q) {
  return sign(static_cast<Int128>(p.n) * q.d - static_cast<Int128>(q.n) * p.d);
}

void StripClipper::clear() {
  sides_.clear();
  items_.clear();
  crossings_.clear();
  events_.clear();
  active_.clear();
  border_.clear();
  border_before_.clear();
  pieces_.clear();
}

void StripClipper::add_side(int polygon, StripLine line, Fraction low, Fraction high) {
  if (line.b < 0) line = {-line.a, -line.b, -line.c};
  const int side = static_cast<int>(sides_.size());
  sides_.push_back({line, polygon, low, high});
  items_.push_back({low, Kind::low, side});
  items_.push_back({high, Kind::high, side});
}

void StripClipper::find_crossings() {
  const auto middle = std::partition_point(sides_.begin(), sides_.end(), [](const Side& s) { return s.polygon == 0; });
  for (auto p = sides_.begin(); p != middle; ++p)
    for (auto q = middle; q != sides_.end(); ++q) {
      if (p->line.a * q->line.b == q->line.a * p->line.b) continue;
      const StripPoint at = intersection(p->line, q->line);
      const Fraction s{at.s, at.d};
      if (compare(s, p->low) <= 0 || compare(s, q->low) <= 0) continue;
      if (compare(s, p->high) >= 0 || compare(s, q->high) >= 0) continue;
      items_.push_back({s, Kind::crossing, static_cast<int>(crossings_.size())});
      crossings_.push_back({{static_cast<int>(p - sides_.begin()), static_cast<int>(q - sides_.begin())}, at});
    }
}

void StripClipper::find_events() {
  std::sort(items_.begin(), items_.end(), [](const Item& p, const Item& q) {
    const int order = compare(p.s, q.s);
    return order != 0 ? order < 0 : std::pair(p.kind, p.index) < std::pair(q.kind, q.index);
  });
  for (int i = 0; i < static_cast<int>(items_.size()); ++i) {
    const Item& item = items_[i];
    if (events_.empty() || compare(events_.back().s, item.s) != 0) {
      if (!events_.empty()) events_.back().last = i;
      events_.push_back({item.s, false, item.kind != Kind::crossing, i, i});
    }
    if (item.kind == Kind::jump) events_.back().jump = true;
  }
  if (!events_.empty()) events_.back().last = static_cast<int>(items_.size());
}

int StripClipper::compare_at(const Side& p, const Side& q, const Fraction& s) const {
  const auto fall = [&](const StripLine& l) { return static_cast<Int128>(l.a) * s.n + static_cast<Int128>(l.c) * s.d; };
  return sign(fall(q.line) * p.line.b - fall(p.line) * q.line.b);  // w = -fall / (b d)
}

void StripClipper::enter_and_leave(int event) {
  std::erase_if(active_, [&](int side) { return compare(sides_[side].high, events_[event].s) <= 0; });
  for (int i = events_[event].first; i < events_[event].last; ++i)
    if (items_[i].kind == Kind::low) active_.push_back(items_[i].index);
}

void StripClipper::sort_active(int event) {
  const auto above = [&](int p, int q) {
    const int order = compare_at(sides_[p], sides_[q], events_[event].s);
    return (order != 0 ? order : compare_at(sides_[p], sides_[q], events_[event + 1].s)) > 0;
  };
  for (std::size_t i = 1; i < active_.size(); ++i) {  // nearly sorted: insertion
    const int side = active_[i];
    std::size_t j = i;
    for (; j > 0 && above(active_[j - 1], side); --j) active_[j] = active_[j - 1];
    active_[j] = side;
  }
}

// Where a piece on a side starts or ends at an event: at an end of a side or a jump, or where two sides cross.
StripPoint StripClipper::point_at(int side, int event) const {
  const Event& e = events_[event];
  const StripLine& line = sides_[side].line;
  if (e.simple) return intersection(line, {e.s.d, 0, -e.s.n});
  for (int i = e.first; i < e.last; ++i)
    if (const StripPoint& at = crossings_[items_[i].index].at; passes(line, at)) return at;
  throw std::logic_error("strips: a side ends where nothing meets it");
}

void StripClipper::close(Side& side) {
  if (side.last < 0) return;
  const StripPoint end = point_at(static_cast<int>(&side - sides_.data()), side.last);
  if (side.leftward)
    pieces_.emplace_back(end, side.start);
  else
    pieces_.emplace_back(side.start, end);
  side.last = -1;
}

void StripClipper::emit_side(int index, int event, bool leftward) {
  Side& side = sides_[index];
  if (side.last != event || side.leftward != leftward) {
    close(side);
    side.start = point_at(index, event);
    side.leftward = leftward;
  }
  side.last = event + 1;
}

// Reads the inside off the sides between `event` and the next one.
void StripClipper::scan(int event) {
  border_.clear();
  bool in[2] = {false, false};
  for (std::size_t i = 0; i < active_.size();) {
    const bool before = in[0] && in[1];
    std::size_t end = i;
    do in[sides_[active_[end++]].polygon] ^= true;
    while (end < active_.size() && compare_at(sides_[active_[i]], sides_[active_[end]], events_[event].s) == 0 &&
           compare_at(sides_[active_[i]], sides_[active_[end]], events_[event + 1].s) == 0);
    if (const bool after = in[0] && in[1]; after != before) {
      int side = active_[i];
      for (std::size_t k = i; k < end; ++k)  // the one whose piece goes on
        if (sides_[active_[k]].last == event && sides_[active_[k]].leftward == before) side = active_[k];
      emit_side(side, event, before);
      border_.push_back(side);
    } else if (before && end - i == 2) {  // the inside touches itself: a seam
      emit_side(active_[i], event, true);
      emit_side(active_[i + 1], event, false);
    }
    i = end;
  }
}

// Along an event's line, where the inside to its left and to its right differ.
void StripClipper::emit_jump(int event, const std::vector<int>& left, const std::vector<int>& right) {
  std::size_t l = 0, r = 0;
  StripPoint from{};
  while (l < left.size() || r < right.size()) {
    const int state = static_cast<int>(l % 2) - static_cast<int>(r % 2);
    const bool take_left =
        r == right.size() || (l < left.size() && !below(point_at(right[r], event), point_at(left[l], event)));
    const StripPoint to = point_at(take_left ? left[l] : right[r], event);
    if (state != 0 && !same_w(from, to)) {
      if (state > 0)
        pieces_.emplace_back(from, to);
      else
        pieces_.emplace_back(to, from);
    }
    from = to;
    ++(take_left ? l : r);
  }
}

void StripClipper::find_pieces() {
  add_jump({0, 1});
  add_jump({1, 1});
  find_crossings();
  find_events();
  for (int event = 0; event < static_cast<int>(events_.size()); ++event) {
    enter_and_leave(event);
    border_before_.swap(border_);
    border_.clear();
    if (event + 1 < static_cast<int>(events_.size())) {
      sort_active(event);
      scan(event);
    }
    if (events_[event].jump) emit_jump(event, border_before_, border_);
  }
  for (Side& side : sides_) close(side);
}

}  // namespace carve::hull
