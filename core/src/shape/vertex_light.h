#pragma once

#include <skinglow/environment.h>
#include <skinglow/occlusion.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/rigid_motion.h"
#include "radiometry/prepared_light.h"
#include "rays/visible_fraction.h"
#include "shape/flesh_surface.h"
#include "shape/surface_sites.h"

namespace skinglow::detail {

/// What stands around a body, and how closely shadows are looked at.
struct ShadowOptions {
    const Occluders* occluders = nullptr;    ///< none: the body alone casts shadows
    std::vector<std::size_t> excluded = {};  ///< meshes of it that do not count
    RigidMotion to_occluders = {};           ///< from the frame of the vertices
    int samples = 16;                        ///< rays to a light that has an extent, in its penumbra
    int threads = 0;
};

/// Irradiance at vertices, of any size.
struct WhiteIrradiance {
    std::vector<float> relative;  ///< one per vertex, 0 to 1
    double brightest = 0;         ///< W/m^2, what 1 is
};

/// Irradiance at the vertices of a body, with the shadows of the body itself and of what stands around it.
class VertexLight {
  public:
    /// @param vertices  as given, world; `sites` are theirs
    /// @param unit_mm   length of one unit of them, mm
    /// @param wanted    one per vertex, not 0 where the irradiance matters
    VertexLight(const FleshSurface& surface, std::span<const glm::dvec3> vertices, const SurfaceSites& sites,
                double unit_mm, std::span<const std::uint8_t> wanted, const ShadowOptions& options);

    /// Of one light whose color is white and whose power is 1, W/m^2; 0 at vertices that are not wanted. First a
    /// few rays go to each vertex; where they or those of a neighbor disagree, all of them.
    /// @param has_shadows  whether anything stops it
    WhiteIrradiance of_light(const PreparedLight& light, bool has_shadows = true) const;

    /// Of the world: by rays that follow the cosine, with the radiance of the nine harmonics along those that
    /// nothing stops.
    std::vector<glm::vec3> of_environment(const Environment& environment) const;

  private:
    struct Ray {
        std::size_t receiver;
        double weight;
        LightSample sample;
    };
    void sort_by_position();
    void add_receiver(std::uint32_t vertex);
    float to_mm(double distance) const;
    bool passes_occluders(const glm::dvec3& point, const glm::dvec3& direction, double distance) const;
    template <typename Asked>
    void find_fractions(const PreparedLight& light, std::size_t begin, std::size_t end, const Asked& is_asked,
                        int samples, std::span<float> seen) const;
    void trace(std::span<const Ray> rays, std::span<float> seen) const;
    std::vector<std::uint8_t> doubtful(std::span<const float> fraction) const;

    const FleshSurface& surface_;
    std::span<const glm::dvec3> vertices_;
    const SurfaceSites& sites_;
    double unit_mm_;
    std::vector<std::uint32_t> wanted_;
    std::vector<glm::dvec3> points_;     ///< of the wanted, world
    std::vector<glm::dvec3> normals_;    ///< unit; 0: receives nothing
    std::vector<glm::vec3> origins_;     ///< where rays begin, mm about the body's center
    std::vector<glm::uvec3> triangles_;  ///< that a wanted vertex is a corner of
    ShadowOptions options_;
    std::vector<TriangleRange> excluded_;
};

}  // namespace skinglow::detail
