#include <skinglow/lut.h>
#include <skinglow/spectrum.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "numerics/argument_check.h"

namespace skinglow {
namespace {

/// Streams per hemisphere and a bound on the error they leave: half as much again as the largest error seen on
/// random skins and on the corners of the parameters' ranges (docs/accuracy.md).
constexpr std::array<SkinLutReport, 9> stream_choices = {{{6, 1e-1},
                                                          {8, 6e-3},
                                                          {10, 9.5e-4},
                                                          {12, 3.5e-4},
                                                          {16, 9.5e-5},
                                                          {20, 2e-5},
                                                          {24, 4e-6},
                                                          {32, 1.5e-6},
                                                          {40, 5e-7}}};

/// Difference of two matrices in the norm of SkinLutReport.
double matrix_error(const glm::dmat3& matrix, const glm::dmat3& exact) {
    constexpr double darkest = 1e-6;
    double error = 0;
    for (int j = 0; j < 3; ++j) {
        double difference = 0;
        double scale = darkest;
        for (int i = 0; i < 3; ++i) {
            difference = std::max(difference, std::abs(matrix[j][i] - exact[j][i]));
            scale = std::max(scale, std::abs(exact[j][i]));
        }
        error = std::max(error, difference / scale);
    }
    return error;
}

}  // namespace

SkinLut base_lut_report(const Tissue& tissue, std::size_t size, double max_thickness_mm, double tolerance,
                        int threads) {
    require_between("tolerance", tolerance, min_lut_tolerance, max_lut_tolerance);
    const auto* choice = std::find_if(stream_choices.begin(), stream_choices.end(),
                                      [&](const auto& entry) { return entry.estimated_error <= tolerance; });
    return {reference_lut(tissue, size, max_thickness_mm, choice->streams, threads), *choice};
}

BaseLut base_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, double tolerance,
                 int threads) {
    return base_lut_report(tissue, size, max_thickness_mm, tolerance, threads).lut;
}

BaseLut reference_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, int streams,
                      int threads) {
    const std::vector<double> thickness_mm = LutAxis(size, max_thickness_mm).thickness_mm();
    Spectrum wavelength_nm{};
    for (std::size_t k = 0; k < spectral_samples; ++k) wavelength_nm[k] = sample_wavelength_nm(k);
    const std::vector<double> filters =
        transmittance(tissue, thickness_mm, wavelength_nm, Incidence::diffuse(), streams, threads);
    std::vector<glm::dmat3> matrices;
    matrices.reserve(size);
    for (std::size_t i = 0; i < size; ++i) {
        matrices.push_back(
            transmission_matrix(std::span(filters).subspan(i * spectral_samples).first<spectral_samples>()));
    }
    return {std::move(matrices), max_thickness_mm};
}

double lut_error(const BaseLut& lut, const BaseLut& exact) {
    require_count("table", lut.size(), exact.size(), "the exact one's");
    double error = 0.0;  // tables are finite: nothing here is NaN
    for (std::size_t i = 0; i < lut.size(); ++i) {
        error = std::max(error, matrix_error(lut.matrices()[i], exact.matrices()[i]));
    }
    return error;
}

}  // namespace skinglow
