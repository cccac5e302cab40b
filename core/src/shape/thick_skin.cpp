#include "shape/thick_skin.h"

#include <skinglow/slab.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "numerics/parallel_blocks.h"
#include "shape/surface_optics.h"
#include "skin/skin_optics.h"

namespace skinglow::detail {

Spectrum thick_skin(const Tissue& tissue) {
    Spectrum wavelength_nm{};
    for (std::size_t k = 0; k < spectral_samples; ++k) wavelength_nm[k] = sample_wavelength_nm(k);
    const SkinOptics optics(tissue, wavelength_nm);
    const double thrown_back = diffuse_reflectance(tissue.refractive_index).outside;
    Spectrum leaving{};
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            std::array layers{optics.media[k].epidermis, optics.media[k].inner};
            layers[1].thickness = std::numeric_limits<double>::infinity();
            const std::span<const Layer> skin =
                layers[0].thickness > 0 ? std::span<const Layer>(layers) : std::span(layers).subspan(1);
            constexpr int streams = 8;
            leaving[k] =
                std::max(0.0, slab(skin, Incidence::diffuse(), 1, 1, streams).reflectance - thrown_back);
        }
    };
    for_each_block(spectral_samples, 0, work, {}, 8);
    return leaving;
}

}  // namespace skinglow::detail
