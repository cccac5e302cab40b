#pragma once

#include <skinglow/angular_weight.h>
#include <skinglow/environment.h>

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "light/light.h"
#include "radiometry/irradiance_sum.h"
#include "rig/irradiance.h"

namespace skinglow {

/// How surface weights are worked out.
struct SurfaceOptions {
    double area_tolerance =
        default_area_tolerance;  ///< relative, of the integrals for elliptic lamps and spreads
    /// None: every angle enters alike (Lambert). Area lamps count by the angles of their parts, other lamps
    /// by that of their middle.
    const AngularWeight* angular_weight = nullptr;
    const Environment* environment = nullptr;  ///< none: black
    int threads = 0;                           ///< 0: one for each processor
};

/// Surface weights: irradiance at many places, each facing along its own normal, with its cosine and its
/// horizon. As the sum of `irradiance` over the lamps, for any number of places and lamps: vectorized over
/// places, on several threads.
/// @param points   world, scene unit (meters), finite; @param normals  as many, finite, any length; 0
/// receives nothing
/// @return one per point, W/m^2, linear Rec.709. Throws std::invalid_argument on bad input, naming the entry,
/// or where a result is beyond the largest double.
std::vector<glm::dvec3> surface_irradiance(std::span<const Light> lights, std::span<const glm::dvec3> points,
                                           std::span<const glm::dvec3> normals,
                                           const SurfaceOptions& options = {});

namespace detail {

/// The same for lights already prepared, as many normals as points.
std::vector<glm::dvec3> sum_over_surface(std::span<const WeightedLight> lights,
                                         std::span<const glm::dvec3> points,
                                         std::span<const glm::dvec3> normals, const SurfaceOptions& options);

}  // namespace detail

/// Throws std::invalid_argument unless there are as many normals as points, all finite; names the entry.
void require_places(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals);

/// Points of a surface and where it faces there.
struct Places {
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;  ///< unit, or 0
};

/// The far side of skin: at x - d n, facing along -n.
/// @param vertices, normals  of the near side, as above; normals are taken at length 1
/// @param depth  d, one per vertex or one for all, in the scene's unit, finite, 0 or more
/// Throws std::invalid_argument on bad input, naming the entry.
Places far_side(std::span<const glm::dvec3> vertices, std::span<const glm::dvec3> normals,
                std::span<const double> depth);

/// surface_irradiance on the far side of skin. Parameters and errors as both.
std::vector<glm::dvec3> far_side_irradiance(std::span<const Light> lights,
                                            std::span<const glm::dvec3> vertices,
                                            std::span<const glm::dvec3> normals,
                                            std::span<const double> depth,
                                            const SurfaceOptions& options = {});

}  // namespace skinglow
