#include "shape/lit_shape_data.h"

#include <algorithm>
#include <glm/common.hpp>
#include <unordered_map>
#include <utility>

#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

constexpr std::size_t points_per_block = std::size_t{1} << 13U;

/// Of what two tissues of the same flesh let through; none where that is the same.
std::optional<Lanes> entering_ratio(const ShapeData& of, const ShapeData& solved) {
    const Lanes now = of.on_the_way();
    const Lanes then = solved.on_the_way();
    if (std::equal(std::begin(now.v), std::end(now.v), std::begin(then.v))) return std::nullopt;
    // Where nothing came in there is nothing to scale.
    return each_lane([&](std::size_t k) { return then[k] > 0 ? now[k] / then[k] : 1.0F; });
}

}  // namespace

void keep_transmitted(ShapeData::Colors& found) {
    for (std::size_t s = 0; s < found.exitance.size(); ++s)
        found.reflected[s] = glm::max(found.exitance[s] - found.reflected[s], glm::dvec3(0.0));
}

LitShapeData::LitShapeData(std::shared_ptr<const SolvedLight> light, std::shared_ptr<const ShapeData> colors,
                           const LitShapeData* previous)
    : solved(std::move(light)), shape(std::move(colors)), entering_(entering_ratio(*shape, *solved->shape)) {
    std::unordered_map<const WhiteLight*, std::shared_ptr<const LightColors>> known;
    if (previous != nullptr && previous->shape == shape) {
        for (const auto& one : previous->lights_) known.emplace(one->light.get(), one);
        if (solved->world && previous->world_ && previous->world_->world == solved->world)
            world_ = previous->world_;
    }
    for (const auto& one : solved->lights) {
        const auto found = known.find(one.get());
        lights_.push_back(found != known.end() ? found->second : std::make_shared<LightColors>(one));
    }
    if (solved->world && !world_) world_ = std::make_shared<WorldColors>(solved->world);
    ShapeData::Colors found;
    if (solved->is_by_light) {
        std::vector<glm::dvec3> own;
        for (const RigLight& one : solved->rig.data().prepared) own.push_back(one.color);
        found = sum(own);
    } else {
        found = shape->colors(sum_of_parts());
    }
    keep_transmitted(found);
    exitance = shape->at_points(found.exitance);
    transmitted = shape->at_points(found.reflected);
}

template <typename Use>
auto LitShapeData::in_tissue(const SiteLight& light, const Use& use) const {
    return entering_ ? use(behind_another(light, *entering_)) : use(light);
}

std::vector<SiteLight> LitShapeData::sum_of_parts() const {
    std::vector<ColoredLight> parts = solved->parts();
    std::vector<SiteLight> own;
    if (entering_) {
        own.reserve(parts.size());
        for (ColoredLight& part : parts) {
            own.push_back(behind_another(*part.light, *entering_));
            part.light = &own.back();
        }
    }
    return shape->sum(parts);
}

void LitShapeData::solve_each() const {
    solved->solve_each();
    for (std::size_t k = 0; k < lights_.size(); ++k) matrices(k);
}

bool LitShapeData::is_each_solved() const {
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        if (solved->may_shine(k) && lights_[k]->matrices.ready() == nullptr) return false;
    }
    return !world_ || world_->world->solved.ready() != nullptr;
}

const ShapeData::Matrices* LitShapeData::matrices(std::size_t light) const {
    const WhiteLight::Solved* white = solved->lights[light]->solved.ready();
    if (white == nullptr || white->nodes.exitance.empty()) return nullptr;
    return &lights_[light]->matrices.get([&] {
        return in_tissue(white->nodes, [&](const SiteLight& nodes) { return shape->matrices(nodes); });
    });
}

ShapeData::Colors LitShapeData::sum(std::span<const glm::dvec3> colors) const {
    const std::size_t sites = shape->solver->sites().sites().size();
    ShapeData::Colors result{std::vector<glm::dvec3>(sites, glm::dvec3(0.0)),
                             std::vector<glm::dvec3>(sites, glm::dvec3(0.0))};
    if (const ShapeData::Colors* of_world = world_colors()) result = *of_world;
    for (std::size_t k = 0; k < colors.size(); ++k) {
        const ShapeData::Matrices* of_light = solved->may_shine(k) ? matrices(k) : nullptr;
        const glm::dvec3 color = solved->strength(k, colors[k]);
        if (of_light == nullptr || color == glm::dvec3(0.0)) continue;
        const auto add = [&](const std::vector<glm::mat3>& matrices_of, std::vector<glm::dvec3>& to) {
            for (std::size_t s = 0; s < sites; ++s) {
                const glm::mat3& m = matrices_of[s];
                to[s] +=
                    shape->spectrum ? glm::dmat3(m) * color : glm::dvec3(m[0][0], m[1][1], m[2][2]) * color;
            }
        };
        add(of_light->exitance, result.exitance);
        add(of_light->reflected, result.reflected);
    }
    for (glm::dvec3& e : result.exitance) e = glm::max(e, glm::dvec3(0.0));
    for (glm::dvec3& e : result.reflected) e = glm::max(e, glm::dvec3(0.0));
    return result;
}

const ShapeData::Colors* LitShapeData::world_colors() const {
    if (!world_ || world_->world->solved.ready() == nullptr) return nullptr;
    return &world_->colors.get([&] {
        std::vector<SiteLight> channels = *world_->world->solved.ready();
        if (entering_) {
            for (SiteLight& channel : channels) channel = behind_another(channel, *entering_);
        }
        return shape->colors(channels);
    });
}

const std::vector<glm::mat3>& LitShapeData::through(std::size_t light,
                                                    const ShapeData::Matrices& of_light) const {
    return lights_[light]->through.get([&] {
        std::vector<glm::mat3> result = of_light.exitance;
        for (std::size_t s = 0; s < result.size(); ++s) result[s] -= of_light.reflected[s];
        return result;
    });
}

std::vector<glm::dvec3> LitShapeData::transmitted_of(std::span<const glm::dvec3> colors) const {
    struct Part {
        const glm::mat3* matrices;
        glm::vec3 color;
    };
    std::vector<Part> parts;
    // Where nothing that is reflected is negative, clamping it and the exitance changes nothing.
    bool is_in_gamut = true;
    for (std::size_t k = 0; k < colors.size() && is_in_gamut; ++k) {
        const ShapeData::Matrices* of_light = solved->may_shine(k) ? matrices(k) : nullptr;
        const glm::dvec3 color = solved->strength(k, colors[k]);
        if (of_light == nullptr || color == glm::dvec3(0.0)) continue;
        is_in_gamut = shape->is_reflected_in_gamut(color);
        if (is_in_gamut) parts.push_back({through(k, *of_light).data(), glm::vec3(color)});
    }
    if (!is_in_gamut) {
        ShapeData::Colors found = sum(colors);
        keep_transmitted(found);
        return shape->at_points(found.reflected);
    }
    const ShapeData::Colors* of_world = world_colors();
    const auto& site_of = shape->solver->sites().site_of();
    std::vector<glm::dvec3> result(site_of.size());
    const bool mixes = shape->spectrum.has_value();
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t s = site_of[i];
            glm::vec3 total(0.0F);
            if (of_world != nullptr) total = glm::vec3(of_world->exitance[s] - of_world->reflected[s]);
            for (const Part& part : parts) {
                const glm::mat3& m = part.matrices[s];
                total += mixes ? m * part.color : glm::vec3(m[0][0], m[1][1], m[2][2]) * part.color;
            }
            result[i] = glm::max(glm::dvec3(total), glm::dvec3(0.0));
        }
    };
    for_each_block(result.size(), shape->options.threads, work, {}, points_per_block);
    return result;
}

std::vector<glm::dvec3> LitShapeData::error() const {
    const std::vector<SiteLight> all = sum_of_parts();
    std::vector<ColoredLight> lights;
    add_colored(all, lights);
    return estimated_error(*shape, lights, solved->irradiance);
}

MeanError LitShapeData::mean_error() const {
    const auto& site_of = shape->solver->sites().site_of();
    const std::size_t sites = shape->solver->sites().sites().size();
    std::vector<glm::dvec3> of_sites[2] = {std::vector<glm::dvec3>(sites), std::vector<glm::dvec3>(sites)};
    for (std::size_t i = 0; i < site_of.size(); ++i) {
        of_sites[0][site_of[i]] = exitance[i];
        of_sites[1][site_of[i]] = transmitted[i];
    }
    return detail::mean_error(*shape->solver, error(), of_sites[0], of_sites[1]);
}

}  // namespace skinglow::detail
