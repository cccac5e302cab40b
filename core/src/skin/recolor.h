#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "skin/base_lut.h"

namespace skinglow {

/// The paper's B: blood reddens what comes through (Kim et al., value given with Eq. 1). Mode `paper` alone
/// adds it.
constexpr glm::dvec3 paper_blood_weight{1.8, 0.5, 0.4};

/// The recolored table M(d) * weight, one linear Rec.709 color per entry; values above 1 are kept.
/// Mode `paper` (Eq. 1): a gray base and weight = B + L. Mode `physical`: weight = E, W/m^2, on the far side.
/// @param weight  linear Rec.709, finite. Throws std::invalid_argument on a non-finite weight or where a
/// product is beyond the largest double.
std::vector<glm::dvec3> recolor(const BaseLut& base, const glm::dvec3& weight);

/// The same into memory of the caller's, without allocation. @param out exactly as many entries as the base.
void recolor(const BaseLut& base, const glm::dvec3& weight, std::span<glm::dvec3> out);

}  // namespace skinglow
