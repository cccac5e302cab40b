#include "numerics/parallel_blocks.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace skinglow::detail {
namespace {

struct Blocks {
    std::size_t count;
    std::size_t block;
    const std::function<void(std::size_t, std::size_t)>& work;
    std::atomic<std::size_t> next = 0;
    std::atomic<std::size_t> finished = 0;
    std::atomic<bool> stopped = false;
    std::atomic<bool> failed = false;
    std::exception_ptr failure;  ///< of the first helper that failed; read once all are joined

    void take(const std::function<void(std::size_t)>& done) {
        while (!stopped) {
            const std::size_t begin = next.fetch_add(block);
            if (begin >= count) return;
            const std::size_t end = std::min(begin + block, count);
            work(begin, end);
            finished += end - begin;
            if (done) done(finished);
        }
    }

    void help() noexcept {
        try {
            take({});
        } catch (...) {
            if (!failed.exchange(true)) failure = std::current_exception();
            stopped = true;
        }
    }
};

struct StopAtEnd {
    std::atomic<bool>& stopped;
    ~StopAtEnd() { stopped = true; }
};

}  // namespace

void for_each_block(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& work,
                    const std::function<void(std::size_t)>& done, std::size_t block) {
    const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads)
                                           : std::max<std::size_t>(1, std::thread::hardware_concurrency());
    const std::size_t used = std::min(wanted, (count + block - 1) / block);
    Blocks blocks{.count = count, .block = block, .work = work, .failure = {}};
    {
        std::vector<std::jthread> helpers;
        const StopAtEnd stop{
            blocks.stopped};  // goes before the helpers do, so that a throw ends them at once
        for (std::size_t i = 1; i < used; ++i) helpers.emplace_back([&blocks] { blocks.help(); });
        blocks.take(done);
        helpers.clear();  // waits for each
    }
    if (blocks.failure) std::rethrow_exception(blocks.failure);
}

}  // namespace skinglow::detail
