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

void parallel_ranges(int begin, int end, int grain, const std::function<void(int first, int last)>& body) {
  tbb::parallel_for(tbb::blocked_range<int>(begin, end, std::max(1, grain)),
                    [&](const tbb::blocked_range<int>& range) { body(range.begin(), range.end()); });
}

}  // namespace carve
