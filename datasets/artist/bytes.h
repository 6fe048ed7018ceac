#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "carve/core/error.h"

namespace carve::artist {

/// A binary file's bytes, read little-endian and never past their end.
class Bytes {
 public:
  Bytes(std::string_view data, std::string name) : data_(data), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& why) const { throw IoError(name_, why); }
  std::int64_t size() const { return static_cast<std::int64_t>(data_.size()); }

  /// `count` records of `size` bytes from `offset` on lie inside the file, or IoError naming `what`.
  void check(std::int64_t offset, std::int64_t count, std::int64_t size, const char* what) const {
    if (offset < 0 || count < 0 || offset > this->size() || count > (this->size() - offset) / size)
      fail("truncated, or its header lies: " + std::to_string(count) + " " + what + " at byte " +
           std::to_string(offset) + " of " + std::to_string(this->size()));
  }
  template <class T>
  T get(std::int64_t offset) const {
    check(offset, 1, sizeof(T), "numbers");
    T value;
    std::memcpy(&value, data_.data() + offset, sizeof(T));
    return value;
  }
  /// Up to `length` characters, ending before the first NUL.
  std::string text(std::int64_t offset, std::int64_t length) const {
    check(offset, length, 1, "characters");
    const std::string_view all = data_.substr(offset, length);
    return std::string(all.substr(0, std::min(all.find('\0'), all.size())));
  }

 private:
  static_assert(std::endian::native == std::endian::little, "Bytes reads in the machine's order");
  std::string_view data_;
  std::string name_;
};

}  // namespace carve::artist
