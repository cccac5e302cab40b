#include "geometry/vector.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace skinglow {
namespace {

TEST(FrameAround, IsRightHandedAboutItsAxis) {
    for (const glm::dvec3& axis :
         {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(1, 1, 1)),
          glm::normalize(glm::dvec3(-3, 2, 1e-9))}) {
        const glm::dmat3 frame = frame_around(axis);
        EXPECT_NEAR(glm::length(frame[0]), 1, 1e-12);
        EXPECT_NEAR(glm::dot(frame[0], axis), 0, 1e-12);
        EXPECT_NEAR(glm::length(glm::cross(frame[0], frame[1]) - axis), 0, 1e-12);
        EXPECT_NEAR(glm::length(frame * glm::dvec3(0, 0, 1) - axis), 0, 1e-12);
    }
}

}  // namespace
}  // namespace skinglow
