#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace carve::experiments {

/// 128 bits of everything added, as 32 hex digits; the same on every machine.
class Hash {
 public:
  Hash();
  ~Hash();
  Hash(const Hash&) = delete;
  Hash& operator=(const Hash&) = delete;
  Hash& add(std::string_view bytes);  // its length too, so that "ab","c" is not "a","bc"
  template <class T>
  Hash& add_values(const T* values, std::size_t count) {
    return add({reinterpret_cast<const char*>(values), count * sizeof(T)});
  }
  std::string hex() const;

 private:
  void* state_;
};

/// Of the running program's own bytes: the version of the code, whatever git says of it.
const std::string& program_hash();

}  // namespace carve::experiments
