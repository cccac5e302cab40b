#include "files/color_encoding.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace skinglow::detail {
namespace {

glm::dvec3 xyz_of(double x, double y) {
    return {x / y, 1.0, (1.0 - x - y) / y};
}

/// XYZ of linear RGB: SMPTE RP 177-1993.
glm::dmat3 xyz_of_rgb(const Chromaticities& c) {
    const glm::dmat3 primaries(xyz_of(c[0], c[1]), xyz_of(c[2], c[3]), xyz_of(c[4], c[5]));
    const glm::dvec3 scale = glm::inverse(primaries) * xyz_of(c[6], c[7]);
    return {primaries[0] * scale.r, primaries[1] * scale.g, primaries[2] * scale.b};
}

/// Takes XYZ under one white to another: Lam, "Metamerism and colour constancy" (1985), the Bradford
/// transform.
glm::dmat3 adapt_white(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dmat3 bradford(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296);
    const glm::dvec3 ratio = (bradford * to) / (bradford * from);
    glm::dmat3 scale(1.0);
    for (int i = 0; i < 3; ++i) scale[i][i] = ratio[i];
    return glm::inverse(bradford) * scale * bradford;
}

}  // namespace

double srgb_to_linear(double encoded) {
    const double size = std::abs(encoded);
    const double linear = size <= 0.04045 ? size / 12.92 : std::pow((size + 0.055) / 1.055, 2.4);
    return std::copysign(linear, encoded);
}

double linear_to_srgb(double linear) {
    const double size = std::abs(linear);
    const double encoded = size <= 0.0031308 ? size * 12.92 : 1.055 * std::pow(size, 1.0 / 2.4) - 0.055;
    return std::copysign(encoded, linear);
}

unsigned quantize(double linear, Encoding encoding, unsigned levels) {
    const double clamped = std::clamp(linear, 0.0, 1.0);
    const double encoded = encoding == Encoding::srgb ? linear_to_srgb(clamped) : clamped;
    return static_cast<unsigned>(std::lround(encoded * levels));
}

bool is_rec709(const Chromaticities& chromaticities) {
    constexpr double rounding = 1e-3;  // files have three to five digits
    return std::equal(chromaticities.begin(), chromaticities.end(), rec709.begin(),
                      [](double a, double b) { return std::abs(a - b) < rounding; });
}

std::optional<glm::dmat3> to_rec709(const Chromaticities& from) {
    for (std::size_t i = 1; i < from.size(); i += 2) {
        if (!(std::abs(from[i]) > 1e-6)) return std::nullopt;
    }
    const glm::dmat3 source = xyz_of_rgb(from);
    const glm::dmat3 matrix = glm::inverse(xyz_of_rgb(rec709)) *
                              adapt_white(xyz_of(from[6], from[7]), xyz_of(rec709[6], rec709[7])) * source;
    for (int i = 0; i < 9; ++i) {
        if (!std::isfinite(matrix[i / 3][i % 3])) return std::nullopt;
    }
    return matrix;
}

}  // namespace skinglow::detail
