// Tables of any tissue: finite, not negative, no thicker skin brighter; recolored without a surprise.

#include <skinglow/lut.h>

#include <vector>

#include "fuzz_input.h"
#include "require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skinglow;
    using namespace skinglow::fuzz;
    FuzzInput input(data, size);
    Tissue tissue;
    for (const TissueParameter& parameter : tissue_parameters())
        tissue.*parameter.field = input.near_range(parameter.minimum, parameter.maximum);
    const std::size_t entries = 2 + input.below(6);
    const double max_thickness_mm = input.near_decades(0.5, 50.0);
    runs([&] {
        const std::vector<double> thickness{0.2, 1.0, 4.0, 25.0};
        const std::vector<double> wavelength{input.near_range(380.0, 780.0)};
        const auto through = transmittance(tissue, thickness, wavelength, Incidence::diffuse(), 4, 1);
        double before = 1.0;
        for (const double t : through) {
            require(t >= 0 && t <= before * (1 + 1e-9), "transmittance falls with thickness");
            before = t;
        }
    });
    runs([&] {
        const BaseLut lut = base_lut(tissue, entries, max_thickness_mm, max_lut_tolerance, 1);
        for (const glm::dvec3& color : recolor(lut, glm::dvec3(1.0))) {
            require(is_finite(color), "colors are finite");
            require(color.x > -1e-6 && color.x < 1.5, "white light comes through as a fraction");
        }
    });
    return 0;
}
