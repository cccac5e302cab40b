#include "numerics/argument_check.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace skinglow {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

template <typename Check>
std::string refusal(const Check& check) {
    try {
        check();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "nothing refused";
}

TEST(ArgumentCheck, SaysNameValueAndWhatIsAllowed) {
    EXPECT_EQ(refusal([] { require_positive("radius", -0.5); }),
              "radius is -0.5; allowed: a finite number above 0");
    EXPECT_EQ(refusal([] { require_not_negative(entry_name("depth", 3), -1.0); }),
              "depth[3] is -1; allowed: a finite number, 0 or more");
    EXPECT_EQ(refusal([] { require_not_negative("color", glm::dvec3(0, -1, 2)); }),
              "color is (0, -1, 2); allowed: three finite numbers, 0 or more");
    EXPECT_EQ(refusal([] { require_finite(std::string("point"), glm::dvec3(0, nan, inf)); }),
              "point is (0, nan, inf); allowed: three finite numbers");
}

TEST(ArgumentCheck, RefusesWhatIsNoNumber) {
    for (const double bad : {nan, inf, -inf}) {
        EXPECT_THROW(require_finite("x", bad), std::invalid_argument);
        EXPECT_THROW(require_not_negative("x", bad), std::invalid_argument);
        EXPECT_THROW(require_positive("x", bad), std::invalid_argument);
    }
    EXPECT_THROW(require_positive("x", 0.0), std::invalid_argument);
    EXPECT_EQ(require_not_negative("x", 0.0), 0.0);
}

TEST(ArgumentCheck, ANameIsPutTogetherOnlyWhenItIsNeeded) {
    int made = 0;
    const auto name = [&made] { return "name " + std::to_string(++made); };
    for (int i = 0; i < 100; ++i) require_finite(name, 1.0 * i);
    EXPECT_EQ(made, 0);
    EXPECT_EQ(refusal([&] { require_finite(name, nan); }), "name 1 is nan; allowed: a finite number");
}

}  // namespace
}  // namespace skinglow
