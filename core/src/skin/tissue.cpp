#include <skinglow/tissue.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>

#include "numerics/argument_check.h"
#include "skin/skin_optics.h"
#include "spectral_tables.h"

namespace skinglow {
namespace {

constexpr double per_cm = 0.1;  // 1/cm in 1/mm

// The ranges hold human skin with room on either side; docs/optics.md says where human skin lies.
constexpr std::array<TissueParameter, 7> parameters = {{
    {"melanin_fraction", &Tissue::melanin_fraction, 0.0, 0.5, "1",
     "melanosomes, volume fraction of the epidermis"},
    {"blood_fraction", &Tissue::blood_fraction, 0.0, 0.1, "1",
     "whole blood of 150 g/L hemoglobin, volume fraction of the dermis"},
    {"oxygen_saturation", &Tissue::oxygen_saturation, 0.0, 1.0, "1", "oxygenated part of the hemoglobin"},
    {"epidermal_thickness_mm", &Tissue::epidermal_thickness_mm, 0.0, 0.3, "mm",
     "thickness of each of the two epidermes"},
    {"scattering_scale", &Tissue::scattering_scale, 0.1, 3.0, "1",
     "multiplies the scattering of every layer"},
    {"refractive_index", &Tissue::refractive_index, 1.0, 1.6, "1", "of every layer; outside is air"},
    {"cartilage_fraction", &Tissue::cartilage_fraction, 0.0, 1.0, "1",
     "cartilage, volume fraction of the inner layer"},
}};

// Melanin: the three groups of S. L. Jacques, "Skin optics", Oregon Medical Laser Center News, January 1998
// (light 1.3-6.3 %, moderate 11-16 %, dark 18-43 %), their ends or middles. Blood and oxygen: docs/optics.md.
constexpr std::array<TissuePreset, 9> presets = {{
    {"very_light", {.melanin_fraction = 0.013}, "Least melanin of light skin (1.3 %), usual blood (1 %)."},
    {"light", {}, "Light skin: the middle of its melanin range (3.8 %), usual blood (1 %)."},
    {"medium",
     {.melanin_fraction = 0.135},
     "Moderately pigmented skin: the middle of its melanin range (13.5 %)."},
    {"dark", {.melanin_fraction = 0.305}, "Dark skin: the middle of its melanin range (30.5 %)."},
    {"very_dark", {.melanin_fraction = 0.43}, "Most melanin of dark skin (43 %)."},
    {"pale", {.blood_fraction = 0.002}, "Light skin with little blood (0.2 %): cold, or pressed."},
    {"flushed",
     {.blood_fraction = 0.05, .oxygen_saturation = 0.9},
     "Light skin full of fresh blood (5 %, 90 % oxygenated): blushing, or warm from exercise."},
    {"cyanotic",
     {.blood_fraction = 0.03, .oxygen_saturation = 0.6},
     "Light skin with much blood short of oxygen (3 %, 60 % oxygenated): bluish lips and ears."},
    {"ear",
     {.blood_fraction = 0.02, .epidermal_thickness_mm = 0.03, .cartilage_fraction = 0.3},
     "Upper ear, light skin: thin epidermes (0.03 mm, as behind the ear) around dermis with 30 % cartilage."},
}};

double require_wavelength(double wavelength_nm) {
    return require_between("wavelength_nm", wavelength_nm, min_wavelength_nm, max_wavelength_nm, " nm");
}

/// Rayleigh and Mie part of the reduced scattering, S. L. Jacques, "Optical properties of biological tissues:
/// a review", Phys. Med. Biol. 58:R37 (2013), Eq. 2 and table 1.
struct ReducedScattering {
    double at_500_nm;  // 1/cm
    double rayleigh_fraction;
    double mie_exponent;

    double per_mm(double wavelength_nm) const {
        const double x = wavelength_nm / 500.0;
        return per_cm * at_500_nm *
               (rayleigh_fraction * std::pow(x, -4.0) +
                (1.0 - rayleigh_fraction) * std::pow(x, -mie_exponent));
    }
};
constexpr ReducedScattering epidermal_scattering{66.7, 0.29, 0.689};
constexpr ReducedScattering dermal_scattering{43.6, 0.41, 0.562};

/// Through the values at 450, 500, 600 and 700 nm of the project's optics notes (docs/optics.md), linear
/// between and beyond.
double epidermal_anisotropy(double wavelength_nm) {
    constexpr std::array<double, 4> nm{450.0, 500.0, 600.0, 700.0};
    constexpr std::array<double, 4> g{0.730, 0.745, 0.774, 0.804};
    const auto above = std::upper_bound(nm.begin() + 1, nm.end() - 1, wavelength_nm);
    const auto i = static_cast<std::size_t>(std::distance(nm.begin(), above)) - 1;
    return g[i] + (g[i + 1] - g[i]) * (wavelength_nm - nm[i]) / (nm[i + 1] - nm[i]);
}
constexpr double dermal_anisotropy = 0.715;  // as above; used for cartilage too

/// Power laws through the ends of the Kubelka-Munk spectra of D. W. Ebert et al., "Articular cartilage
/// optical properties in the spectral range 300-850 nm", J. Biomed. Opt. 3(3):326 (1998): K from 7 /cm at 330
/// nm to 1 /cm at 850 nm, S from 40 /cm at 360 nm to 6 /cm at 850 nm; K = 2 mua and S = (3 mus' - mua) / 4
/// (M. J. C. van Gemert and W. M. Star, Lasers Life Sci. 1:287, 1987). Cartilage holds no blood.
double cartilage_absorption(double wavelength_nm) {
    static const double exponent = std::log(7.0) / std::log(850.0 / 330.0);
    return per_cm * 0.5 * std::pow(wavelength_nm / 850.0, -exponent);
}
double cartilage_reduced_scattering(double wavelength_nm) {
    static const double exponent = std::log(40.0 / 6.0) / std::log(850.0 / 360.0);
    const double kubelka_munk = per_cm * 6.0 * std::pow(wavelength_nm / 850.0, -exponent);
    return (4.0 * kubelka_munk + cartilage_absorption(wavelength_nm)) / 3.0;
}

// Of a tissue in range.
SkinMedia media_at(const Tissue& tissue, double wavelength_nm) {
    const double bloodless = bloodless_absorption(wavelength_nm);
    const double melanin = tissue.melanin_fraction;
    const double blood = tissue.blood_fraction;
    const double cartilage = tissue.cartilage_fraction;
    const double g = epidermal_anisotropy(wavelength_nm);
    const double dermal_absorption =
        blood * blood_absorption(wavelength_nm, tissue.oxygen_saturation) + (1.0 - blood) * bloodless;
    const double inner_reduced = (1.0 - cartilage) * dermal_scattering.per_mm(wavelength_nm) +
                                 cartilage * cartilage_reduced_scattering(wavelength_nm);
    const double scale = tissue.scattering_scale;
    return {.epidermis = {.refractive_index = tissue.refractive_index,
                          .absorption =
                              melanin * melanosome_absorption(wavelength_nm) + (1.0 - melanin) * bloodless,
                          .scattering = scale * epidermal_scattering.per_mm(wavelength_nm) / (1.0 - g),
                          .anisotropy = g,
                          .thickness = tissue.epidermal_thickness_mm},
            .inner = {.refractive_index = tissue.refractive_index,
                      .absorption = (1.0 - cartilage) * dermal_absorption +
                                    cartilage * cartilage_absorption(wavelength_nm),
                      .scattering = scale * inner_reduced / (1.0 - dermal_anisotropy),
                      .anisotropy = dermal_anisotropy,
                      .thickness = 0.0}};
}

}  // namespace

std::span<const TissueParameter> tissue_parameters() {
    return parameters;
}

void validate(const Tissue& tissue) {
    for (const TissueParameter& parameter : parameters) {
        const double value = tissue.*parameter.field;
        if (!(value >= parameter.minimum && value <= parameter.maximum)) {
            std::string unit;
            if (parameter.unit != "1") unit.append(" ").append(parameter.unit);
            refuse_argument(parameter.name, to_text(value) + unit,
                            to_text(parameter.minimum) + " to " + to_text(parameter.maximum) + unit);
        }
    }
}

std::span<const TissuePreset> tissue_presets() {
    return presets;
}

const TissuePreset& tissue_preset(std::string_view name) {
    std::string names;
    for (const TissuePreset& preset : presets) {
        if (preset.name == name) return preset;
        names += names.empty() ? "" : ", ";
        names += preset.name;
    }
    refuse_argument("skin preset", std::string("\"").append(name).append("\""), names);
}

double blood_absorption(double wavelength_nm, double oxygen_saturation) {
    require_wavelength(wavelength_nm);
    require_between("oxygen_saturation", oxygen_saturation, 0, 1);
    // The tables are even: 380 to 780 nm in steps of 2.
    constexpr double step_nm = 2.0;
    static_assert(tables::hemoglobin[0][0] == min_wavelength_nm && tables::hemoglobin[1][0] == 382.0);
    static_assert(tables::hemoglobin[std::size(tables::hemoglobin) - 1][0] == max_wavelength_nm);
    const double entry = (wavelength_nm - min_wavelength_nm) / step_nm;
    const auto i = std::min(static_cast<std::size_t>(entry), std::size(tables::hemoglobin) - 2);
    const double t = entry - static_cast<double>(i);
    const auto extinction = [&](std::size_t row) {
        return oxygen_saturation * tables::hemoglobin[row][1] +
               (1.0 - oxygen_saturation) * tables::hemoglobin[row][2];
    };
    // Extinction is decadic and molar, 1/cm per mol/L: ln 10 makes it natural, 150 g/L over 64500 g/mol is
    // whole blood.
    constexpr double hemoglobin_mol_per_l = 150.0 / 64500.0;
    return per_cm * std::numbers::ln10 * hemoglobin_mol_per_l *
           ((1.0 - t) * extinction(i) + t * extinction(i + 1));
}

double melanosome_absorption(double wavelength_nm) {
    // S. L. Jacques, "Optical absorption of melanin", Oregon Medical Laser Center, omlc.org/spectra/melanin.
    return per_cm * 1.70e12 * std::pow(require_wavelength(wavelength_nm), -3.48);
}

double bloodless_absorption(double wavelength_nm) {
    // Jacques 1998, as the presets: measured on bloodless rat skin, which he found close to that of newborn
    // children.
    return per_cm * (0.244 + 85.3 * std::exp(-(require_wavelength(wavelength_nm) - 154.0) / 66.2));
}

SkinMedia skin_media(const Tissue& tissue, double wavelength_nm) {
    return SkinOptics(tissue, {&wavelength_nm, 1}).media.front();
}

namespace detail {

SkinOptics::SkinOptics(const Tissue& tissue, std::span<const double> wavelength_nm) {
    validate(tissue);
    media.reserve(wavelength_nm.size());
    for (const double nm : wavelength_nm) media.push_back(media_at(tissue, nm));
}

}  // namespace detail

SkinThickness split_thickness(const Tissue& tissue, double total_thickness_mm) {
    require_not_negative("total_thickness_mm", total_thickness_mm);
    const double epidermis = std::min(tissue.epidermal_thickness_mm, 0.5 * total_thickness_mm);
    return {epidermis, std::max(0.0, total_thickness_mm - 2.0 * epidermis)};
}

std::vector<Layer> skin_layers(const Tissue& tissue, double total_thickness_mm, double wavelength_nm) {
    SkinMedia media = skin_media(tissue, wavelength_nm);
    const SkinThickness thickness = split_thickness(tissue, total_thickness_mm);
    media.epidermis.thickness = thickness.epidermis_mm;
    media.inner.thickness = thickness.inner_mm;
    return {media.epidermis, media.inner, media.epidermis};
}

}  // namespace skinglow
