#include "files/transfer_function.h"

#include <algorithm>
#include <cmath>

namespace skinglow::detail {

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

}  // namespace skinglow::detail
