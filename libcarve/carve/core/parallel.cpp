#include "carve/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace carve {

void set_thread_count(int threads) {
  static std::unique_ptr<tbb::global_control> limit;
  const int count = threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  limit.reset();  // the old limit would stay in force beside the new one
  limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

#ifdef __SANITIZE_THREAD__
// Debian's oneTBB is not instrumented: the sanitizer would see none of its hand-overs and report every one as a race.
void parallel_ranges(int begin, int end, int grain, const std::function<void(int first, int last)>& body) {
  const int middle = begin + (end - begin) / 2;
  if (end - begin < 2 * std::max(1, grain)) return begin < end ? body(begin, end) : void();
  std::thread other([&] { body(middle, end); });
  body(begin, middle);
  other.join();
}
#else
void parallel_ranges(int begin, int end, int grain, const std::function<void(int first, int last)>& body) {
  tbb::parallel_for(tbb::blocked_range<int>(begin, end, std::max(1, grain)),
                    [&](const tbb::blocked_range<int>& range) { body(range.begin(), range.end()); });
}
#endif

}  // namespace carve
