#include "shape/solved_light.h"

#include <algorithm>
#include <utility>

#include "numerics/job.h"
#include "shape/light_matching.h"
#include "shape/shape_error.h"

namespace skinglow::detail {
namespace {

/// Lights beyond this number are left out where all together bring less than this part of the light.
constexpr std::size_t many_lights = 32;
constexpr double negligible = 1e-3;
/// So many are solved each by itself, which takes about as long as three channels of all.
constexpr std::size_t few_lights = 4;
constexpr std::size_t probes = 64;
constexpr const char* light_at_vertices = "light at vertices";

/// Largest irradiance, without shadows, at some of the vertices.
double brightness(const ShapeData& shape, const PreparedRig& rig) {
    std::vector<glm::dvec3> points;
    std::vector<glm::dvec3> normals;
    const SurfaceSites& sites = shape.solver->vertex_sites();
    const std::size_t step = std::max<std::size_t>(1, shape.vertices.size() / probes);
    for (std::size_t v = 0; v < shape.vertices.size(); v += step) {
        points.push_back(shape.vertices[v]);
        normals.emplace_back(sites.sites()[sites.site_of()[v]].normal);
    }
    double largest = 0;
    for (const glm::dvec3& e : surface_irradiance(rig, points, normals, {.area_tolerance = 1e-3}))
        largest = std::max({largest, e.r, e.g, e.b});
    return largest;
}

/// Indices of the lights that count, ascending.
std::vector<std::size_t> lights_that_count(const ShapeData& shape, const PreparedRig& rig) {
    const double tolerance = rig.size() > many_lights ? negligible * brightness(shape, rig) : 0.0;
    return rig.cull(box_of(std::span(shape.vertices)), tolerance).kept;
}

void add_scaled(const WhiteIrradiance& white, const glm::dvec3& strength, std::span<glm::dvec3> sum) {
    const glm::dvec3 scale = strength * white.brightest;
    require_irradiances(light_at_vertices, std::span(&scale, 1));
    if (!(white.brightest > 0)) return;
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += scale * static_cast<double>(white.relative[v]);
}

void add(std::span<const glm::dvec3> light, double sign, std::span<glm::dvec3> sum) {
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += sign * light[v];
}

}  // namespace

SolvedLight::SolvedLight(LightScene scene, const SolvedLight* previous)
    : LightScene(std::move(scene)), state_(rig.size(), LightState::left_out) {
    const std::vector<std::size_t> that_count = lights_that_count(*shape, rig);
    for (const std::size_t k : that_count) state_[k] = LightState::open;
    // Spectra of different lights are better put together one by one. A light without power is none of them.
    is_by_light = shape->spectrum && that_count.size() <= few_lights;
    for (std::size_t k = 0; k < rig.size(); ++k) {
        if (state_[k] == LightState::left_out) left_out.push_back(k);
    }
    if (previous != nullptr && !has_same_shadows(*previous)) previous = nullptr;
    std::vector<std::size_t> before(rig.size(), not_matched);
    if (previous != nullptr) before = matching_lights(rig.lights(), previous->rig.lights());
    for (std::size_t k = 0; k < before.size(); ++k) {
        if (before[k] != not_matched && casts_shadows(k) != previous->casts_shadows(before[k]))
            before[k] = not_matched;
    }
    for (const std::size_t k : before)
        lights.push_back(shared<WhiteLight>(k == not_matched ? nullptr : previous->lights[k], previous));
    if (environment) {
        state_of_world_ = LightState::open;
        const bool is_known = previous != nullptr && has_same_world(*previous);
        world = shared<WorldLight>(is_known ? previous->world : nullptr, previous);
    }
    if (previous != nullptr && !is_by_light && has_same_flesh(*previous)) share_groups(*previous, before);
    choose_alone(previous, before);
    LightTracer tracer(*this);
    for (std::size_t k = 0; k < lights.size(); ++k) {
        if (state_[k] == LightState::alone) solve_light(k, tracer);
    }
    if (state_of_world_ == LightState::alone) solve_world(tracer);
    solve_group(tracer);
    sum_irradiance(tracer);
}

/// What is known of a light, where it is good enough; else its irradiance, where that is.
template <typename Known>
std::shared_ptr<const Known> SolvedLight::shared(const std::shared_ptr<const Known>& known,
                                                 const SolvedLight* previous) const {
    const bool has_shadows = known && known->shadowed->serves(options);
    if (has_shadows && has_same_flesh(*previous) &&
        (known->quality == quality() ||
         (known->quality.serves(quality()) && known->solved.ready() != nullptr)))
        return known;
    auto result = std::make_shared<Known>();
    result->quality = quality();
    using Irradiance = typename decltype(result->shadowed)::element_type;
    result->shadowed = has_shadows ? known->shadowed : std::make_shared<Irradiance>(options);
    return result;
}

void SolvedLight::share_groups(const SolvedLight& previous, std::span<const std::size_t> before) {
    std::vector<std::size_t> after(previous.rig.size(), not_matched);
    for (std::size_t k = 0; k < before.size(); ++k) {
        if (before[k] != not_matched && state_[k] == LightState::open &&
            has_same_color(k, previous, before[k]))
            after[before[k]] = k;
    }
    for (const LightGroup& group : previous.groups_) {
        const bool is_whole =
            group.solved->quality.serves(quality()) && (!group.has_world || has_same_world(previous)) &&
            std::all_of(group.lights.begin(), group.lights.end(), [&](std::size_t k) {
                return after[k] != not_matched && lights[after[k]]->shadowed->serves(options);
            });
        if (!is_whole) continue;
        groups_.push_back({{}, group.has_world, group.solved});
        for (const std::size_t k : group.lights) {
            groups_.back().lights.push_back(after[k]);
            state_[after[k]] = LightState::in_group;
        }
        if (group.has_world) state_of_world_ = LightState::in_group;
    }
}

/// Of the lights that are in no group, which are solved each by itself.
void SolvedLight::choose_alone(const SolvedLight* previous, std::span<const std::size_t> before) {
    std::vector<std::size_t> changed;
    std::vector<std::size_t> others;
    for (std::size_t k = 0; k < lights.size(); ++k) {
        if (state_[k] != LightState::open) continue;
        if (is_by_light || lights[k]->solved.ready() != nullptr) {
            state_[k] = LightState::alone;
            continue;
        }
        const std::size_t was = before[k];
        // What was alone was changed before, and is likely to change again.
        const bool is_changed = was == not_matched || previous->state_[was] == LightState::alone ||
                                !has_same_color(k, *previous, was);
        (previous != nullptr && is_changed ? changed : others).push_back(k);
    }
    if (changed.size() <= few_lights) {
        for (const std::size_t k : changed) state_[k] = LightState::alone;
    }
    if (state_of_world_ == LightState::open && (is_by_light || world->solved.ready() != nullptr ||
                                                (previous != nullptr && !has_same_world(*previous))))
        state_of_world_ = LightState::alone;
    else if (state_of_world_ != LightState::open && others.size() == 1)
        state_[others.front()] = LightState::alone;
}

void SolvedLight::solve_light(std::size_t light, LightTracer& tracer) const {
    lights[light]->solved.get([&] {
        WhiteLight::Solved result;
        expect_work(tracer.work() + shape->solver->solve_work(options.reentries));
        tracer.of_light(light, *lights[light], [&](const WhiteIrradiance& white) {
            finish_work(tracer.work());
            result.brightest = white.brightest;
            if (white.brightest > 0)
                result.nodes = shape->solve_white(white.relative, lights[light]->quality);
        });
        return result;
    });
}

void SolvedLight::solve_world(LightTracer& tracer) const {
    world->solved.get([&] {
        const std::vector<glm::dvec3>& light = tracer.of_world(*world);
        require_irradiances(light_at_vertices, light);
        return shape->solve(light, world->quality);
    });
}

/// All that is left, at once. Lights that take away are solved by themselves: what a solve gives is never negative, so
/// that in a sum with others it would matter which others those are.
void SolvedLight::solve_group(LightTracer& tracer) {
    LightGroup give;
    LightGroup take;
    for (std::size_t k = 0; k < lights.size(); ++k) {
        if (state_[k] != LightState::open) continue;
        (rig.data().prepared[k].power < 0 ? take : give).lights.push_back(k);
    }
    give.has_world = state_of_world_ == LightState::open;
    expect_work(tracer.work() * static_cast<double>(give.lights.size() + take.lights.size()));
    solve_group(std::move(give), 1, tracer);
    solve_group(std::move(take), -1, tracer);
}

void SolvedLight::solve_group(LightGroup group, double sign, LightTracer& tracer) {
    if (group.lights.empty() && !group.has_world) return;
    auto solved = std::make_shared<LightGroup::Solved>();
    solved->quality = quality();
    solved->sign = sign;
    solved->irradiance.assign(shape->vertices.size(), glm::dvec3(0.0));
    for (const std::size_t k : group.lights) {
        tracer.of_light(k, *lights[k], [&](const WhiteIrradiance& white) {
            add_scaled(white, sign * rig.data().prepared[k].strength(), solved->irradiance);
        });
        finish_work(tracer.work());
        state_[k] = LightState::in_group;
    }
    if (group.has_world) add(tracer.of_world(*world), 1, solved->irradiance);
    require_irradiances(light_at_vertices, solved->irradiance);
    solved->nodes = shape->solve(solved->irradiance, quality());
    group.solved = std::move(solved);
    state_of_world_ = group.has_world ? LightState::in_group : state_of_world_;
    groups_.push_back(std::move(group));
}

void SolvedLight::sum_irradiance(LightTracer& tracer) {
    irradiance.assign(shape->vertices.size(), glm::dvec3(0.0));
    for (const LightGroup& group : groups_) add(group.solved->irradiance, group.solved->sign, irradiance);
    for (std::size_t k = 0; k < lights.size(); ++k) {
        if (state_[k] != LightState::alone) continue;
        tracer.of_light(k, *lights[k], [&](const WhiteIrradiance& white) {
            add_scaled(white, rig.data().prepared[k].strength(), irradiance);
        });
    }
    if (state_of_world_ == LightState::alone) add(tracer.of_world(*world), 1, irradiance);
    // What was traced for parts that were not ready yet, and turned out not to matter, is no part of the answer.
    const std::vector<std::uint8_t> wanted = shape->solver->wanted_vertices(options.reentries);
    for (std::size_t v = 0; v < irradiance.size(); ++v) {
        if (wanted[v] == 0) irradiance[v] = glm::dvec3(0.0);
    }
    require_irradiances(light_at_vertices, irradiance);
}

std::vector<ColoredLight> SolvedLight::parts() const {
    std::vector<ColoredLight> result;
    for (std::size_t k = 0; k < lights.size(); ++k) {
        if (state_[k] != LightState::alone) continue;
        const WhiteLight::Solved& one = *lights[k]->solved.ready();
        if (!one.nodes.exitance.empty())
            result.push_back({&one.nodes, strength(k, rig.data().prepared[k].color)});
    }
    if (state_of_world_ == LightState::alone) add_colored(*world->solved.ready(), result);
    for (const LightGroup& group : groups_) add_colored(group.solved->nodes, result, group.solved->sign);
    return result;
}

void SolvedLight::solve_each() const {
    LightTracer tracer(*this);
    for (std::size_t k = 0; k < lights.size(); ++k) {
        stop_if_asked();
        if (may_shine(k)) solve_light(k, tracer);
    }
    if (world) solve_world(tracer);
}

glm::dvec3 SolvedLight::strength(std::size_t light, const glm::dvec3& color) const {
    const WhiteLight::Solved* solved = lights[light]->solved.ready();
    return solved == nullptr ? glm::dvec3(0.0)
                             : color * (rig.data().prepared[light].power * solved->brightest);
}

}  // namespace skinglow::detail
