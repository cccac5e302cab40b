#include "shape/sp3_medium.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numerics/quadrature.h"
#include "shape/surface_optics.h"

namespace skinglow::detail {
namespace {

struct Matrix2 {
    double a11, a12, a21, a22;

    Matrix2 operator*(const Matrix2& b) const {
        return {a11 * b.a11 + a12 * b.a21, a11 * b.a12 + a12 * b.a22, a21 * b.a11 + a22 * b.a21,
                a21 * b.a12 + a22 * b.a22};
    }
    Matrix2 transposed() const { return {a11, a21, a12, a22}; }
    Matrix2 inverse() const {
        const double scale = 1.0 / (a11 * a22 - a12 * a21);
        return {a22 * scale, -a12 * scale, -a21 * scale, a11 * scale};
    }
    std::array<double, 2> operator*(const std::array<double, 2>& v) const {
        return {a11 * v[0] + a12 * v[1], a21 * v[0] + a22 * v[1]};
    }
};

/// Boundary matrix and source of the unknowns phi of SP3.
struct Boundary {
    Matrix2 matrix;
    std::array<double, 2> source;
};

double p2(double x) {
    return 0.5 * (3 * x * x - 1);
}
double p3(double x) {
    return 0.5 * (5 * x * x * x - 3 * x);
}

/// Integral over the cosine from 0 to 1 of what has a kink at the critical angle.
template <typename Function>
double half_range(const Function& f, double critical) {
    return integrate<64>(f, 0.0, critical) + integrate<64>(f, critical, 1.0);
}

/// Marshak's conditions: the odd half-range moments, 1 and 3, of the radiance that goes inward are those of
/// what is reflected and what comes in. The radiance, integrated over azimuth, is even + odd with the even
/// part from the fluence and the second moment, the odd part from the two fluxes.
Boundary boundary_of(double n, ShapeSurface surface) {
    const DiffuseReflectance diffuse = diffuse_reflectance(n);
    const bool rough = surface == ShapeSurface::rough;
    const double critical = n > 1 ? std::sqrt(1 - 1 / (n * n)) : 0.0;
    const auto reflectance = [&](double x) { return rough ? 0.0 : fresnel_reflectance(n, 1.0, x); };
    const std::array<double (*)(double), 2> moment = {[](double x) { return x; }, p3};
    const std::array<double (*)(double), 2> even = {[](double) { return 0.5; },
                                                    [](double x) { return 2.5 * p2(x); }};
    const std::array<double (*)(double), 2> odd = {[](double x) { return 1.5 * x; },
                                                   [](double x) { return 3.5 * p3(x); }};
    const double diffuse_inside = rough ? diffuse.inside : 0.0;
    double a[2][2]{};
    double o[2][2]{};
    std::array<double, 2> s{};
    // Irradiance 1 from outside comes in as 2 T / E per unit of cosine: T constant where rough, Fresnel's n^2
    // (1 - R) where smooth.
    const auto entering = [&](double x) {
        return rough ? 2 * (1 - diffuse.outside) : 2 * n * n * (1 - reflectance(x));
    };
    for (std::size_t row = 0; row < 2; ++row) {
        for (std::size_t column = 0; column < 2; ++column) {
            const double even_flux = half_range([&](double x) { return x * even[column](x); }, critical);
            const double odd_flux = half_range([&](double x) { return x * odd[column](x); }, critical);
            const double back_even = 2 * diffuse_inside * even_flux;
            const double back_odd = 2 * diffuse_inside * odd_flux;
            a[row][column] = half_range(
                [&](double x) {
                    return moment[row](x) * ((1 - reflectance(x)) * even[column](x) - back_even);
                },
                critical);
            o[row][column] = half_range(
                [&](double x) { return moment[row](x) * ((1 + reflectance(x)) * odd[column](x) + back_odd); },
                critical);
        }
        s[row] = half_range([&](double x) { return moment[row](x) * entering(x); }, critical);
    }
    const Matrix2 to_flux = Matrix2{o[0][0], o[0][1], o[1][0], o[1][1]}.inverse();
    // From (phi1, phi2) to fluence and second moment: phi1 - 2/3 phi2, phi2 / 3.
    const Matrix2 moments{1, -2.0 / 3, 0, 1.0 / 3};
    Matrix2 matrix = to_flux * Matrix2{a[0][0], a[0][1], a[1][0], a[1][1]} * moments;
    // Of a smooth surface it is symmetric but for some 0.003, which a symmetric solver cannot have. The first row is
    // the flux of energy: it stays, so that what does not absorb returns what it gets.
    matrix.a21 = matrix.a12;
    return {matrix, to_flux * s};
}

/// The modes of the reaction: phi = vectors psi.
struct Modes {
    Matrix2 vectors;
    std::array<double, 2> decay;
};

Modes modes_of(double absorption, double st) {
    // Reaction over diffusion, D^-1/2 C D^-1/2, and its eigenvectors as a rotation. The smaller eigenvalue by
    // the determinant, which does not cancel where the absorption is small.
    const double c11 = 3 * st * absorption;
    const double c12 = -std::sqrt(21.0) * st * (2.0 / 3) * absorption;
    const double c22 = 7 * st * (4.0 / 9 * absorption + 5.0 / 9 * st);
    const double half_difference = 0.5 * (c22 - c11);
    const double large = 0.5 * (c11 + c22) + std::hypot(half_difference, c12);
    const double small = 21 * st * st * (5.0 / 9 * st * absorption) / large;
    const double angle = 0.5 * std::atan2(2 * c12, c11 - c22);  // of the larger one's eigenvector to axis 1
    const double root1 = std::sqrt(3 * st);
    const double root2 = std::sqrt(7 * st);
    // Columns: the smaller eigenvalue's vector first. phi = modes psi.
    const Matrix2 vectors{-root1 * std::sin(angle), root1 * std::cos(angle), root2 * std::cos(angle),
                          root2 * std::sin(angle)};
    return {vectors, {std::sqrt(small), std::sqrt(large)}};
}

/// The exitance of a half-space by the same equations: psi = (B + decay)^-1 s E at its surface, falling as
/// exp(-decay z); and the same last flight as the gather's, whose rays never come to another wall.
double half_space_exitance(const Sp3Medium& medium) {
    const double b11 = medium.boundary[0] + medium.decay[0];
    const double b22 = medium.boundary[2] + medium.decay[1];
    const double b12 = medium.boundary[1];
    const double scale = 1 / (b11 * b22 - b12 * b12);
    const std::array<double, 2> psi = {(b22 * medium.source[0] - b12 * medium.source[1]) * scale,
                                       (b11 * medium.source[1] - b12 * medium.source[0]) * scale};
    const double n = medium.refractive_index;
    const double critical = n > 1 ? std::sqrt(1 - 1 / (n * n)) : 0.0;
    double exitance = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto flight = [&](double mu) {
            return 2 * mu * (1 - fresnel_reflectance(n, 1.0, mu)) * medium.extinction /
                   (medium.extinction + medium.decay[i] * mu);
        };
        exitance += medium.fluence[i] * psi[i] * half_range(flight, critical);
    }
    return std::max(0.0, (1 - medium.inside_reflectance) * 0.25 * medium.albedo * exitance);
}

}  // namespace

Sp3Medium sp3_medium(double absorption, double reduced_scattering, double refractive_index,
                     ShapeSurface surface) {
    const double st = absorption + reduced_scattering;
    const Boundary boundary = boundary_of(refractive_index, surface);
    const Modes of = modes_of(absorption, st);
    const Matrix2& modes = of.vectors;
    const Matrix2 turned = modes.transposed() * boundary.matrix * modes;
    const std::array<double, 2> source = modes.transposed() * boundary.source;
    const bool rough = surface == ShapeSurface::rough;
    const DiffuseReflectance diffuse = diffuse_reflectance(refractive_index);
    Sp3Medium medium{
        .extinction = st,
        .albedo = reduced_scattering / st,
        .decay = {of.decay[0], of.decay[1]},
        .boundary = {turned.a11, 0.5 * (turned.a12 + turned.a21), turned.a22},
        .source = {source[0], source[1]},
        .fluence = {modes.a11 - 2.0 / 3 * modes.a21, modes.a12 - 2.0 / 3 * modes.a22},
        .refractive_index = rough ? 1.0 : refractive_index,
        .inside_reflectance = rough ? diffuse.inside : 0.0,
        .transmittance = rough ? 1 - diffuse.outside : 1.0,
        .half_space = 0,
    };
    medium.half_space = half_space_exitance(medium);
    return medium;
}

SurfaceLink surface_link(const Sp3Medium& medium, double depth) {
    SurfaceLink link{};
    for (int i = 0; i < 2; ++i) {
        const double x = std::min(medium.decay[i] * depth, 300.0);
        link.falloff[i] = 1 / std::cosh(x);
        link.depth[i] = x < 1e-6 ? depth : std::tanh(x) * depth / x;
    }
    const auto& b = medium.boundary;
    const Matrix2 through = Matrix2{1 + b[0] * link.depth[0], b[1] * link.depth[1], b[1] * link.depth[0],
                                    1 + b[2] * link.depth[1]}
                                .inverse();
    const Matrix2 flux = through * Matrix2{b[0] * link.falloff[0], b[1] * link.falloff[1],
                                           b[1] * link.falloff[0], b[2] * link.falloff[1]};
    const std::array<double, 2> source = through * std::array{medium.source[0], medium.source[1]};
    link.flux[0][0] = flux.a11;
    link.flux[0][1] = flux.a12;
    link.flux[1][0] = flux.a21;
    link.flux[1][1] = flux.a22;
    link.source[0] = source[0];
    link.source[1] = source[1];
    return link;
}

Sp3Medium at_round_surface(Sp3Medium medium, double curvature) {
    const double n = medium.refractive_index;
    const bool smooth = n > 1;
    const double inside = smooth ? diffuse_reflectance(n).inside : medium.inside_reflectance;
    const double free_share = (1 - inside) / (1 + inside);
    const double strength = free_share * (0.5 + (smooth ? 1.25 * (1 - free_share) : 0.0));
    double* b = medium.boundary;
    const double least = 0.5 * (b[0] + b[2]) - std::hypot(0.5 * (b[0] - b[2]), b[1]);
    // Where the body is hollow, the condition stays one that lets light out.
    const double more = std::max(strength * curvature, -0.5 * least);
    std::array<double, 2> in_balance =
        Matrix2{b[0], b[1], b[1], b[2]}.inverse() * std::array{medium.source[0], medium.source[1]};
    if (smooth) {
        // Its B is made symmetric, and so has another balance than the light: fluence 4 n^2 E, alike in all directions.
        const double absorption = medium.extinction * (1 - medium.albedo);
        in_balance = modes_of(absorption, medium.extinction).vectors.inverse() * std::array{4 * n * n, 0.0};
    }
    for (std::size_t i = 0; i < 2; ++i) medium.source[i] += more * in_balance[i];
    b[0] += more;
    b[2] += more;
    return medium;
}

LaneMedium::LaneMedium(std::span<const Sp3Medium> media)
    : media_(media.begin(), media.end()), nodes_(media.size()) {
    while (media_.size() < lane_count) media_.push_back(media_.back());
}

double LaneMedium::min_decay() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Sp3Medium& medium : media_) least = std::min(least, medium.decay[0]);
    return least;
}

double LaneMedium::min_extinction() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Sp3Medium& medium : media_) least = std::min(least, medium.extinction);
    return least;
}

SurfaceLinks::SurfaceLinks(const LaneMedium& medium, double max_depth)
    : bins_per_mm_(static_cast<float>(bins / max_depth)) {
    free_path_ = medium.lanes([](const Sp3Medium& m) { return 1 / m.extinction; });
    links_.reserve((2 * rounds + 1) * (bins + 1) * lane_count);
    for (std::size_t r = 0; r <= 2 * rounds; ++r) {
        std::vector<Sp3Medium> media;
        for (std::size_t k = 0; k < lane_count; ++k) {
            const double turn = static_cast<double>(r) / rounds - 1;
            media.push_back(at_round_surface(medium[k], turn * medium[k].extinction));
        }
        for (std::size_t b = 0; b <= bins; ++b) {
            for (const Sp3Medium& m : media)
                links_.push_back(surface_link(m, max_depth * static_cast<double>(b) / bins));
        }
    }
}

}  // namespace skinglow::detail
