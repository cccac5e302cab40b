#include "numerics/parallel_blocks.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "numerics/job.h"

namespace skinglow::detail {

void for_each_block(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& work,
                    const std::function<void(std::size_t)>& done, std::size_t block) {
    const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads)
                                           : std::max<std::size_t>(1, std::thread::hardware_concurrency());
    const std::size_t used = std::min(wanted, (count + block - 1) / block);
    std::atomic<std::size_t> next = 0;
    std::atomic<std::size_t> finished = 0;
    Job* const job = Job::current();
    std::mutex failing;
    std::exception_ptr failure;
    // The first failure ends the work of all threads.
    const auto guarded = [&](const auto& part) noexcept {
        try {
            part();
        } catch (...) {
            next = count;
            const std::scoped_lock lock(failing);
            if (!failure) failure = std::current_exception();
        }
    };
    const auto take_blocks = [&](bool is_caller) {
        for (std::size_t begin = next.fetch_add(block); begin < count; begin = next.fetch_add(block)) {
            stop_if_asked();
            const std::size_t end = std::min(begin + block, count);
            work(begin, end);
            finished += end - begin;
            if (is_caller && done) done(finished);
        }
    };
    {
        std::vector<std::jthread> helpers;  // which are joined at the end of the scope
        guarded([&] {
            for (std::size_t i = 1; i < used; ++i)
                helpers.emplace_back([&] {
                    const Job::Scope scope(job);
                    guarded([&] { take_blocks(false); });
                });
            take_blocks(true);
        });
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace skinglow::detail
