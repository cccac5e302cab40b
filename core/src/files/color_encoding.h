#pragma once

#include <array>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>

#include "numerics/detail.h"

namespace skinglow::detail {

/// The xy coordinates of red, green, blue and white.
using Chromaticities = std::array<double, 8>;

constexpr Chromaticities rec709 = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};

/// How an image's numbers stand for light, as the file says of itself.
struct ColorEncoding {
    enum class Transfer { linear, srgb, gamma };
    Transfer transfer = Transfer::srgb;
    double gamma = 1.0;                            ///< the exponent of Transfer::gamma
    std::optional<Chromaticities> chromaticities;  ///< where the file has some
    std::string note;                              ///< what it says and is not read
};

/// What a PNG's chunks cICP, iCCP, sRGB, gAMA and cHRM say, in this order of precedence (PNG, third edition,
/// 4.3). None for another format or a PNG that says nothing. @throws FileError where it names an encoding
/// that is not read
std::optional<ColorEncoding> read_png_encoding(const std::filesystem::path& path);

/// Whether they are Rec.709's, up to rounding.
bool is_rec709(const Chromaticities& chromaticities);

/// Takes linear RGB of other primaries to linear Rec.709, white to white (Bradford); none where they span no
/// color space.
std::optional<glm::dmat3> to_rec709(const Chromaticities& from);

}  // namespace skinglow::detail
