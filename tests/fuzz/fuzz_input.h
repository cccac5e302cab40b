#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace skinglow::fuzz {

/// Turns the fuzzer's bytes into numbers; where they end, everything is 0. Written so that a small change of the bytes
/// is a small change of the input.
class FuzzInput {
  public:
    FuzzInput(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}

    bool empty() const { return bytes_.empty(); }

    std::uint8_t byte() {
        if (bytes_.empty()) return 0;
        const std::uint8_t value = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return value;
    }
    /// 0 to limit - 1.
    std::size_t below(std::size_t limit) { return (byte() * std::size_t{256} + byte()) % limit; }
    bool flag() { return byte() % 2 == 1; }
    /// From min to max, both included.
    double between(double min, double max) {
        return min + (max - min) * static_cast<double>(byte() * 256 + byte()) / 65535.0;
    }
    double decades(double min, double max) {
        return std::pow(10.0, between(std::log10(min), std::log10(max)));
    }

    /// Any double at all: ordinary ones as often as those that break things.
    double number() {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        constexpr std::array special{
            0.0,    -0.0,        1.0,       -1.0,
            1e-12,  1.0 - 1e-12, 1e-30,     1e30,
            1e150,  1e300,       -1e300,    1e-300,
            5e-324, infinity,    -infinity, std::numeric_limits<double>::quiet_NaN()};
        switch (byte() % 6) {
            case 0:
                return special[byte() % special.size()];
            case 1:
                return from_bits();
            case 2:
                return between(-1.0, 1.0);
            case 3:
                return -decades(1e-6, 1e6);
            default:
                return decades(1e-6, 1e6);
        }
    }
    /// Mostly within the range, now and then any number.
    double near_range(double min, double max) { return byte() % 16 == 0 ? number() : between(min, max); }
    double near_decades(double min, double max) { return byte() % 16 == 0 ? number() : decades(min, max); }
    glm::dvec3 vector() { return {number(), number(), number()}; }
    glm::dvec3 vector_in(double min, double max) {
        return {near_range(min, max), near_range(min, max), near_range(min, max)};
    }

    /// All that is left.
    std::string text() {
        std::string all(bytes_.begin(), bytes_.end());
        bytes_ = {};
        return all;
    }
    /// At most that many bytes.
    std::string text(std::size_t longest) {
        std::string some;
        for (std::size_t left = below(longest + 1); left > 0 && !empty(); --left)
            some += static_cast<char>(byte());
        return some;
    }

  private:
    double from_bits() {
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
        return std::bit_cast<double>(bits);
    }
    std::span<const std::uint8_t> bytes_;
};

}  // namespace skinglow::fuzz
