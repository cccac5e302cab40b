#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "shape/lanes.h"

namespace skinglow::detail {

/// What the surface of a body does to light that crosses it.
enum class ShapeSurface { rough, smooth };

/// A medium at one spectral node, as two modes of SP3 (A. D. Klose and E. W. Larsen, "Light transport in
/// biological tissue based on the simplified spherical harmonics equations", J. Comput. Phys. 220, 2006).
/// With st = reduced scattering + absorption, D1 = 1 / (3 st), D2 = 1 / (7 st) the two unknowns of SP3 obey
/// -div D1 grad phi1 + a phi1 - 2/3 a phi2 = 0,   -div D2 grad phi2 - 2/3 a phi1 + (4/9 a + 5/9 st) phi2 = 0
/// inside and, with the normal pointing outward and E the diffuse irradiance, (-D grad phi) . n = B phi - s E
/// on the surface. Here they are turned to the eigenvectors of the reaction, psi, which meet at the surface
/// only: -laplace psi_i + decay_i^2 psi_i = 0,   -d psi / dn = B psi - s E
struct Sp3Medium {
    double extinction;          ///< reduced scattering + absorption, 1/mm
    double albedo;              ///< reduced scattering over extinction
    double decay[2];            ///< 1/mm, ascending, 0 or more
    double boundary[3];         ///< B: 11, 12, 22; symmetric, positive
    double source[2];           ///< s
    double fluence[2];          ///< fluence = fluence[0] psi_1 + fluence[1] psi_2
    double refractive_index;    ///< of the smooth surface that rays meet; 1 of a rough one
    double inside_reflectance;  ///< of a rough surface for light from inside; 0 of a smooth one
    double transmittance;       ///< of a rough surface for light from outside; 1 of a smooth one
    double half_space;          ///< exitance of a half-space of the medium over its diffuse irradiance
};

/// @param absorption          1/mm, 0 or more
/// @param reduced_scattering  1/mm, 0 or more, not both 0
/// @param refractive_index    1 or more, outside is air
Sp3Medium sp3_medium(double absorption, double reduced_scattering, double refractive_index,
                     ShapeSurface surface);

/// How the modes at a depth below a plane surface hang together with those at it, exactly as in one
/// dimension: with C = cosh(decay depth) and T = tanh(decay depth) / decay the flux out of the surface is F =
/// (1 + B T)^-1 (B C^-1 psi - s E),   psi at the surface = C^-1 psi - T F
struct SurfaceLink {
    double falloff[2];  ///< 1 / C
    double depth[2];    ///< T, mm
    double flux[2][2];  ///< F of psi: (1 + B T)^-1 B C^-1
    double source[2];   ///< and less this times E: (1 + B T)^-1 s

    /// What the surface adds to the equations of a cell, per area: symmetric, 11, 12, 22.
    double block(int i) const {
        return i == 0 ? falloff[0] * flux[0][0]
                      : (i == 1 ? 0.5 * (falloff[0] * flux[0][1] + falloff[1] * flux[1][0])
                                : falloff[1] * flux[1][1]);
    }
    /// And to their right side, per area and irradiance.
    double right(int i) const { return falloff[i] * source[i]; }
};
SurfaceLink surface_link(const Sp3Medium& medium, double depth);

/// The medium with the condition of a surface that is round: B + c curvature, s + c curvature B^-1 s with c = r / 2 and
/// r = (1 - Ri) / (1 + Ri), Ri the reflectance of the surface for diffuse light from inside; c = r / 2 + 5/4 r (1 - r)
/// where a smooth surface has an index and focuses besides. Marshak's condition is that of a plane: light leaves a ball
/// more easily, as more of what arrives comes straight from its inside. c is chosen by the Monte Carlo of balls of 1.5
/// to 6 mm; a sphere by itself in the transport theory of isotropic scattering has c = 1. Light in equilibrium with
/// what falls on the body stays as it is. Hollow surfaces change B by half of its least eigenvalue at most.
/// @param curvature  mean, 1/mm, above 0 where the body is convex; up to the extinction either way
Sp3Medium at_round_surface(Sp3Medium medium, double curvature);

/// The media of all nodes, lane by lane; the last one fills the lanes that are left.
class LaneMedium {
  public:
    /// @param media  1 to lane_count
    explicit LaneMedium(std::span<const Sp3Medium> media);

    const Sp3Medium& operator[](std::size_t lane) const { return media_[lane]; }
    std::size_t nodes() const { return nodes_; }
    /// One number of each node's medium.
    template <typename Of>
    Lanes lanes(const Of& of) const {
        return each_lane([&](std::size_t i) { return static_cast<float>(of(media_[i])); });
    }
    double min_decay() const;
    double min_extinction() const;

  private:
    std::vector<Sp3Medium> media_;
    std::size_t nodes_;
};

/// The links of all nodes by depth and curvature, made once: a body has a hundred thousand pieces of surface. Depths
/// are rounded to a 400th of the largest, curvatures to a 20th of the extinction.
class SurfaceLinks {
  public:
    /// @param max_depth  mm; greater ones count as this
    SurfaceLinks(const LaneMedium& medium, double max_depth);

    const SurfaceLink& at(std::size_t lane, float depth, float curvature) const {
        const auto bin = static_cast<std::size_t>(std::min(depth * bins_per_mm_ + 0.5F, float{bins}));
        const float turn = std::clamp(curvature * free_path_[lane], -1.0F, 1.0F);
        const auto round =
            static_cast<std::size_t>(std::min((turn + 1) * float{rounds} + 0.5F, float{2 * rounds}));
        return links_[(round * (bins + 1) + bin) * lane_count + lane];
    }

  private:
    static constexpr std::size_t bins = 400;
    static constexpr std::size_t rounds = 20;  ///< either way
    Lanes free_path_;                          ///< mm
    float bins_per_mm_;
    std::vector<SurfaceLink> links_;
};

}  // namespace skinglow::detail
