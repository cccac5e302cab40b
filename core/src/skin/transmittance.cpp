#include <skinglow/angular_weight.h>

#include <array>
#include <cstddef>

#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "skin/skin_optics.h"
#include "slab/stream_grid.h"
#include "slab/variable_layer.h"

namespace skinglow {
namespace {

constexpr double air = 1.0;
constexpr std::size_t wavelengths_per_block = 3;  // some tenths of a millisecond

/// Thicknesses that one variable layer serves, and where they stand among all.
struct Thicknesses {
    std::vector<double> mm;
    std::vector<std::size_t> entry;

    void add(double thickness_mm, std::size_t i) {
        mm.push_back(thickness_mm);
        entry.push_back(i);
    }
    /// Column `column` of the rows of `out` that belong to these thicknesses.
    void solve(const VariableLayer& layer, std::size_t column, std::size_t columns,
               std::vector<double>& out) const {
        std::vector<double> solved(mm.size());
        layer.transmittance(mm, solved);
        for (std::size_t i = 0; i < mm.size(); ++i) out[entry[i] * columns + column] = solved[i];
    }
};

}  // namespace

std::vector<double> transmittance(const Tissue& tissue, std::span<const double> thickness_mm,
                                  std::span<const double> wavelength_nm, Incidence incidence, int streams,
                                  int threads) {
    const SkinOptics optics(tissue, wavelength_nm);
    const bool has_epidermis = tissue.epidermal_thickness_mm > 0.0;
    Thicknesses thin;  // thinner than the two epidermes: one layer of epidermis
    Thicknesses thick;
    for (std::size_t i = 0; i < thickness_mm.size(); ++i) {
        const SkinThickness split = split_thickness(tissue, thickness_mm[i]);
        if (split.inner_mm > 0.0 || !has_epidermis) {
            thick.add(split.inner_mm, i);
        } else {
            thin.add(thickness_mm[i], i);
        }
    }
    std::vector<double> result(thickness_mm.size() * wavelength_nm.size());
    if (result.empty()) return result;
    // The index is that of every layer at every wavelength.
    const StreamGrid grid({&optics.media.front().inner, 1}, incidence, air, air, streams);
    const auto solve_wavelengths = [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            const SkinMedia& media = optics.media[j];
            if (!thin.mm.empty()) {
                thin.solve(VariableLayer(grid, {&media.epidermis, 1}, 0), j, wavelength_nm.size(), result);
            }
            if (!thick.mm.empty()) {
                const std::array skin{media.epidermis, media.inner, media.epidermis};
                // Without epidermis there is one layer to solve, not three.
                const VariableLayer layer(
                    grid, has_epidermis ? std::span<const Layer>(skin) : std::span(skin).subspan(1, 1),
                    has_epidermis ? 1 : 0);
                thick.solve(layer, j, wavelength_nm.size(), result);
            }
        }
    };
    for_each_block(wavelength_nm.size(), threads, solve_wavelengths, {}, wavelengths_per_block);
    return result;
}

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
