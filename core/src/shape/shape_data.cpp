#include "shape/shape_data.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "numerics/job.h"
#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

/// Of what a half-space sends back: the grid's errors on lit skin are below.
constexpr float largest_error = 0.1F;
constexpr float largest_sent_back = 1 + largest_error;
/// Flesh that light comes through at lit points.
constexpr double thickest_mm = 2;
constexpr std::size_t sites_per_result_block = 512;

Lanes each_channel(const glm::dvec3& rgb) {
    return {{static_cast<float>(rgb.r), static_cast<float>(rgb.g), static_cast<float>(rgb.b), 0}};
}

void scale_by(SiteLight& light, float scale) {
    for (Lanes& e : light.exitance) e = e * scale;
    for (Lanes& e : light.reflected) e = e * scale;
    for (SiteLight& pass : light.passes) scale_by(pass, scale);
}

}  // namespace

SiteLight behind_another(const SiteLight& light, const Lanes& ratio) {
    if (light.passes.empty()) return light;
    // Summed anew: what one pass loses may be all but a millionth of the whole.
    SiteLight result = {light.passes[0].exitance, light.passes[0].reflected};
    Lanes factor = Lanes::all(1);
    for (std::size_t p = 1; p < light.passes.size(); ++p) {
        factor = factor * ratio;
        for (std::size_t s = 0; s < result.exitance.size(); ++s) {
            result.exitance[s] += factor * light.passes[p].exitance[s];
            result.reflected[s] += factor * light.passes[p].reflected[s];
        }
    }
    return result;
}

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

ShapeData::ShapeData(const ShapeData& other, const Tissue& tissue)
    : options(other.options),
      vertices(other.vertices),
      points(other.points),
      spectrum(spectral_nodes(tissue, other.spectrum.value())),
      solver(other.solver) {
    set_thick();
}

void ShapeData::set_thick() {
    if (!spectrum) return;
    for (std::size_t k = 0; k < spectrum->nodes.size(); ++k) {
        // The layered solution has a smooth surface.
        const SpectralNodes::Node& node = spectrum->nodes[k];
        const double smooth = sp3_medium(node.absorption, node.reduced_scattering, spectrum->refractive_index,
                                         ShapeSurface::smooth)
                                  .half_space;
        thick_.push_back(spectrum->thick[k] * (solver->medium()[k].half_space / smooth));
        all_thick_ += thick_.back();
    }
}

ShapeData::Pair ShapeData::combine(const Lanes& all, const Lanes& of_half_space) const {
    if (!spectrum) return {combine(all), combine(of_half_space)};
    // The first node is the least absorbed: what it has enters again where that matters.
    const double irradiance = static_cast<double>(of_half_space[0]) / solver->medium()[0].half_space;
    Pair result{glm::dmat3(0.0), all_thick_ * irradiance};
    // Hardly anything comes through at the most absorbed node: the part that it has of its half-space is due to
    // the shape and to the grid, for all nodes alike.
    const std::size_t last = thick_.size() - 1;
    const float sent_back =
        of_half_space[last] > 0 ? std::min(largest_sent_back, all[last] / of_half_space[last]) : 0.0F;
    Lanes through = all;
    for (std::size_t k = 0; k < thick_.size(); ++k) {
        if (!(of_half_space[k] > 0)) continue;
        const float part = std::min(sent_back, all[k] / of_half_space[k]);
        result.exitance += thick_[k] * (static_cast<double>(part) * irradiance);
        through[k] = std::max(0.0F, all[k] - part * of_half_space[k]);
    }
    if (sent_back > 0) {
        // What is left is brighter the less it is absorbed, and falls from node to node as it did before, or as
        // through some flesh at most: where the grid's errors leave a node dark, those about it would have any
        // color. A node gets no more than these errors can be, so that a little light changes little.
        const LaneMedium& medium = solver->medium();
        const auto raise = [&](std::size_t k, double least) {
            const float largest = through[k] + largest_error * of_half_space[k];
            through[k] = std::max(through[k], std::min(static_cast<float>(least), largest));
        };
        for (std::size_t k = last; k-- > 0;) raise(k, static_cast<double>(through[k + 1]));
        double flesh_mm = thickest_mm;
        for (std::size_t k = 1; k <= last && through[k - 1] > 0; ++k) {
            const double rise = medium[k].decay[0] - medium[k - 1].decay[0];
            const auto before = static_cast<double>(through[k - 1]);
            raise(k, before * std::exp(-flesh_mm * rise));
            if (rise > 0 && through[k] > 0)
                flesh_mm = std::max(thickest_mm, std::log(before / static_cast<double>(through[k])) / rise);
        }
    }
    result.exitance += combine(through);
    return result;
}

bool ShapeData::is_reflected_in_gamut(const glm::dvec3& color) const {
    const glm::dvec3 reflected = spectrum ? all_thick_ * color : color;
    return std::min({reflected.x, reflected.y, reflected.z}) >= 0;
}

std::vector<glm::dvec3> ShapeData::at_points(const std::vector<glm::dvec3>& of_sites) const {
    std::vector<glm::dvec3> result;
    result.reserve(points.size());
    for (const std::uint32_t s : solver->sites().site_of()) result.push_back(of_sites[s]);
    return result;
}

/// Solved with the brightest light 1, so that squares in single precision neither overflow nor vanish.
SiteLight ShapeData::solve_nodes(std::span<Lanes> light, const SolveQuality& quality) const {
    float brightest = 0;
    for (const Lanes& e : light) {
        for (const float x : e.v) brightest = std::max(brightest, std::abs(x));
    }
    // Divided, as a small number's inverse may overflow.
    const float scale = brightest > 0 ? brightest : 1.0F;
    for (Lanes& e : light) e = each_lane([&](std::size_t k) { return e[k] / scale; });
    SiteLight result = solver->solve(light, quality.tolerance, quality.reentries, on_the_way());
    if (!spectrum) result.passes.clear();  // no other tissue will ask
    scale_by(result, scale);
    return result;
}

std::vector<SiteLight> ShapeData::solve(std::span<const glm::dvec3> irradiance,
                                        const SolveQuality& quality) const {
    std::vector<Lanes> light(irradiance.size());
    std::vector<SiteLight> result;
    if (!spectrum) {
        expect_work(solver->solve_work(quality.reentries));
        std::transform(irradiance.begin(), irradiance.end(), light.begin(), each_channel);
        result.push_back(solve_nodes(light, quality));
        return result;
    }
    // Light of each channel goes through the flesh by itself; gray light once.
    const bool is_gray = std::all_of(irradiance.begin(), irradiance.end(),
                                     [](const glm::dvec3& e) { return e.r == e.g && e.g == e.b; });
    const int channels = is_gray ? 1 : 3;
    expect_work(channels * solver->solve_work(quality.reentries));
    for (int c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] = Lanes::all(static_cast<float>(irradiance[i][c]));
        result.push_back(solve_nodes(light, quality));
    }
    return result;
}

SiteLight ShapeData::solve_white(std::span<const float> irradiance, const SolveQuality& quality) const {
    std::vector<Lanes> light(irradiance.size());
    std::transform(irradiance.begin(), irradiance.end(), light.begin(), Lanes::all);
    return solve_nodes(light, quality);
}

std::vector<SiteLight> ShapeData::sum(std::span<const ColoredLight> lights) const {
    const std::size_t sites = solver->sites().sites().size();
    const bool is_gray = std::all_of(lights.begin(), lights.end(), [](const ColoredLight& one) {
        return one.color.r == one.color.g && one.color.g == one.color.b;
    });
    // Lights of negative power, which can take away no more light than there is.
    const bool takes_away = std::any_of(lights.begin(), lights.end(), [](const ColoredLight& one) {
        return std::min({one.color.r, one.color.g, one.color.b}) < 0;
    });
    std::vector<SiteLight> result(spectrum && !is_gray ? 3 : 1);
    for (std::size_t c = 0; c < result.size(); ++c) {
        result[c] = {std::vector<Lanes>(sites), std::vector<Lanes>(sites)};
        for (const ColoredLight& one : lights) {
            if (one.light->exitance.empty()) continue;
            const Lanes color = spectrum ? Lanes::all(static_cast<float>(one.color[static_cast<int>(c)]))
                                         : each_channel(one.color);
            for (std::size_t s = 0; s < sites; ++s) {
                result[c].exitance[s] += color * one.light->exitance[s];
                result[c].reflected[s] += color * one.light->reflected[s];
            }
        }
        if (!takes_away) continue;
        const auto above_zero = [](Lanes& e) {
            e = each_lane([&](std::size_t k) { return std::max(0.0F, e[k]); });
        };
        for (std::size_t s = 0; s < sites; ++s) {
            above_zero(result[c].exitance[s]);
            above_zero(result[c].reflected[s]);
        }
    }
    return result;
}

ShapeData::Colors ShapeData::colors(std::span<const SiteLight> solved) const {
    const std::size_t sites = solver->sites().sites().size();
    Colors result{std::vector<glm::dvec3>(sites, glm::dvec3(0.0)),
                  std::vector<glm::dvec3>(sites, glm::dvec3(0.0))};
    // Of three channels each has its column; gray light has all of them.
    const auto add = [&](std::size_t s, std::size_t of, const glm::dvec3& color) {
        const Pair pair = combine(solved[of].exitance[s], solved[of].reflected[s]);
        result.exitance[s] += pair.exitance * color;
        result.reflected[s] += pair.reflected * color;
    };
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            if (solved.size() == 1) {
                add(s, 0, glm::dvec3(1.0));
            } else {
                for (int c = 0; c < 3; ++c) {
                    glm::dvec3 channel(0.0);
                    channel[c] = 1.0;
                    add(s, static_cast<std::size_t>(c), channel);
                }
            }
            result.exitance[s] = glm::max(result.exitance[s], glm::dvec3(0.0));
        }
    };
    for_each_block(sites, options.threads, work, {}, sites_per_result_block);
    return result;
}

ShapeData::Matrices ShapeData::matrices(const SiteLight& solved) const {
    Matrices result{std::vector<glm::mat3>(solved.exitance.size()),
                    std::vector<glm::mat3>(solved.exitance.size())};
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const Pair pair = combine(solved.exitance[s], solved.reflected[s]);
            result.exitance[s] = glm::mat3(pair.exitance);
            result.reflected[s] = glm::mat3(pair.reflected);
        }
    };
    for_each_block(result.exitance.size(), options.threads, work, {}, sites_per_result_block);
    return result;
}

}  // namespace skinglow::detail
