#include "eval/spill.h"

#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "carve/core/error.h"

namespace carve {
namespace {

[[noreturn]] void fail(const std::string& what, IoError::Side side) {
  std::error_code none;
  throw IoError(std::filesystem::temp_directory_path(none).string(), what + ": " + std::strerror(errno), side);
}

}  // namespace

Spill::Spill() {
  std::error_code none;
  std::string name = (std::filesystem::temp_directory_path(none) / "carve.XXXXXX").string();
  file_ = mkstemp(name.data());
  if (file_ < 0) fail("cannot make a temporary file", IoError::Side::output);
  unlink(name.c_str());
}

Spill::~Spill() { close(file_); }

void Spill::append(std::span<const double> values) {
  const char* bytes = reinterpret_cast<const char*>(values.data());
  std::size_t left = values.size_bytes();
  while (left > 0) {
    const ssize_t written = write(file_, bytes, left);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot write a temporary file", IoError::Side::output);
    bytes += written;
    left -= static_cast<std::size_t>(written);
  }
  size_ += values.size();
}

void Spill::each(const std::function<void(double)>& body) const {
  std::vector<double> block(1 << 16);
  for (std::size_t first = 0; first < size_;) {
    const std::size_t wanted = std::min(block.size(), size_ - first) * sizeof(double);
    std::size_t got = 0;
    while (got < wanted) {
      const ssize_t count = pread(file_, reinterpret_cast<char*>(block.data()) + got, wanted - got,
                                  static_cast<off_t>(first * sizeof(double) + got));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) fail("cannot read a temporary file", IoError::Side::output);
      got += static_cast<std::size_t>(count);
    }
    for (std::size_t i = 0; i < wanted / sizeof(double); ++i) body(block[i]);
    first += wanted / sizeof(double);
  }
}

double absolute_of_rank(const Spill& values, std::size_t rank) {
  // The bits of numbers that are not negative are ordered as they are.
  std::uint64_t leading = 0;
  for (int shift = 48; shift >= 0; shift -= 16) {
    std::vector<std::size_t> count(1 << 16);
    values.each([&](double value) {
      const auto bits = std::bit_cast<std::uint64_t>(std::abs(value));
      if (shift == 48 || bits >> (shift + 16) == leading) ++count[bits >> shift & 0xffff];
    });
    std::uint64_t digit = 0;
    while (rank >= count[digit]) rank -= count[digit++];
    leading = leading << 16 | digit;
  }
  return std::bit_cast<double>(leading);
}

}  // namespace carve
