#pragma once
#include <cstddef>
#include <cstdint>

namespace carve {

/// Numbers as if drawn at random, the same everywhere: splitmix64 \cite steele_2014.
inline constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;  // its state's step

/// The finaliser: one to one, every bit of x spread over all.
constexpr std::uint64_t spread(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A number for every number, whoever asks first.
constexpr std::uint64_t mixed(std::uint64_t x) { return spread(x + kGolden); }

/// The upper bits as a number in [0, 1).
constexpr double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// One stream of them.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed = 1) : state_(seed) {}
  constexpr std::uint64_t operator()() { return spread(state_ += kGolden); }
  constexpr std::size_t below(std::size_t n) { return (*this)() % n; }
  constexpr double unit() { return carve::unit((*this)()); }

 private:
  std::uint64_t state_;
};

}  // namespace carve
