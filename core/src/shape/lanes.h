#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "numerics/detail.h"

namespace skinglow::detail {

/// How many spectral nodes (or color channels) are solved side by side: the width of a 128-bit vector.
constexpr std::size_t lane_count = 4;

/// One float for each node. Lanes that no node uses hold what does no harm.
struct alignas(16) Lanes {
    float v[lane_count] = {0, 0, 0, 0};

    static Lanes all(float x) { return {{x, x, x, x}}; }
    float operator[](std::size_t i) const { return v[i]; }
    float& operator[](std::size_t i) { return v[i]; }
};

/// Calls a function of one lane's numbers for each lane: written as a loop, compiled as one instruction.
template <typename Function>
inline Lanes each_lane(const Function& function) {
    Lanes result;
    for (std::size_t i = 0; i < lane_count; ++i) result.v[i] = function(i);
    return result;
}

inline Lanes operator+(const Lanes& a, const Lanes& b) {
    return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}};
}
inline Lanes operator-(const Lanes& a, const Lanes& b) {
    return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}};
}
inline Lanes operator*(const Lanes& a, const Lanes& b) {
    return {{a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]}};
}
inline Lanes operator*(const Lanes& a, float s) {
    return {{a.v[0] * s, a.v[1] * s, a.v[2] * s, a.v[3] * s}};
}
inline Lanes& operator+=(Lanes& a, const Lanes& b) {
    return a = a + b;
}

/// Lanes in half the memory: the upper halves of the floats (bfloat16), rounded to nearest. Good to 0.2 % each,
/// and what is summed of hundreds to some hundredths of a percent.
struct alignas(8) PackedLanes {
    std::uint16_t v[lane_count] = {0, 0, 0, 0};
};
inline PackedLanes pack(const Lanes& lanes) {
    PackedLanes result;
    for (std::size_t i = 0; i < lane_count; ++i)
        result.v[i] = static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(lanes.v[i]) + 0x8000U) >> 16U);
    return result;
}
inline Lanes unpack(const PackedLanes& packed) {
    return each_lane(
        [&](std::size_t i) { return std::bit_cast<float>(static_cast<std::uint32_t>(packed.v[i]) << 16U); });
}

/// The two modes of SP3, each for all nodes.
struct LanePair {
    Lanes first;
    Lanes second;
};
inline LanePair& operator+=(LanePair& a, const LanePair& b) {
    a.first += b.first;
    a.second += b.second;
    return a;
}
inline LanePair operator*(const LanePair& a, float s) {
    return {a.first * s, a.second * s};
}

}  // namespace skinglow::detail
