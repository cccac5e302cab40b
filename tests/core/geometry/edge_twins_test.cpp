#include "geometry/edge_twins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace skinglow::detail {
namespace {

using Indices = std::vector<std::uint32_t>;

TEST(EdgeTwins, PairsTheEdgesOfFacesOfAnySize) {
    // A quad 0 1 2 3 and a triangle 2 1 4 over its second edge.
    const Indices corners = {0, 1, 2, 3, 2, 1, 4};
    const Indices twins = edge_twins(corners, Indices{0, 4, 7}, 5);
    EXPECT_EQ(twins, (Indices{no_twin, 4, no_twin, no_twin, 1, no_twin, no_twin}));
}

TEST(EdgeTwins, AnEdgeOfThreeFacesHasNone) {
    const Indices corners = {0, 1, 2, 1, 0, 3, 0, 1, 4};
    const Indices twins = edge_twins(corners, Indices{0, 3, 6, 9}, 5);
    EXPECT_EQ(twins, Indices(9, no_twin));
}

TEST(EdgeTwins, OfRandomFacesAreMutualAndHaveTheSameEnds) {
    std::mt19937 random(5);
    Indices corners(300);
    Indices begin = {0};
    for (std::uint32_t& c : corners) c = static_cast<std::uint32_t>(random() % 40);
    while (begin.back() < 300) begin.push_back(begin.back() + 3);
    const Indices twins = edge_twins(corners, begin, 40);
    const auto end = [&](std::uint32_t c) { return corners[c % 3 == 2 ? c - 2 : c + 1]; };
    int pairs = 0;
    for (std::uint32_t c = 0; c < 300; ++c) {
        if (twins[c] == no_twin) continue;
        ++pairs;
        EXPECT_EQ(twins[twins[c]], c);
        EXPECT_EQ(std::minmax(corners[c], end(c)), std::minmax(corners[twins[c]], end(twins[c])));
    }
    EXPECT_GT(pairs, 20);
}

}  // namespace
}  // namespace skinglow::detail
