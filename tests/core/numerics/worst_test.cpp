#include "numerics/worst.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace skinglow {
namespace {

TEST(Worst, IsTheLargerAndNeverPassesOverWhatIsNoNumber) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(worst(1.0, 2.0), 2.0);
    EXPECT_EQ(worst(2.0, 1.0), 2.0);
    EXPECT_TRUE(std::isnan(worst(nan, 1.0)));
    EXPECT_TRUE(std::isnan(worst(1.0, nan)));
    EXPECT_TRUE(std::isnan(worst(nan, std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace skinglow
