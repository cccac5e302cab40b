#include "numerics/parallel_blocks.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <stdexcept>
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

}  // namespace
}  // namespace skinglow
