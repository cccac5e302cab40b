#include "numerics/compensated_sum.h"

#include <gtest/gtest.h>

#include <limits>

namespace skinglow {
namespace {

TEST(CompensatedSum, KeepsWhatAPlainSumLoses) {
    CompensatedSum sum;
    double plain = 0;
    for (const double term : {1.0, 1e100, 1.0, -1e100}) {
        sum.add(term);
        plain += term;
    }
    EXPECT_EQ(sum.total(), 2.0);
    EXPECT_EQ(plain, 0.0);
}

TEST(CompensatedSum, AnOverflowIsInfinityAndNotNan) {
    CompensatedSum sum;
    sum.add(std::numeric_limits<double>::max());
    sum.add(std::numeric_limits<double>::max());
    sum.add(1.0);
    EXPECT_EQ(sum.total(), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace skinglow
