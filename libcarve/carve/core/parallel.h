#pragma once
#include <functional>

namespace carve {

/// Threads used by every stage from now on; 0 = all cores. Results never depend on it.
void set_thread_count(int threads);

/// Calls body(first, last) on disjoint ranges that together make [begin, end), each at least `grain` long where
/// possible. The ranges depend on timing: a body must write only what belongs to its own indices.
void parallel_ranges(int begin, int end, int grain, const std::function<void(int first, int last)>& body);

}  // namespace carve
