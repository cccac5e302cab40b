#include "skin/skin_transmittance.h"

#include <algorithm>
#include <cstddef>

namespace skinglow {
namespace {

constexpr double air = 1.0;

ThicknessCurve thick_curve(const Tissue& tissue, const SkinMedia& media, Incidence incidence, int streams) {
    // Without epidermis there is one layer to solve, not three.
    if (tissue.epidermal_thickness_mm == 0.0) {
        return {std::span<const Layer>(&media.inner, 1), 0, incidence, air, air, streams};
    }
    const std::vector<Layer> skin{media.epidermis, media.inner, media.epidermis};
    return {skin, 1, incidence, air, air, streams};
}

}  // namespace

SkinCurve::SkinCurve(const Tissue& tissue, double wavelength_nm, Incidence incidence, int streams)
    : tissue_(tissue),
      media_(skin_media(tissue, wavelength_nm)),
      incidence_(incidence),
      streams_(streams),
      thick_(thick_curve(tissue_, media_, incidence, streams)) {}

void SkinCurve::transmittance(std::span<const double> total_thickness_mm, std::span<double> out) const {
    // Thin skin is one layer of epidermis; its eigenproblem is solved only when a thickness asks for it.
    std::vector<double> thin, inner;
    for (const double total : total_thickness_mm) {
        const SkinThickness share = share_thickness(tissue_, total);
        if (share.inner_mm > 0.0 || tissue_.epidermal_thickness_mm == 0.0) {
            inner.push_back(share.inner_mm);
        } else {
            thin.push_back(total);
        }
    }
    std::vector<double> thin_out(thin.size()), inner_out(inner.size());
    if (!thin.empty()) {
        const ThicknessCurve epidermis(std::span<const Layer>(&media_.epidermis, 1), 0, incidence_, air, air,
                                       streams_);
        epidermis.transmittance(thin, thin_out);
    }
    thick_.transmittance(inner, inner_out);
    auto next_thin = thin_out.begin(), next_inner = inner_out.begin();
    for (std::size_t i = 0; i < total_thickness_mm.size(); ++i) {
        const bool is_inner = share_thickness(tissue_, total_thickness_mm[i]).inner_mm > 0.0 ||
                              tissue_.epidermal_thickness_mm == 0.0;
        out[i] = is_inner ? *next_inner++ : *next_thin++;
    }
}

std::vector<double> transmittance(const Tissue& tissue, std::span<const double> thickness_mm,
                                  std::span<const double> wavelength_nm, Incidence incidence, int streams) {
    std::vector<double> result(thickness_mm.size() * wavelength_nm.size());
    std::vector<double> curve(thickness_mm.size());
    for (std::size_t j = 0; j < wavelength_nm.size(); ++j) {
        SkinCurve(tissue, wavelength_nm[j], incidence, streams).transmittance(thickness_mm, curve);
        for (std::size_t i = 0; i < curve.size(); ++i) result[i * wavelength_nm.size() + j] = curve[i];
    }
    return result;
}

}  // namespace skinglow
