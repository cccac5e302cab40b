#include <gtest/gtest.h>
#include <skinglow/lut.h>

#include <limits>

namespace skinglow {
namespace {

TEST(LutAxis, RunsFromNothingToTheThickest) {
    const LutAxis axis(5, 12.0);
    EXPECT_EQ(axis.thickness_mm(), (std::vector<double>{0.0, 3.0, 6.0, 9.0, 12.0}));
    EXPECT_EQ(LutAxis(1, 12.0).thickness_mm(), (std::vector<double>{0.0}));
    EXPECT_EQ(LutAxis(max_lut_size, 8.0).thickness_mm(max_lut_size - 1), 8.0);
}

TEST(LutAxis, MapsEntriesToTexelCenters) {
    for (const std::size_t size : {std::size_t{1}, std::size_t{2}, std::size_t{256}, max_lut_size}) {
        const LutAxis axis(size, 7.5);
        for (const std::size_t i : {std::size_t{0}, size / 3, size - 1}) {
            const double u = axis.texel_scale() * axis.thickness_mm(i) + axis.texel_offset();
            EXPECT_NEAR(u * static_cast<double>(size), static_cast<double>(i) + 0.5, 1e-9)
                << size << " entries, " << i;
        }
    }
}

TEST(LutAxis, RefusesWhatIsNoAxis) {
    EXPECT_THROW(LutAxis(0, 12.0), std::invalid_argument);
    EXPECT_THROW(LutAxis(max_lut_size + 1, 12.0), std::invalid_argument);
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
        EXPECT_THROW(LutAxis(4, bad), std::invalid_argument) << bad;
    }
}

TEST(BaseLut, TakesGrayAsMultiplesOfTheIdentity) {
    const std::vector<double> gray = {1.0, 0.25, 0.0};
    const BaseLut base = BaseLut::from_gray(gray, 4.0);
    ASSERT_EQ(base.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(base.matrices()[i], glm::dmat3(gray[i]));
    EXPECT_EQ(base.axis().thickness_mm(1), 2.0);
}

TEST(BaseLut, RefusesAndNamesTheEntry) {
    const double nan = std::nan("");
    try {
        BaseLut::from_gray(std::vector<double>{1.0, -0.5}, 4.0);
        FAIL() << "accepted a negative brightness";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "base lookup entry 1 is -0.5; allowed: a finite number, 0 or more");
    }
    EXPECT_THROW(BaseLut::from_gray(std::vector<double>{nan}, 4.0), std::invalid_argument);
    EXPECT_THROW(BaseLut::from_gray({}, 4.0), std::invalid_argument) << "empty";
    EXPECT_THROW(BaseLut(std::vector<glm::dmat3>(max_lut_size + 1), 4.0), std::invalid_argument)
        << "too long";
    std::vector<glm::dmat3> matrices(2, glm::dmat3(1.0));
    matrices[1][2][0] = nan;
    EXPECT_THROW(BaseLut(matrices, 4.0), std::invalid_argument);
    matrices[1][2][0] = -0.1;
    EXPECT_NO_THROW(BaseLut(matrices, 4.0)) << "negative entries off the diagonal are color, not error";
}

}  // namespace
}  // namespace skinglow
