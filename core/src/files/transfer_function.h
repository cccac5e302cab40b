#pragma once

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

}  // namespace skinglow::detail
