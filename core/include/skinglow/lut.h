#pragma once

#include <skinglow/tissue.h>

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

/// Lookup tables of light coming through skin, by its thickness.
/// @code
/// const skinglow::BaseLut base = skinglow::base_lut(skinglow::tissue_preset("light").tissue);
/// const std::vector<glm::dvec3> exitance = skinglow::recolor(base, {1.0, 0.8, 0.6});  // W/m^2
/// @endcode
namespace skinglow {

/// Most entries a table may have: hosts hold it as an image one texel high, and none needs more.
constexpr std::size_t max_lut_size = 65536;
/// Where nothing says how many entries a table has, and how thick the skin of the last one is.
constexpr std::size_t default_lut_size = 256;
constexpr double default_max_thickness_mm = 12.0;

/// How a table is made of the lights. A mode's name is the enumerator's.
enum class LutMode {
    existing,  ///< the six-Gaussian lookup, which knows no lights
    paper,     ///< gray base * (B + L) of Kim et al.
    physical   ///< M(d) E of solved skin, E the lights' irradiance
};
std::string_view to_text(LutMode mode);
/// The mode of that name; throws std::invalid_argument, with the names there are, on any other.
LutMode lut_mode(std::string_view name);

/// The thickness axis of a table: entry i stands for i / (size - 1) of the largest thickness, so that the
/// first is skin of no thickness and the last the thickest. The one entry of a table of size 1 stands for
/// thickness 0 and is used everywhere.
class LutAxis {
  public:
    /// Throws std::invalid_argument.
    /// @param size 1 to max_lut_size
    /// @param max_thickness_mm finite, above 0
    LutAxis(std::size_t size, double max_thickness_mm);

    std::size_t size() const { return size_; }
    double max_thickness_mm() const { return max_thickness_mm_; }
    /// Thickness of entry i, mm.
    double thickness_mm(std::size_t i) const;
    /// All of them, ascending, mm.
    std::vector<double> thickness_mm() const;

    /// Images hold entry i at the center of texel i. The image coordinate of a thickness is
    /// u = texel_scale * thickness + texel_offset; clamp u to the image and the table is clamped at both
    /// ends.
    double texel_scale() const;   ///< 1/mm
    double texel_offset() const;  ///< in [0, 1]

  private:
    std::size_t size_;
    double max_thickness_mm_;
};

/// What thin skin does to light, before any light is known: for each thickness d the 3x3 matrix M(d) that
/// turns linear Rec.709 light on the far side into linear Rec.709 light coming through (docs/method.md). The
/// paper's gray lookup image BLL is M(d) = BLL(d) * identity.
class BaseLut {
  public:
    /// From brightness. Throws std::invalid_argument that names the entry.
    /// @param gray one value per entry, finite, 0 or more; 1 is full brightness, more is allowed
    /// @param max_thickness_mm of the last entry, as for LutAxis
    static BaseLut from_gray(std::span<const double> gray, double max_thickness_mm);

    /// Throws std::invalid_argument that names the entry, also on an empty or too long table.
    /// @param matrices one per entry, finite (entries off the diagonal may be negative: linear Rec.709 is a
    ///        small gamut)
    /// @param max_thickness_mm of the last entry, as for LutAxis
    BaseLut(std::vector<glm::dmat3> matrices, double max_thickness_mm);

    const LutAxis& axis() const { return axis_; }
    std::size_t size() const { return matrices_.size(); }
    std::span<const glm::dmat3> matrices() const { return matrices_; }

  private:
    LutAxis axis_;
    std::vector<glm::dmat3> matrices_;
};

/// How a table of skin was solved, and how far off it is.
///
/// The error is in one norm. At each entry and for each primary (column j of M) it is the largest difference
/// in column j over the largest number of column j, or over 1e-6 where skin lets even less through:
///     max over entries and j of  max_i |M_ij - exact_ij| / max(max_i |exact_ij|, 1e-6).
/// So deep red skin has as many right digits as thin skin, and so has the little that blue light brings
/// through. Exact means: in the limit of infinitely many streams.
struct SkinLutReport {
    int streams = 0;             ///< directions per hemisphere
    double estimated_error = 0;  ///< bound on the error, from that of random skins at these streams
};

struct SkinLut {
    BaseLut lut;
    SkinLutReport report;
};

constexpr double default_lut_tolerance = 1e-3;
constexpr double min_lut_tolerance = 1e-6;
constexpr double max_lut_tolerance = 0.1;

/// The base lookup table of mode `physical`: M(d), the light that leaves skin d thick lit diffusely from
/// behind (exitance over irradiance, linear Rec.709 to linear Rec.709), from the layered transport solution
/// at every entry and every wavelength of the 5 nm grid, with the fewest streams that meet the tolerance.
/// At d = 0 two bare surfaces are left, which still reflect: M(0) is below the identity.
/// Throws std::invalid_argument.
/// @param tissue in range (tissue_parameters)
/// @param size as for LutAxis
/// @param max_thickness_mm as for LutAxis
/// @param tolerance largest error, in SkinLutReport's norm, 1e-6 to 0.1
/// @param threads 0: one for each processor
BaseLut base_lut(const Tissue& tissue, std::size_t size = default_lut_size,
                 double max_thickness_mm = default_max_thickness_mm, double tolerance = default_lut_tolerance,
                 int threads = 0);

/// base_lut with its report. Parameters and errors as for base_lut.
SkinLut base_lut_report(const Tissue& tissue, std::size_t size = default_lut_size,
                        double max_thickness_mm = default_max_thickness_mm,
                        double tolerance = default_lut_tolerance, int threads = 0);

/// The same table with as many streams as the caller says: what base_lut is measured by.
/// Throws std::invalid_argument.
/// @param tissue as for base_lut
/// @param size as for LutAxis
/// @param max_thickness_mm as for LutAxis
/// @param streams as for slab
/// @param threads 0: one for each processor
BaseLut reference_lut(const Tissue& tissue, std::size_t size, double max_thickness_mm, int streams,
                      int threads = 0);

/// The error of one table against another in SkinLutReport's norm.
/// @param lut whose error is wanted
/// @param exact of the same size, else std::invalid_argument
double lut_error(const BaseLut& lut, const BaseLut& exact);

/// The existing method, the one to improve on: light through skin of thickness d by the six-Gaussian skin
/// profile, linear Rec.709, one color per entry of the axis, white at d = 0 to the three digits of its
/// weights. It is reddish and knows no lights.
///
/// T(d) = sum_i w_i exp(-d^2 / v_i), with variances v_i and weights w_i of E. d'Eon and D. Luebke, "Advanced
/// Techniques for Realistic Real-Time Skin Rendering", GPU Gems 3 (2007), ch. 14, in the form in which
/// real-time shaders use the profile for translucency (J. Jimenez et al., "Real-Time Realistic Skin
/// Translucency", IEEE CG&A 30(4), 2010).
std::vector<glm::dvec3> six_gaussian_lookup(const LutAxis& axis);

/// The paper's base lookup `BLL` when none is given: the brightness (Rec.709 luminance) of the existing
/// lookup.
BaseLut six_gaussian_base(const LutAxis& axis);

/// The paper's B: blood reddens what comes through (Kim et al., value given with Eq. 1). Mode `paper` alone
/// adds it.
constexpr glm::dvec3 paper_blood_weight{1.8, 0.5, 0.4};

/// The recolored table M(d) * weight, one linear Rec.709 color per entry; values above 1 are kept.
/// Mode `paper` (Eq. 1): a gray base and weight = B + L. Mode `physical`: weight = E, W/m^2, on the far side.
/// Throws std::invalid_argument, also where a product is beyond the largest double.
/// @param base the table
/// @param weight linear Rec.709, finite
std::vector<glm::dvec3> recolor(const BaseLut& base, const glm::dvec3& weight);

/// The same into the caller's memory; allocates nothing.
/// @param base the table
/// @param weight linear Rec.709, finite
/// @param out exactly as many entries as the base
void recolor(const BaseLut& base, const glm::dvec3& weight, std::span<glm::dvec3> out);

/// What an image of a table shows at a thickness: linear between the centers of texels, its ends continued.
/// Throws std::invalid_argument that names the entry.
/// @param colors         of the table, one or more, finite
/// @param texel_scale    of the table's axis, finite
/// @param texel_offset   of the table's axis, finite
/// @param thickness_mm   finite
std::vector<glm::dvec3> table_at(std::span<const glm::dvec3> colors, double texel_scale, double texel_offset,
                                 std::span<const double> thickness_mm);

}  // namespace skinglow
