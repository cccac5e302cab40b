#pragma once

#include <skinglow/angular_weight.h>
#include <skinglow/slab.h>

#include <array>
#include <span>
#include <string_view>
#include <vector>

/// Human skin as plane layers: epidermis / dermis / epidermis, as at an ear. What is modeled, every constant
/// and where it comes from: docs/optics.md. Wavelengths nm, thicknesses mm, coefficients 1/mm.
/// @code
/// const skinglow::Tissue& skin = skinglow::tissue_preset("light").tissue;
/// const std::vector<double> red = skinglow::transmittance(skin, std::array{1.0, 3.0}, std::array{650.0});
/// @endcode
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

/// Absorption of whole blood (150 g/L), 1/mm. Throws std::invalid_argument.
/// @param wavelength_nm 380 to 780
/// @param oxygen_saturation 0 to 1
double blood_absorption(double wavelength_nm, double oxygen_saturation);
/// Absorption of a melanosome's inside, 1/mm.
double melanosome_absorption(double wavelength_nm);
/// Absorption of skin without blood and melanin, 1/mm.
double bloodless_absorption(double wavelength_nm);

/// The epidermis and the inner layer (dermis, with cartilage mixed in by volume) at one wavelength.
/// The inner layer's thickness is 0: skin_layers gives it what the total leaves.
struct SkinMedia {
    Layer epidermis;
    Layer inner;
};
/// Throws std::invalid_argument.
/// @param tissue in range (tissue_parameters)
/// @param wavelength_nm 380 to 780
SkinMedia skin_media(const Tissue& tissue, double wavelength_nm);

/// How a total thickness is divided: the epidermes keep theirs and the inner layer takes the rest. Skin
/// thinner than its two epidermes is epidermis alone, half on either side, so that transmittance is
/// continuous and falls everywhere.
struct SkinThickness {
    double epidermis_mm;  ///< each of the two
    double inner_mm;
};
/// Throws std::invalid_argument.
/// @param tissue whose epidermal thickness counts
/// @param total_thickness_mm finite, 0 or more
SkinThickness split_thickness(const Tissue& tissue, double total_thickness_mm);

/// Epidermis, inner layer and epidermis of skin, from top to bottom, for slab. Throws std::invalid_argument.
/// @param tissue in range (tissue_parameters)
/// @param total_thickness_mm epidermes included, finite, 0 or more
/// @param wavelength_nm 380 to 780
std::vector<Layer> skin_layers(const Tissue& tissue, double total_thickness_mm, double wavelength_nm);

/// Total transmittance of skin in air, row by row: out[i * wavelengths + j] at thickness i and wavelength j.
/// Continuous and falling with thickness. At thickness 0 the two surfaces still reflect.
/// Throws std::invalid_argument.
/// @param tissue in range (tissue_parameters)
/// @param thickness_mm epidermes included, finite, 0 or more, in any order (ascending is fastest)
/// @param wavelength_nm 380 to 780, in any order
/// @param incidence light from above
/// @param streams as for slab
/// @param threads that divide the wavelengths; 0: one for each processor
std::vector<double> transmittance(const Tissue& tissue, std::span<const double> thickness_mm,
                                  std::span<const double> wavelength_nm,
                                  Incidence incidence = Incidence::diffuse(), int streams = 16,
                                  int threads = 0);

/// Where the angular weight of each channel is solved: the dominant wavelengths of the Rec.709 primaries, nm
/// (of their chromaticities in ITU-R BT.709-6 against D65, by the CIE 1931 observer).
constexpr std::array<double, 3> primary_wavelengths_nm = {611.4, 549.1, 464.2};

/// How the light that strikes a skin's far side enters by its angle: w(mu) = T(mu) / T_diffuse from the
/// layered transport solution. It hardly depends on the thickness: light that was scattered often has lost
/// its direction (docs/accuracy.md has the figures). Throws std::invalid_argument.
/// @param tissue in range (tissue_parameters)
/// @param thickness_mm typical of the object, above 0
/// @param streams as for slab
AngularWeight skin_angular_weight(const Tissue& tissue, double thickness_mm = 4.0, int streams = 16);

}  // namespace skinglow
