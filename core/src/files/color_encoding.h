#pragma once

#include <array>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>

#include "numerics/detail.h"

namespace skinglow::detail {

/// How numbers in a file stand for light.
enum class Encoding { linear, srgb };

/// Linear light of an sRGB-encoded value and back: IEC 61966-2-1:1999, continued below 0 as an odd function.
/// Any finite value gives a finite one; 0 and 1 stay themselves.
double srgb_to_linear(double encoded);
double linear_to_srgb(double linear);

/// What a whole number of `levels` (255 or 65535) stands for `linear` in a file: clamped to 0..1, encoded,
/// rounded to nearest.
unsigned quantize(double linear, Encoding encoding, unsigned levels);

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
