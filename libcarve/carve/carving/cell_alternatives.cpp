#include "carve/carving/cell_alternatives.h"

#include <algorithm>
#include <string>
#include <unordered_set>

namespace carve {
namespace {

class Enumeration {
 public:
  Enumeration(CellProblem& problem, std::int64_t limit)
      : problem_(problem), limit_(limit), most_(problem.misfit()), differs_(problem.cells(), 0) {
    for (const std::uint8_t keep : problem.keep()) state_.push_back(static_cast<char>(keep));
  }

  Alternatives run() {
    for (int c = 0; c < problem_.cells(); ++c) {
      differs_[c] = fits_with(c);
      flip(c);
    }
    seen_.insert(state_);
    walk();
    Alternatives out{static_cast<std::int64_t>(seen_.size()), !stopped_, {}};
    for (int c = 0; c < problem_.cells(); ++c)
      if (differs_[c]) out.cells.push_back(c);
    return out;
  }

 private:
  void flip(int cell) {
    problem_.flip(std::span(&cell, 1));
    state_[cell] ^= 1;
  }
  bool fits_with(int cell) {
    flip(cell);
    return problem_.misfit() <= most_;
  }

  /// Depth first, each choice once; the way back undoes what was changed.
  void walk() {
    std::vector<int> changed, next{0};
    std::int64_t looked_at = 0;
    while (true) {
      if (next.back() == problem_.cells()) {
        next.pop_back();
        if (changed.empty()) return;
        flip(changed.back());
        changed.pop_back();
        continue;
      }
      const int c = next.back()++;
      if (stopped_) {
        next.back() = problem_.cells();
        continue;
      }
      stopped_ = ++looked_at >= limit_;
      if (fits_with(c) && seen_.insert(state_).second) {
        differs_[c] = 1;
        changed.push_back(c);
        next.push_back(0);
      } else {
        flip(c);
      }
    }
  }

  CellProblem& problem_;
  std::int64_t limit_, most_;
  std::vector<std::uint8_t> differs_;
  std::string state_;
  std::unordered_set<std::string> seen_;
  bool stopped_ = false;
};

}  // namespace

Alternatives find_alternatives(CellProblem& problem, std::int64_t limit) { return Enumeration(problem, limit).run(); }

}  // namespace carve
