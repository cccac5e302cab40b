#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "radiometry/prepared_light.h"

namespace skinglow {

/// How many places are worked on at once: so few that their arrays stay in the first-level cache.
constexpr std::size_t block_capacity = 128;
using BlockValues = std::array<double, block_capacity>;

/// Places and normals, coordinate by coordinate, for loops that a compiler turns into vector instructions.
struct PlaceBlock {
    std::size_t count = 0;
    alignas(64) BlockValues x, y, z;     ///< place
    alignas(64) BlockValues nx, ny, nz;  ///< unit normal
};

/// What one lamp gives to a block.
struct BlockIrradiance {
    alignas(64) BlockValues value;  ///< per unit of power
    /// Not 0 where the common case does not hold (a lamp that straddles the horizon, a soft cone's rim, a
    /// place within the lamp) and PreparedLight::irradiance has to be asked.
    alignas(64) BlockValues special;
};

/// Sums over lamps, W/m^2.
struct BlockSum {
    alignas(64) BlockValues red, green, blue;
};

/// Normals to length 1; those of length 0 stay.
void normalize(PlaceBlock& places);

/// Whether the first `count` values are numbers from -most to most.
bool all_within(const BlockValues& values, std::size_t count, double most);

/// Whether one of the first `count` places is special.
bool any_special(const BlockIrradiance& one, std::size_t count);

/// Adds a lamp's values times its power and color.
void add_block(const BlockIrradiance& one, const glm::dvec3& strength, std::size_t count, BlockSum& sum);

/// Fills both for any kind of lamp. Rectangles without a spread, points, spots and suns are vectorized;
/// `special` is set everywhere for the other lamps. Coordinates beyond 1e70 are the caller's to keep away.
void block_irradiance(const PreparedLight& light, const PlaceBlock& places, BlockIrradiance& result);

/// Cosines between the normals and the middle of a lamp; those of special places may be no numbers.
void block_cosine(const PreparedLight& light, const PlaceBlock& places, BlockValues& cosine);

/// The same for a rectangle without a spread, in closed form (J. H. Lambert's polygon formula), cut by the
/// horizon.
void rectangle_block(const PreparedLight& light, const AreaEmitter& area, const PlaceBlock& places,
                     BlockIrradiance& result);

}  // namespace skinglow
