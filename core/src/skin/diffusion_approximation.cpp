#include "skin/diffusion_approximation.h"

#include <cmath>

#include "numerics/argument_check.h"

namespace skinglow {
namespace {

/// Fluence and flux (towards the far side) at a plane, times exp(-log_scale).
struct Field {
    double fluence, flux, log_scale;
};

double classic_rate(const Layer& layer) {
    return std::sqrt(3.0 * layer.absorption *
                     (layer.absorption + layer.scattering * (1.0 - layer.anisotropy)));
}

/// The smaller eigenvalue of P3. m[n] = mua + mus (1 - g^n) is what the n-th moment of the radiance loses.
double third_order_rate(const Layer& layer) {
    double m[4];
    double power = 1.0;
    for (double& loss : m) {
        loss = layer.absorption + layer.scattering * (1.0 - power);
        power *= layer.anisotropy;
    }
    const double beta = 27.0 * m[0] * m[1] + 28.0 * m[0] * m[3] + 35.0 * m[2] * m[3];
    const double gamma = 3780.0 * m[0] * m[1] * m[2] * m[3];
    // (beta - sqrt(beta^2 - gamma)) / 18 without its cancellation.
    return std::sqrt(gamma / (18.0 * (beta + std::sqrt(beta * beta - gamma))));
}

struct Medium {
    double k;          // 1/mm
    double impedance;  // 1 / (D k)

    // Skin always absorbs a little (its bloodless absorption), so that k is never 0.
    Medium(const Layer& layer, DiffusionCurve::Coefficient coefficient)
        : k(coefficient == DiffusionCurve::Coefficient::classic ? classic_rate(layer)
                                                                : third_order_rate(layer)),
          impedance(k / layer.absorption) {}

    /// The field on the near side of a layer whose far side has `far`. Sums of positive numbers alone: no
    /// digit is lost.
    Field through(const Field& far, double thickness) const {
        const double e = std::exp(-2.0 * k * thickness);
        return {0.5 * ((1.0 + e) * far.fluence + (1.0 - e) * impedance * far.flux),
                0.5 * ((1.0 + e) * far.flux + (1.0 - e) * far.fluence / impedance),
                far.log_scale + k * thickness};
    }
};

}  // namespace

double DiffusionCurve::Form::at(double thickness) const {
    return log_scale - k * thickness - std::log1p(mirror * std::exp(-2.0 * k * thickness));
}

double diffuse_fresnel_reflectance(double refractive_index) {
    if (!(refractive_index >= 1.0 && std::isfinite(refractive_index))) {
        refuse_argument("refractive_index", to_text(refractive_index), "a finite number, 1 or more");
    }
    constexpr int points = 64;  // midpoint rule in the cosine: off by 1e-4, far less than the approximation
    double sum = 0.0;
    for (int i = 0; i < points; ++i) {
        const double outside = (i + 0.5) / points;
        const double inside =
            std::sqrt(1.0 - (1.0 - outside * outside) / (refractive_index * refractive_index));
        const double s = (outside - refractive_index * inside) / (outside + refractive_index * inside);
        const double p = (refractive_index * outside - inside) / (refractive_index * outside + inside);
        sum += outside * (s * s + p * p);
    }
    return sum / points;
}

DiffusionCurve::DiffusionCurve(const Tissue& tissue, double wavelength_nm, Coefficient coefficient)
    : epidermes_mm_(2.0 * tissue.epidermal_thickness_mm), thick_{}, thin_{} {
    const SkinMedia media = skin_media(tissue, wavelength_nm);
    const double entering = 1.0 - diffuse_fresnel_reflectance(tissue.refractive_index);
    // Reciprocity: light that enters a surface diffusely and light that leaves it do so in the ratio n^2.
    const double leaving = entering / (tissue.refractive_index * tissue.refractive_index);
    const double reflected = 1.0 - leaving;
    const Field far_surface{2.0 * (1.0 + reflected) / leaving, 1.0, 0.0};  // flux 1 leaves
    const auto incident = [&](const Field& near) {
        return (0.25 * leaving * near.fluence + 0.5 * (1.0 + reflected) * near.flux) / entering;
    };
    // Through the layer whose thickness varies, the incident flux is grown * exp(k d) + shrunk * exp(-k d).
    const auto form = [&](const Medium& varying, const Medium& outer, double outer_mm) {
        const Field far = outer.through(far_surface, outer_mm);
        const double both = varying.impedance * far.flux;
        const Field grown{0.5 * (far.fluence + both), 0.5 * (far.fluence + both) / varying.impedance, 0.0};
        const Field shrunk{0.5 * (far.fluence - both), 0.5 * (both - far.fluence) / varying.impedance, 0.0};
        const double growing = incident(outer.through(grown, outer_mm));
        const double log_scale = -far.log_scale - outer.k * outer_mm - std::log(growing);
        return Form{log_scale, varying.k, incident(outer.through(shrunk, outer_mm)) / growing};
    };
    const Medium epidermis(media.epidermis, coefficient);
    thick_ = form(Medium(media.inner, coefficient), epidermis, tissue.epidermal_thickness_mm);
    thin_ = form(epidermis, epidermis, 0.0);
}

double DiffusionCurve::log_transmittance(double total_thickness_mm) const {
    return total_thickness_mm < epidermes_mm_ ? thin_.at(total_thickness_mm)
                                              : thick_.at(total_thickness_mm - epidermes_mm_);
}

std::vector<double> diffusion_transmittance(const Tissue& tissue, std::span<const double> thickness_mm,
                                            std::span<const double> wavelength_nm) {
    for (const double thickness : thickness_mm) require_not_negative("thickness_mm", thickness);
    std::vector<double> result(thickness_mm.size() * wavelength_nm.size());
    for (std::size_t j = 0; j < wavelength_nm.size(); ++j) {
        const DiffusionCurve curve(tissue, wavelength_nm[j], DiffusionCurve::Coefficient::classic);
        for (std::size_t i = 0; i < thickness_mm.size(); ++i) {
            result[i * wavelength_nm.size() + j] = std::exp(curve.log_transmittance(thickness_mm[i]));
        }
    }
    return result;
}

}  // namespace skinglow
