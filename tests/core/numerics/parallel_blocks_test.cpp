#include "numerics/parallel_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace skinglow {
namespace {

TEST(ForEachBlock, CoversEachIndexOnce) {
    for (const int threads : {0, 1, 3}) {
        std::vector<int> seen(1000, 0);
        for_each_block(seen.size(), threads,
                       [&](std::size_t begin, std::size_t end) {
                           for (std::size_t i = begin; i < end; ++i) ++seen[i];
                       },
                       {});
        EXPECT_EQ(seen, std::vector<int>(1000, 1));
    }
    for_each_block(0, 2, [](std::size_t, std::size_t) { FAIL() << "there is nothing to do"; }, {});
}

TEST(ForEachBlock, ThrowsOnWhatAnyThreadThrows) {
    for (const int threads : {1, 4}) {
        EXPECT_THROW(for_each_block(100000, threads,
                                    [](std::size_t begin, std::size_t) {
                                        if (begin > 5000) throw std::runtime_error("stop");
                                    },
                                    {}),
                     std::runtime_error);
    }
}

TEST(ForEachBlock, EndsAllThreadsSoonAfterOneThrows) {
    std::atomic<std::size_t> done = 0;
    const auto work = [&](std::size_t begin, std::size_t end) {
        if (begin == 0) throw std::length_error("the first block");
        done += end - begin;
        std::this_thread::sleep_for(std::chrono::microseconds(100));
    };
    EXPECT_THROW(for_each_block(1000000, 4, work, {}, 1), std::length_error);
    EXPECT_LT(done, 100000U);
}

TEST(ForEachBlock, IsCanceledByWhatTheProgressFunctionThrows) {
    for (const int threads : {1, 4}) {
        std::atomic<std::size_t> started = 0;
        int told = 0;
        const auto cancel = [&](std::size_t) {
            if (++told == 3) throw std::domain_error("canceled");
        };
        const auto work = [&](std::size_t begin, std::size_t end) { started += end - begin; };
        EXPECT_THROW(for_each_block(std::size_t{1} << 40U, threads, work, cancel, 128), std::domain_error);
        EXPECT_EQ(told, 3);
        EXPECT_GE(started, 3 * 128U);
    }
}

TEST(ForEachBlock, TellsItsProgressAscendingOnTheCallingThread) {
    const auto caller = std::this_thread::get_id();
    std::vector<std::size_t> told;
    for_each_block(
        1000, 3, [](std::size_t, std::size_t) {},
        [&](std::size_t done) {
            EXPECT_EQ(std::this_thread::get_id(), caller);
            told.push_back(done);
        },
        10);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_TRUE(told.empty() || told.back() <= 1000U);
}

}  // namespace
}  // namespace skinglow
