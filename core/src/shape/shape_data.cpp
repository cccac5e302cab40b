#include "shape/shape_data.h"

#include <algorithm>
#include <glm/common.hpp>

#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

/// Of the residual, in the preconditioner's norm: leaves 1 % where a thousandth comes through.
constexpr double tolerance = 1e-4;
constexpr std::size_t sites_per_block = 512;

Lanes each_channel(const glm::dvec3& rgb) {
    return {{static_cast<float>(rgb.r), static_cast<float>(rgb.g), static_cast<float>(rgb.b), 0}};
}

glm::dvec3 to_rgb(const Lanes& lanes) {
    return {lanes[0], lanes[1], lanes[2]};
}

}  // namespace

glm::dmat3 ShapeData::combine(const Lanes& exitance) const {
    if (!spectrum) {
        glm::dmat3 matrix(0.0);
        for (int c = 0; c < 3; ++c) matrix[c][c] = static_cast<double>(exitance[static_cast<std::size_t>(c)]);
        return matrix;
    }
    std::array<double, lane_count> nodes{};
    for (std::size_t k = 0; k < spectrum->nodes.size(); ++k) {
        const SpectralNodes::Node& node = spectrum->nodes[k];
        nodes[k] = static_cast<double>(exitance[k]) * node.entry_factor * node.exit_factor;
    }
    return spectrum->combine(std::span(nodes).first(spectrum->nodes.size()));
}

Lanes ShapeData::on_the_way() const {
    if (!spectrum) return Lanes::all(1);
    return each_lane([&](std::size_t k) {
        const SpectralNodes::Node& node = spectrum->nodes[std::min(k, spectrum->nodes.size() - 1)];
        return static_cast<float>(node.entry_factor * node.exit_factor);
    });
}

void ShapeData::add_channel(Colors& colors, std::span<const Lanes> light, int reentries, int channel) const {
    const SiteLight found = solver.solve(light, tolerance, reentries, on_the_way());
    const auto color = [&](const Lanes& lanes) {
        const glm::dmat3 matrix = combine(lanes);
        return channel < 0 ? matrix * glm::dvec3(1.0) : matrix[channel];
    };
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            colors.exitance[s] += color(found.exitance[s]);
            colors.reflected[s] += color(found.reflected[s]);
        }
    };
    for_each_block(colors.exitance.size(), options.threads, work, {}, sites_per_block);
}

ShapeData::Colors ShapeData::solve(std::span<const glm::dvec3> irradiance, int reentries) const {
    const std::size_t sites = solver.sites().sites().size();
    Colors colors{std::vector<glm::dvec3>(sites, glm::dvec3(0.0)),
                  std::vector<glm::dvec3>(sites, glm::dvec3(0.0))};
    std::vector<Lanes> light(irradiance.size());
    if (!spectrum) {
        std::transform(irradiance.begin(), irradiance.end(), light.begin(), each_channel);
        const SiteLight found = solver.solve(light, tolerance, reentries);
        std::transform(found.exitance.begin(), found.exitance.end(), colors.exitance.begin(), to_rgb);
        std::transform(found.reflected.begin(), found.reflected.end(), colors.reflected.begin(), to_rgb);
        return colors;
    }
    // Light of each channel goes through the flesh by itself; gray light once.
    const bool is_gray = std::all_of(irradiance.begin(), irradiance.end(),
                                     [](const glm::dvec3& e) { return e.r == e.g && e.g == e.b; });
    for (int c = is_gray ? -1 : 0; c < (is_gray ? 0 : 3); ++c) {
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] = Lanes::all(static_cast<float>(irradiance[i][std::max(c, 0)]));
        add_channel(colors, light, reentries, c);
    }
    for (glm::dvec3& e : colors.exitance) e = glm::max(e, glm::dvec3(0.0));
    return colors;
}

ShapeData::Matrices ShapeData::matrices(std::span<const float> irradiance, int reentries) const {
    std::vector<Lanes> light(irradiance.size());
    std::transform(irradiance.begin(), irradiance.end(), light.begin(), Lanes::all);
    const SiteLight found = solver.solve(light, tolerance, reentries, on_the_way());
    Matrices result{std::vector<glm::mat3>(found.exitance.size()),
                    std::vector<glm::mat3>(found.exitance.size())};
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            result.exitance[s] = glm::mat3(combine(found.exitance[s]));
            result.reflected[s] = glm::mat3(combine(found.reflected[s]));
        }
    };
    for_each_block(result.exitance.size(), options.threads, work, {}, sites_per_block);
    return result;
}

}  // namespace skinglow::detail
