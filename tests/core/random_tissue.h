#pragma once

#include <skinglow/tissue.h>

#include <random>

namespace skinglow {

/// Any skin that a Tissue may be; every second one within the range of human skin, some without epidermis or
/// index.
inline Tissue random_tissue(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto between = [&](double low, double high) { return low + (high - low) * uniform(random); };
    Tissue tissue;
    for (const TissueParameter& parameter : tissue_parameters()) {
        tissue.*parameter.field = between(parameter.minimum, parameter.maximum);
    }
    if (uniform(random) < 0.5) {
        tissue.melanin_fraction = between(0.01, 0.43);
        tissue.blood_fraction = between(0.002, 0.05);
        tissue.oxygen_saturation = between(0.6, 0.98);
        tissue.epidermal_thickness_mm = between(0.03, 0.12);
        tissue.scattering_scale = between(0.5, 1.5);
        tissue.refractive_index = between(1.37, 1.45);
        if (uniform(random) < 0.5) tissue.cartilage_fraction = 0.0;
    }
    if (uniform(random) < 0.1) tissue.epidermal_thickness_mm = 0.0;
    if (uniform(random) < 0.1) tissue.refractive_index = 1.0;
    return tissue;
}

}  // namespace skinglow
