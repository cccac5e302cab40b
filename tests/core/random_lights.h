#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "flat_light.h"

/// Scenes that a person would not think of: every kind of light, sizes and powers over decades, negative
/// power, lights in and on the box of the object.
namespace skinglow {

class RandomScene {
  public:
    explicit RandomScene(unsigned seed) : engine_(seed) {}

    double between(double min, double max) {
        return std::uniform_real_distribution<double>(min, max)(engine_);
    }
    double decades(double min, double max) {
        return std::pow(10.0, between(std::log10(min), std::log10(max)));
    }
    bool one_in(int n) { return below(n) == 0; }
    /// A whole number from 0 to n - 1. The distributions of C++ draw others in each library: a system with another one would
    /// be tested with scenes of its own.
    int below(int n) {
        return static_cast<int>(std::uint64_t{engine_()} * static_cast<std::uint64_t>(n) >> 32U);
    }
    glm::dvec3 in_box(const glm::dvec3& min, const glm::dvec3& max) {
        return {between(min.x, max.x), between(min.y, max.y), between(min.z, max.z)};
    }
    glm::dvec3 unit_vector() {
        glm::dvec3 v(0.0);
        while (glm::length(v) < 1e-3) {
            const glm::dvec2 pair = normal_pair();
            v = {pair, normal_pair().x};
        }
        return glm::normalize(v);
    }

    FlatLight light() {
        FlatLight light;
        light.kind = static_cast<LightKind>(below(4));
        light.color = in_box(glm::dvec3(0.0), glm::dvec3(1.0));
        light.position = unit_vector() * decades(0.05, 100.0);
        light.direction = one_in(2) ? unit_vector() : unit_vector() * 0.4 - light.position;
        light.power = decades(1e-3, 1e3) * (one_in(10) ? -1.0 : 1.0);
        light.radius = one_in(2) ? 0.0 : decades(0.001, 3.0);
        light.soft_falloff = !one_in(3);
        light.sun_angle = one_in(2) ? 0.0 : between(0.0, std::numbers::pi);
        light.spot_angle = between(0.05, std::numbers::pi);
        light.spot_blend = one_in(4) ? 0.0 : between(0.0, 1.0);
        light.spot_cosine = one_in(5);
        light.area_shape = one_in(2) ? AreaShape::ellipse : AreaShape::rectangle;
        light.size_x = one_in(5) ? 1e-9 : decades(0.01, 10.0);
        light.size_y = one_in(5) ? 1e-9 : decades(0.01, 10.0);
        if (light.size_x == light.size_y) light.size_y = 0.0;  // gives no light
        light.tangent = unit_vector();
        light.spread = one_in(2) ? std::numbers::pi : between(0.05, std::numbers::pi);
        return light;
    }

    std::vector<Light> lights(int count) {
        std::vector<Light> rig;
        for (int i = 0; i < count; ++i) rig.push_back(light());
        return rig;
    }

    std::mt19937& engine() { return engine_; }

  private:
    /// Two numbers of the normal distribution (Marsaglia's polar method).
    glm::dvec2 normal_pair() {
        glm::dvec2 v(0.0);
        double square = 0;
        while (square == 0 || square > 1) {
            const double x = between(-1.0, 1.0);
            v = {between(-1.0, 1.0), x};
            square = glm::dot(v, v);
        }
        return v * std::sqrt(-2 * std::log(square) / square);
    }

    std::mt19937 engine_;
};

}  // namespace skinglow
