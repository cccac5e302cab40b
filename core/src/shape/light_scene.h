#pragma once

#include <optional>

#include "rig/rig_data.h"
#include "shape/shape_data.h"
#include "shape/vertex_light.h"

namespace skinglow::detail {

/// What light is asked for.
struct LightScene {
    std::shared_ptr<const ShapeData> shape;
    PreparedRig rig;
    ShapeLightOptions options;  ///< the pointers in it are not read
    std::optional<Environment> environment;
    std::optional<Occluders> occluders;
    RigidMotion to_occluders;

    LightScene(std::shared_ptr<const ShapeData> of, PreparedRig lights, const ShapeLightOptions& given);

    SolveQuality quality() const { return {options.reentries, options.solver_tolerance}; }
    /// Whether light arrives the same way in both: the same body amid the same objects.
    bool has_same_shadows(const LightScene& other) const;
    /// Whether light goes through the flesh, and from skin to skin, the same way.
    bool has_same_flesh(const LightScene& other) const;
    bool has_same_world(const LightScene& other) const;
    /// Whether light k was of this color and power as light j of another.
    bool has_same_color(std::size_t k, const LightScene& other, std::size_t j) const;
    /// Whether a light gives anything where it is of some color.
    bool may_shine(std::size_t light) const;
    /// Whether the body and what stands around it cast shadows of a light.
    bool casts_shadows(std::size_t light) const;
};

/// Irradiance at the vertices, made when it is first asked for, and what it is good for.
template <typename Irradiance>
struct Shadowed {
    int shadow_samples;
    int reentries;  ///< at the vertices that light comes from which enters skin as often again
    Lazy<Irradiance> irradiance;

    explicit Shadowed(const ShapeLightOptions& options)
        : shadow_samples(options.shadow_samples), reentries(options.reentries) {}
    bool serves(const ShapeLightOptions& wanted) const {
        return shadow_samples >= wanted.shadow_samples && reentries >= wanted.reentries;
    }
};

/// A light, whatever its color and its power are, and what of it is solved.
struct WhiteLight {
    SolveQuality quality;
    std::shared_ptr<const Shadowed<WhiteIrradiance>> shadowed;
    struct Solved {
        double brightest = 0;  ///< W/m^2, where light is white and its power 1
        SiteLight nodes = {};  ///< of WhiteIrradiance::relative; without sites: gives nothing
    };
    Lazy<Solved> solved;
};

/// The world by itself.
struct WorldLight {
    SolveQuality quality;
    std::shared_ptr<const Shadowed<std::vector<glm::dvec3>>> shadowed;
    Lazy<std::vector<SiteLight>> solved;  ///< as ShapeData::solve
};

/// Traces what irradiance is asked for and not at hand.
class LightTracer {
  public:
    explicit LightTracer(const LightScene& scene) : scene_(&scene) {}

    /// Calls `use` with the irradiance of a light. It is kept unless all of them are too many.
    template <typename Use>
    void of_light(std::size_t light, const WhiteLight& known, const Use& use) {
        const auto& irradiance = known.shadowed->irradiance;
        if (irradiance.ready() != nullptr || keeps_all()) {
            use(irradiance.get([&] { return traced(light); }));
        } else {
            use(traced(light));
        }
    }
    const std::vector<glm::dvec3>& of_world(const WorldLight& known) {
        return known.shadowed->irradiance.get([&] { return traced_world(); });
    }

    /// Of a job: what a light takes, where making a site's rows is 1.
    double work() const;

  private:
    bool keeps_all() const;
    const VertexLight& vertex_light();
    WhiteIrradiance traced(std::size_t light);
    std::vector<glm::dvec3> traced_world();

    const LightScene* scene_;
    std::optional<VertexLight> vertex_light_;
};

}  // namespace skinglow::detail
