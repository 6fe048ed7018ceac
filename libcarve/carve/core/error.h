#pragma once
#include <stdexcept>
#include <string>

namespace carve {

/// A file that cannot be read or written; what() is "path: why". Programs exit with 2 where what they were given is at
/// fault (input: an unreadable file, an impossible place), with 1 where the machine failed them (output: a full disk).
class IoError : public std::runtime_error {
 public:
  enum class Side { input, output };
  IoError(const std::string& path, const std::string& why, Side side = Side::input)
      : std::runtime_error(path + ": " + why), side_(side) {}
  Side side() const { return side_; }

 private:
  Side side_;
};

/// The work was understood but has no result (silhouettes whose intersection is empty, say). Programs exit with 1.
class NoResult : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A Monitor's stop token was triggered.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace carve
