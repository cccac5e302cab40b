#pragma once

#include <cstddef>
#include <functional>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Calls `work(begin, end)` for blocks that together are 0 to count, each once, on several threads: the caller's and
/// helpers, all joined on return. Plain threads, so that no pool is shared with a host's library. What `work` or `done`
/// throws first stops the rest and is rethrown. Works for the caller's job (job.h), and ends when that is stopped.
/// @param threads  0: one for each processor
/// @param done     told the number finished so far after each block that the calling thread does; may be empty
/// @param block    items per task: amortizes scheduling, and keeps canceling responsive (some milliseconds)
void for_each_block(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& work,
                    const std::function<void(std::size_t)>& done = {}, std::size_t block = 128);

}  // namespace skinglow::detail
