#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "prepared_light.h"

namespace skinglow {

/// Places and normals, coordinate by coordinate, for loops that a compiler turns into vector instructions; a
/// block's arrays stay in the first-level cache.
struct PlaceBlock {
    static constexpr std::size_t capacity = 128;
    std::size_t count = 0;
    alignas(64) std::array<double, capacity> x, y, z;     ///< place
    alignas(64) std::array<double, capacity> nx, ny, nz;  ///< unit normal
};

/// What one lamp gives to a block.
struct BlockIrradiance {
    alignas(64) std::array<double, PlaceBlock::capacity> value;  ///< per unit of power
    alignas(64)
        std::array<double, PlaceBlock::capacity> cosine;  ///< between the normal and the middle of the lamp
    /// Not 0 where the common case does not hold (a lamp that straddles the horizon, a soft cone's rim, a
    /// place within the lamp) and PreparedLight::irradiance has to be asked.
    alignas(64) std::array<double, PlaceBlock::capacity> special;
};

/// Sums over lamps, W/m^2.
struct BlockSum {
    alignas(64) std::array<double, PlaceBlock::capacity> red, green, blue;
};

/// Normals to length 1; those of length 0 stay.
void normalise(PlaceBlock& places);

/// Whether one of the first `count` places is special.
bool any_special(const BlockIrradiance& one, std::size_t count);

/// Adds a lamp's values times its power and colour.
void add_block(const BlockIrradiance& one, const glm::dvec3& strength, std::size_t count, BlockSum& sum);

/// Fills all three for any kind of lamp. Rectangles without a spread, points, spots and suns are vectorised;
/// `special` is set everywhere for the other lamps. Coordinates beyond 1e70 are the caller's to keep away.
void block_irradiance(const PreparedLight& light, const PlaceBlock& places, BlockIrradiance& result);

/// The same for a rectangle without a spread, in closed form (J. H. Lambert's polygon formula), cut by the
/// horizon.
void rectangle_block(const PreparedLight& light, const AreaEmitter& area, const PlaceBlock& places,
                     BlockIrradiance& result);

}  // namespace skinglow
