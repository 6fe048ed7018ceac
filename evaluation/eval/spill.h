#pragma once
#include <functional>
#include <span>

namespace carve {

/// Numbers in the order they came, in a file that goes with this object: as many as the disk holds, in the memory of a
/// block. The file lies in $TMPDIR (else /tmp).
class Spill {
 public:
  Spill();  // \throws IoError if there can be no such file
  ~Spill();
  Spill(const Spill&) = delete;
  Spill& operator=(const Spill&) = delete;

  void append(std::span<const double> values);  // \throws IoError if the disk is full
  std::size_t size() const { return size_; }
  /// All of them, block after block, as often as asked.
  void each(const std::function<void(double)>& body) const;

 private:
  int file_;
  std::size_t size_ = 0;
};

/// The absolute value with `rank` smaller or equal ones before it; counts leading bits in four passes.
double absolute_of_rank(const Spill& values, std::size_t rank);

}  // namespace carve
