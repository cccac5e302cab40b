#pragma once

#include "shape/light_scene.h"

namespace skinglow::detail {

/// Lights that were solved at once, of the colors that they had.
struct LightGroup {
    std::vector<std::size_t> lights;  ///< in the rig
    bool has_world = false;
    struct Solved {
        SolveQuality quality;
        double sign = 1;  ///< -1: lights of negative power, which take away what is solved of their opposites
        std::vector<glm::dvec3> irradiance;  ///< before the sign
        std::vector<SiteLight> nodes;        ///< as ShapeData::solve, before the sign
    };
    std::shared_ptr<const Solved> solved;
};

/// The light that was asked for, solved at the nodes: the same for all tissues.
///
/// Few lights are solved each by itself, many at once. What an earlier one of the same shape has of the same
/// lights is taken over; those that changed are solved by themselves then, and what is left of their group at
/// once. What comes out does not depend on what was before, but for the solver's tolerance.
struct SolvedLight : LightScene {
    std::vector<std::size_t> left_out;
    std::vector<glm::dvec3> irradiance;
    std::vector<std::shared_ptr<const WhiteLight>> lights;  ///< one for each
    std::shared_ptr<const WorldLight> world;                ///< null: black
    bool is_by_light = false;  ///< colors are put together light by light, not of the sum

    /// @param previous  null: none
    SolvedLight(LightScene scene, const SolvedLight* previous);

    /// What all light is the sum of.
    std::vector<ColoredLight> parts() const;

    /// Solves each light that may shine, and the world, by itself.
    void solve_each() const;

    /// The factor to what is solved of a light, where it is of this color; 0 where nothing is.
    glm::dvec3 strength(std::size_t light, const glm::dvec3& color) const;

  private:
    enum class LightState : std::uint8_t { open, left_out, alone, in_group };

    template <typename Known>
    std::shared_ptr<const Known> shared(const std::shared_ptr<const Known>& known,
                                        const SolvedLight* previous) const;
    void share_groups(const SolvedLight& previous, std::span<const std::size_t> before);
    void choose_alone(const SolvedLight* previous, std::span<const std::size_t> before);
    void solve_light(std::size_t light, LightTracer& tracer) const;
    void solve_world(LightTracer& tracer) const;
    void solve_group(LightTracer& tracer);
    void solve_group(LightGroup group, double sign, LightTracer& tracer);
    void sum_irradiance(LightTracer& tracer);

    std::vector<LightGroup> groups_;
    std::vector<LightState> state_;  ///< one per light
    LightState state_of_world_ = LightState::left_out;
};

}  // namespace skinglow::detail
