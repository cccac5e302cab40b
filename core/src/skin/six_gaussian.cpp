#include <skinglow/lut.h>
#include <skinglow/spectrum.h>

#include <array>
#include <cmath>

namespace skinglow {
namespace {

struct ProfileTerm {
    double variance;    // mm^2
    glm::dvec3 weight;  // linear RGB, each column sums to 1
};

// d'Eon and Luebke 2007, the table of section 14.4.4.
constexpr std::array<ProfileTerm, 6> skin_profile = {{{0.0064, {0.233, 0.455, 0.649}},
                                                      {0.0484, {0.100, 0.336, 0.344}},
                                                      {0.187, {0.118, 0.198, 0.000}},
                                                      {0.567, {0.113, 0.007, 0.007}},
                                                      {1.99, {0.358, 0.004, 0.000}},
                                                      {7.41, {0.078, 0.000, 0.000}}}};

}  // namespace

std::vector<glm::dvec3> six_gaussian_lookup(const LutAxis& axis) {
    std::vector<glm::dvec3> colors(axis.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < axis.size(); ++i) {
        const double thickness = axis.thickness_mm(i);
        for (const ProfileTerm& term : skin_profile) {
            // Divided before multiplied: the square of a thickness of 1e200 mm would overflow.
            colors[i] += term.weight * std::exp(-thickness * (thickness / term.variance));
        }
    }
    return colors;
}

BaseLut six_gaussian_base(const LutAxis& axis) {
    std::vector<double> brightness;
    brightness.reserve(axis.size());
    for (const glm::dvec3& color : six_gaussian_lookup(axis)) brightness.push_back(luminance(color));
    return BaseLut::from_gray(brightness, axis.max_thickness_mm());
}

}  // namespace skinglow
