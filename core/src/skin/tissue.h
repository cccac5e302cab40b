#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "slab/slab_solver.h"

/// Human skin as plane layers: epidermis / dermis / epidermis, as at an ear. What is modelled, every constant
/// and where it comes from: docs/optics.md. Wavelengths nm, thicknesses mm, coefficients 1/mm.
namespace skinglow {

/// A piece of skin. Ranges: tissue_parameters().
struct Tissue {
    double melanin_fraction = 0.038;  ///< melanosomes, volume fraction of the epidermis
    double blood_fraction = 0.01;     ///< whole blood of 150 g/L hemoglobin, volume fraction of the dermis
    double oxygen_saturation = 0.75;  ///< oxygenated part of the hemoglobin
    double epidermal_thickness_mm = 0.06;  ///< of each of the two epidermes, mm
    double scattering_scale = 1.0;         ///< multiplies the scattering of every layer
    double refractive_index = 1.4;         ///< of every layer; outside is air
    double cartilage_fraction = 0.0;       ///< cartilage, volume fraction of the inner layer
};

/// One number of a Tissue, as a slider shows it.
struct TissueParameter {
    std::string_view name;
    double Tissue::*field;
    double minimum;
    double maximum;
    std::string_view unit;  ///< "mm", or "1" for a fraction or factor
    std::string_view description;
};

/// All of them, in the order of the struct.
std::span<const TissueParameter> tissue_parameters();

/// Throws std::invalid_argument, naming parameter, value and range, on a value that is not finite or out of
/// range.
void validate(const Tissue& tissue);

/// A named skin and the line that says what it stands for.
struct TissuePreset {
    std::string_view name;
    Tissue tissue;
    std::string_view description;
};

/// The range of human skin by name; sources in docs/optics.md.
std::span<const TissuePreset> tissue_presets();

/// The preset of that name; throws std::invalid_argument, with the names there are, on any other.
const TissuePreset& tissue_preset(std::string_view name);

/// Where the absorption of blood is tabulated, nm; every function of wavelength below refuses others
/// (std::invalid_argument).
constexpr double min_wavelength_nm = 380.0;
constexpr double max_wavelength_nm = 780.0;

/// Absorption of whole blood (150 g/L), 1/mm. @param oxygen_saturation in [0, 1]
double blood_absorption(double wavelength_nm, double oxygen_saturation);
/// Absorption of a melanosome's inside, 1/mm.
double melanosome_absorption(double wavelength_nm);
/// Absorption of skin without blood and melanin, 1/mm.
double bloodless_absorption(double wavelength_nm);

/// The epidermis and the inner layer (dermis, with cartilage mixed in by volume) at one wavelength.
/// The inner layer's thickness is 0: it takes what `layers` gives it.
struct SkinMedia {
    Layer epidermis;
    Layer inner;
};
SkinMedia skin_media(const Tissue& tissue, double wavelength_nm);

/// How a total thickness is shared out: the epidermes keep theirs and the inner layer takes the rest. Skin
/// thinner than its two epidermes is epidermis alone, half on either side, so that transmittance is
/// continuous and falls everywhere.
struct SkinThickness {
    double epidermis_mm;  ///< each of the two
    double inner_mm;
};
/// @param total_thickness_mm finite, 0 or more, else std::invalid_argument.
SkinThickness share_thickness(const Tissue& tissue, double total_thickness_mm);

/// Epidermis, inner layer, epidermis of skin `total_thickness_mm` thick, for solve_slab.
std::vector<Layer> layers(const Tissue& tissue, double total_thickness_mm, double wavelength_nm);

}  // namespace skinglow
