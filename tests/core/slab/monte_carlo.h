#pragma once

#include <skinglow/slab.h>

#include <cstdint>
#include <span>
#include <vector>

namespace skinglow::testing {

/// A mean over photons and the standard error of that mean.
struct Estimate {
    double mean = 0;
    double error = 0;
};

struct MonteCarloResult {
    Estimate reflectance;
    Estimate transmittance;
    Estimate unscattered;
    std::vector<Estimate> absorbed;
};

/// Second opinion on the slab solver: photon packets through plane layers, one by one (the method of MCML,
/// Wang, Jacques and Zheng 1995, Comput Meth Prog Biomed 47:131). It shares no code and no idea with discrete
/// ordinates. Henyey-Greenstein scattering, Fresnel reflection drawn by lot at each change of index. Fluxes
/// of plane layers need only each packet's cosine to the normal.
MonteCarloResult monte_carlo_slab(std::span<const Layer> layers, Incidence incidence, double n_above,
                                  double n_below, int photons, std::uint64_t seed);

}  // namespace skinglow::testing
