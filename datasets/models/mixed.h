#pragma once
#include <cstdint>

namespace carve {

/// A number for every number, as if drawn at random, whoever asks first: splitmix64's finaliser \cite steele_2014.
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace carve
