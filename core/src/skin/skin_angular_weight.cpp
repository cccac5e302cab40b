#include <skinglow/tissue.h>

#include <vector>

#include "numerics/argument_check.h"
#include "radiometry/angular_weight.h"

namespace skinglow {

AngularWeight skin_angular_weight(const Tissue& tissue, double thickness_mm, int streams) {
    require_positive("thickness_mm", thickness_mm);
    std::vector<double> mu;
    std::vector<glm::dvec3> transmittance;
    for (std::size_t channel = 0; channel < primary_wavelengths_nm.size(); ++channel) {
        const auto stack = skin_layers(tissue, thickness_mm, primary_wavelengths_nm[channel]);
        const DirectionalTransmittance beams = directional_transmittance(stack, 1.0, 1.0, streams);
        mu.assign(beams.mu.rbegin(), beams.mu.rend());  // ascending
        transmittance.resize(mu.size());
        for (std::size_t i = 0; i < mu.size(); ++i)
            transmittance[i][static_cast<int>(channel)] = beams.transmittance[mu.size() - 1 - i];
    }
    return {mu, transmittance};
}

}  // namespace skinglow
