#include "skin/skin_lut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "color/spectrum.h"
#include "numerics/argument_check.h"
#include "numerics/worst.h"
#include "skin/sampled_skin.h"
#include "skin/skin_transmittance.h"
#include "skin/thickness_nodes.h"

namespace skinglow {
namespace {

/// A wavelength that adds less than this part of the tolerance to a column of M does not matter. All 81
/// together stay far below the tolerance even where diffusion theory, which decides, is off by a factor of a
/// hundred.
constexpr double share_of_tolerance = 1e-5;

/// Streams per hemisphere and the largest error they left on random skins (docs/accuracy.md).
struct StreamChoice {
    int streams;
    double error;
};
constexpr std::array<StreamChoice, 9> stream_choices = {{{4, 2e-1},
                                                         {6, 5e-2},
                                                         {8, 3e-3},
                                                         {10, 3e-4},
                                                         {12, 1e-4},
                                                         {16, 2e-5},
                                                         {20, 5e-6},
                                                         {24, 1e-6},
                                                         {32, 1e-7}}};

std::size_t stream_choice(double error) {
    std::size_t i = 0;
    while (i + 1 < stream_choices.size() && stream_choices[i].error > error) ++i;
    return i;
}

/// Nodes of a stretch for an error of interpolation: of fourth order, and odd, so that every second is a set
/// of its own.
std::size_t node_choice(double error) {
    const auto halves = static_cast<std::size_t>(std::ceil(1.35 * std::pow(error, -0.25)));
    return 2 * std::max<std::size_t>(halves, 4) + 1;
}

ThicknessNodes make_nodes(const Tissue& tissue, const std::vector<double>& entries_mm, std::size_t count) {
    // Light turns diffuse within some mean free paths, and it does so fastest next to the surface.
    const Layer inner = skin_media(tissue, 600.0).inner;
    const double free_path = 1.0 / (inner.scattering * (1.0 - inner.anisotropy) + inner.absorption);
    return {entries_mm, 2.0 * tissue.epidermal_thickness_mm, 0.05 * free_path, count};
}

/// How far the interpolation between nodes is off: every second node predicts the others. Of that error a
/// sixteenth is left with all nodes where the order is four; near the surface it is less, and half is said.
double node_error(const SampledSkin& skin, const ThicknessRows& correction, const ThicknessNodes& nodes,
                  const std::vector<glm::dmat3>& exact) {
    if (nodes.is_exact()) return 0.0;
    ThicknessRows predicted;
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        predicted[k].resize(exact.size());
        nodes.predict_from_half(correction[k], predicted[k]);
    }
    return largest_error(matrices(skin.log_transmittance(predicted), exact.size()), exact) / 2.0;
}

/// Skin solved as planned, and at more wavelengths while the error of leaving some out is above `allowed`.
SkinLut solve(const Tissue& tissue, const LutAxis& axis, const SkinLutPlan& plan, double allowed,
              double tolerance) {
    const ThicknessNodes nodes = make_nodes(tissue, axis.thickness_mm(), plan.nodes);
    SampledSkin skin(tissue, nodes, share_of_tolerance * tolerance, plan.streams);
    SkinLutReport report;
    report.wavelength_error = skin.solve(plan.wavelength_step, allowed);
    const ThicknessRows correction = skin.correction();
    const std::vector<glm::dmat3> at_nodes = matrices(skin.log_transmittance(correction), skin.node_count());
    report.streams = plan.streams;
    report.thickness_nodes_mm.assign(nodes.thickness_mm().begin(), nodes.thickness_mm().end());
    report.wavelengths_nm = skin.solved_nm();
    report.pairs_solved = skin.pairs_solved();
    report.pairs_skipped = skin.pairs_skipped();
    report.node_error = node_error(skin, correction, nodes, at_nodes);
    report.stream_error = 2.0 * skin.stream_difference(plan.streams + 2 * std::max(1, plan.streams / 8));
    report.estimated_error = report.stream_error + report.node_error + report.wavelength_error;
    return {BaseLut(matrices(skin.log_transmittance_at_entries(correction), axis.size()),
                    axis.max_thickness_mm()),
            std::move(report)};
}

}  // namespace

SkinLut skin_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, double tolerance) {
    const LutAxis axis(size, max_thickness_mm);
    validate(tissue);
    if (!(tolerance >= min_lut_tolerance && tolerance <= max_lut_tolerance)) {
        refuse_argument("tolerance", to_text(tolerance),
                        to_text(min_lut_tolerance) + " to " + to_text(max_lut_tolerance));
    }
    // Solving at a wavelength costs most, so leaving wavelengths out may take the largest part of the error.
    const double wavelength_share = 0.45 * tolerance;
    std::size_t streams = stream_choice(0.3 * tolerance);
    SkinLutPlan plan{stream_choices[streams].streams, node_choice(0.15 * tolerance), 8};
    for (;;) {
        SkinLut result = solve(tissue, axis, plan, wavelength_share, tolerance);
        if (result.report.estimated_error <= tolerance) return result;
        // What was chosen was not enough for this skin: refine what is worst, unless it is as fine as it
        // gets.
        const bool streams_are_worst = result.report.stream_error >= result.report.node_error;
        if (streams_are_worst && streams + 1 < stream_choices.size()) {
            plan.streams = stream_choices[++streams].streams;
        } else if (!streams_are_worst && plan.nodes < size) {
            plan.nodes += plan.nodes / 4 * 2;
        } else {
            return result;
        }
    }
}

SkinLut skin_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, const SkinLutPlan& plan) {
    const LutAxis axis(size, max_thickness_mm);
    validate(tissue);
    if (plan.nodes < 5 || plan.nodes % 2 == 0)
        refuse_argument("nodes", std::to_string(plan.nodes), "odd, 5 or more");
    if (plan.wavelength_step == 0 || plan.wavelength_step > 8 || 8 % plan.wavelength_step != 0) {
        refuse_argument("wavelength_step", std::to_string(plan.wavelength_step), "1, 2, 4 or 8");
    }
    constexpr double any = 1e300;
    return solve(tissue, axis, plan, any, min_lut_tolerance);
}

BaseLut base_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, double tolerance) {
    return skin_lut(tissue, size, max_thickness_mm, tolerance).lut;
}

BaseLut reference_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, int streams) {
    const std::vector<double> entries = LutAxis(size, max_thickness_mm).thickness_mm();
    std::vector<glm::dmat3> sum(size, glm::dmat3(0.0));
    std::vector<double> curve(size);
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        SkinCurve(tissue, sample_wavelength_nm(k), Incidence::diffuse(), streams)
            .transmittance(entries, curve);
        for (std::size_t i = 0; i < size; ++i) sum[i] += matrix_weights()[k] * curve[i];
    }
    return {std::move(sum), max_thickness_mm};
}

double lut_error(const BaseLut& lut, const BaseLut& exact) {
    if (lut.size() != exact.size()) {
        refuse_argument("size of the table", std::to_string(lut.size()),
                        "the exact one's, " + std::to_string(exact.size()));
    }
    double error = 0.0;
    for (std::size_t i = 0; i < lut.size(); ++i) {
        error = worst(error, matrix_error(lut.matrices()[i], exact.matrices()[i]));
    }
    return error;
}

}  // namespace skinglow
