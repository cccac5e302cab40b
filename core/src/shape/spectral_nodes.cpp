#include "shape/spectral_nodes.h"

#include <skinglow/slab.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "numerics/argument_check.h"
#include "shape/thick_skin.h"
#include "skin/skin_optics.h"

namespace skinglow::detail {
namespace {

/// Where plane skin is made exact. Of the pairs tried, the one that leaves the least error over 1 to 8 mm.
constexpr std::array<double, 2> exact_at_mm = {1.5, 6.0};

/// Nodes lie below this effective attenuation, 1/mm: light that is dimmed more strongly is no longer seen
/// behind 1 mm of skin, and no grid of cells resolves it.
constexpr double largest_node_attenuation = 4.0;

/// Flesh so absorbing that skin without it is brighter makes no light: nothing of it is seen behind 1 mm.
constexpr double largest_factor = 4.0;

/// Transmittances below are taken as none.
constexpr double darkest = 1e-250;

/// Of light that scatters isotropically, in diffusion, 1/mm: the coordinate that nodes are spread over.
double effective_attenuation(double absorption, double reduced_scattering) {
    return std::sqrt(3.0 * absorption * (absorption + reduced_scattering));
}

/// A wavelength's or node's medium.
struct Medium {
    double absorption;
    double reduced_scattering;
    double attenuation;

    Medium(double mua, double mus)
        : absorption(mua), reduced_scattering(mus), attenuation(effective_attenuation(mua, mus)) {}
};

/// Plane skin at the two thicknesses: the logarithm of what comes through.
using TwoLogs = std::array<double, exact_at_mm.size()>;

/// Of the logarithm, before the first node: noise of nodes could make it any.
constexpr double largest_gain = 2.0;

/// Below the brightest node's, the least that counts of another one's logarithm.
constexpr double darkest_log = -1000.0;

/// Logarithm of what is not above 0.
constexpr double unknown = -std::numeric_limits<double>::infinity();

/// By how much a logarithm may be below the line of the two before it: tissues of any kind are less.
constexpr double largest_lack = 0.7;

/// Over this much more a node that is dark gives way to what the others say of it.
constexpr double fade = 4.0;

/// From the first node to the second light falls no more than this: 20 mm of skin.
constexpr double largest_fall = 24.0;

/// Replaces logarithms that noise has left dark, or unknown, by what the others say. What comes through is a sum
/// over paths, each of which falls exponentially with the attenuation: its logarithm falls from node to node,
/// and ever less. A node fades from known to unknown, so that a trace of light changes no more than a trace.
/// False where all are dark.
bool fill_dark(std::span<double> logs) {
    const std::size_t count = logs.size();
    std::array<double, SpectralNodes::max_count> falling{};
    for (std::size_t i = count; i-- > 0;)
        falling[i] = i + 1 < count ? std::max(logs[i], falling[i + 1]) : logs[i];
    if (falling[0] == unknown) return false;
    const auto share = [](double lack) { return std::clamp(lack / fade, 0.0, 1.0); };
    // Darker than a later one: between its neighbors.
    for (std::size_t i = 0; i < count; ++i) {
        const double gap = falling[i] > logs[i] && i > 0 ? share(falling[i] - logs[i]) : 0.0;
        logs[i] =
            gap > 0.0 ? std::lerp(falling[i], std::midpoint(logs[i - 1], falling[i + 1]), gap) : falling[i];
    }
    // Darker than those before it say: on their line.
    logs[1] = std::max(logs[1], logs[0] - largest_fall);
    for (std::size_t i = 2; i < count; ++i) {
        const double line = logs[i - 1] - std::max(0.0, logs[i - 2] - logs[i - 1]);
        const double lack = line - logs[i] - largest_lack;
        if (lack > 0.0) logs[i] = line - largest_lack * (1.0 - share(lack));
    }
    return true;
}

/// A medium on the line that the wavelengths' media form when they are sorted by attenuation.
struct NodePosition {
    std::size_t below;  ///< among the sorted
    double fraction;    ///< of the way to the next one
};
NodePosition position_of(std::span<const Medium> sorted, double attenuation) {
    const auto above = std::upper_bound(sorted.begin() + 1, sorted.end() - 1, attenuation,
                                        [](double x, const Medium& m) { return x < m.attenuation; });
    const auto below = static_cast<std::size_t>(above - sorted.begin()) - 1;
    const double step = sorted[below + 1].attenuation - sorted[below].attenuation;
    const double fraction = step > 0.0 ? (attenuation - sorted[below].attenuation) / step : 0.0;
    return {below, std::clamp(fraction, 0.0, 1.0)};
}

/// What comes through a plate of a node's medium in air.
TwoLogs plate(const Medium& medium, double refractive_index) {
    const Layer layer{.refractive_index = refractive_index,
                      .absorption = medium.absorption,
                      .scattering = medium.reduced_scattering};
    const ThicknessCurve curve({&layer, 1}, 0, Incidence::diffuse());
    TwoLogs logs{};
    for (std::size_t i = 0; i < logs.size(); ++i) {
        logs[i] = std::log(std::max(curve.transmittance(exact_at_mm[i]), darkest));
    }
    return logs;
}

/// The position between nodes whose light falls from the first to the second thickness as the skin's does. It
/// falls the faster, the farther right.
double matching_place(const NodeInterpolation& nodes, std::span<const double> falls, double fall,
                      double end) {
    double low = 0.0;
    double high = end;
    for (int i = 0; i < 60; ++i) {
        const double center = 0.5 * (low + high);
        (value_of(nodes.at(center), falls) < fall ? low : high) = center;
    }
    return 0.5 * (low + high);
}

/// A tissue at all wavelengths.
struct SkinSamples {
    std::vector<double>
        through;  ///< transmittance of plane skin: all of the first thickness, then the second
    std::vector<std::size_t> order;  ///< wavelengths ascending by the inner medium's attenuation
    Spectrum thick;                  ///< thick_skin
    std::vector<Medium> sorted;      ///< the inner media in that order

    explicit SkinSamples(const Tissue& tissue) : order(spectral_samples), thick(thick_skin(tissue)) {
        Spectrum wavelength_nm{};
        for (std::size_t k = 0; k < spectral_samples; ++k) wavelength_nm[k] = sample_wavelength_nm(k);
        through = transmittance(tissue, exact_at_mm, wavelength_nm, Incidence::diffuse());
        std::vector<Medium> media;
        media.reserve(spectral_samples);
        for (const SkinMedia& skin : SkinOptics(tissue, wavelength_nm).media)
            media.emplace_back(skin.inner.absorption, skin.inner.scattering * (1.0 - skin.inner.anisotropy));
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return media[a].attenuation < media[b].attenuation;
        });
        sorted.reserve(order.size());
        for (const std::size_t k : order) sorted.push_back(media[k]);
    }
};

/// Media of nodes that are evenly spread over those of a tissue.
std::vector<Medium> spread_media(const SkinSamples& skin, int count) {
    const double first = skin.sorted.front().attenuation;
    const double last =
        std::min(skin.sorted.back().attenuation, std::max(largest_node_attenuation, 2.0 * first));
    std::vector<Medium> media;
    media.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const NodePosition position = position_of(skin.sorted, first + (last - first) * i / (count - 1));
        const Medium& a = skin.sorted[position.below];
        const Medium& b = skin.sorted[position.below + 1];
        media.emplace_back(std::lerp(a.absorption, b.absorption, position.fraction),
                           std::lerp(a.reduced_scattering, b.reduced_scattering, position.fraction));
    }
    return media;
}

/// Positions and factors of a tissue's wavelengths among nodes of these media.
SpectralNodes assign(const SkinSamples& skin, std::span<const Medium> media, double refractive_index) {
    std::vector<double> at;
    std::vector<double> thin;   // logarithm of the transmittance at the first thickness, per node
    std::vector<double> falls;  // and by how much it falls to the second
    for (const Medium& medium : media) {
        const TwoLogs logs = plate(medium, refractive_index);
        at.push_back(medium.attenuation);
        thin.push_back(logs[0]);
        falls.push_back(logs[0] - logs[1]);
    }
    const NodeInterpolation interpolation(at);
    SpectralNodes result{.nodes = {}, .refractive_index = refractive_index, .thick = {}, .samples = {}};
    result.thick.assign(media.size(), glm::dmat3(0.0));
    const auto add_thick = [&](std::size_t k, double x) {
        const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, x);
        const auto i = static_cast<std::size_t>(above - at.begin());
        const double t = std::clamp((x - at[i - 1]) / (at[i] - at[i - 1]), 0.0, 1.0);
        Spectrum one{};
        one[k] = skin.thick[k];
        const glm::dmat3 matrix = transmission_matrix(one);
        result.thick[i - 1] += (1.0 - t) * matrix;
        result.thick[i] += t * matrix;
    };
    std::vector<double> factors(spectral_samples, 0.0);
    std::vector<SpectralSample> samples;
    samples.reserve(spectral_samples);
    for (std::size_t k = 0; k < spectral_samples; ++k) {
        const double through_thin = skin.through[k];
        const double through_thick = std::max(skin.through[spectral_samples + k], darkest);
        if (!(through_thin > darkest)) {
            add_thick(k, at.back());
            continue;
        }
        const double x =
            matching_place(interpolation, falls, std::log(through_thin / through_thick), 10.0 * at.back());
        add_thick(k, x);
        SpectralSample sample = interpolation.at(x);
        factors[k] = std::min(largest_factor, std::exp(std::log(through_thin) - value_of(sample, thin)));
        Spectrum one{};
        one[k] = 1.0;
        sample.matrix = factors[k] * transmission_matrix(one);
        samples.push_back(sample);
    }
    result.samples = in_runs(samples, media.size());
    for (const Medium& medium : media) {
        constexpr double smallest_factor = 1e-12;  // of a node behind an epidermis that lets nothing through
        const NodePosition position = position_of(skin.sorted, medium.attenuation);
        const double factor = std::sqrt(
            std::max(smallest_factor, std::lerp(factors[skin.order[position.below]],
                                                factors[skin.order[position.below + 1]], position.fraction)));
        result.nodes.push_back({medium.absorption, medium.reduced_scattering, factor, factor});
    }
    return result;
}

}  // namespace

SpectralNodes spectral_nodes(const Tissue& tissue, int count) {
    if (count < SpectralNodes::min_count || count > SpectralNodes::max_count) {
        refuse_argument("count of spectral nodes", std::to_string(count), "2 to 8");
    }
    const SkinSamples skin(tissue);
    return assign(skin, spread_media(skin, count), tissue.refractive_index);
}

SpectralNodes spectral_nodes(const Tissue& tissue, const SpectralNodes& of) {
    std::vector<Medium> media;
    media.reserve(of.nodes.size());
    for (const SpectralNodes::Node& node : of.nodes)
        media.emplace_back(node.absorption, node.reduced_scattering);
    return assign(SkinSamples(tissue), media, of.refractive_index);
}

glm::dmat3 SpectralNodes::combine(std::span<const double> exitance_at_nodes) const {
    if (exitance_at_nodes.size() != nodes.size()) {
        refuse_argument("exitance_at_nodes", std::to_string(exitance_at_nodes.size()) + " values",
                        "one for each of " + std::to_string(nodes.size()) + " nodes");
    }
    std::array<double, max_count> logs{};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double inside = exitance_at_nodes[i] / (nodes[i].entry_factor * nodes[i].exit_factor);
        logs[i] = inside > 0.0 ? std::log(inside) : unknown;
    }
    const std::span known = std::span(logs).first(nodes.size());
    glm::dmat3 matrix(0.0);
    if (!fill_dark(known)) return matrix;
    // The brightest node apart, so that single precision holds any light.
    const double brightest = *std::max_element(known.begin(), known.end());
    std::array<float, max_count> relative{};
    for (std::size_t i = 0; i < known.size(); ++i)
        relative[i] = static_cast<float>(std::max(known[i] - brightest, darkest_log));
    const std::array<double, 9> sum =
        sum_samples(samples, std::span(relative).first(known.size()), static_cast<float>(largest_gain));
    for (int entry = 0; entry < 9; ++entry)
        matrix[entry / 3][entry % 3] = std::exp(brightest) * sum[static_cast<std::size_t>(entry)];
    return matrix;
}

}  // namespace skinglow::detail
