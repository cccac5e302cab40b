#include "shape/volume_monte_carlo.h"

#include <algorithm>
#include <cmath>

#include "numerics/parallel_blocks.h"
#include "shape/photon_walk.h"
#include "shape/ray_body.h"
#include "shape/weight_window.h"

namespace skinglow::testing {
namespace {

constexpr std::size_t blocks_per_half = 24;

/// Where photons start: triangles, and how much strikes each and those before it.
class Source {
  public:
    Source(const RayBody& body, std::span<const double> irradiance) : body_(body), irradiance_(irradiance) {
        up_to_.reserve(body.triangles().size());
        for (std::uint32_t i = 0; i < body.triangles().size(); ++i) {
            total_ += body.area(i) * mean(i);
            up_to_.push_back(total_);
        }
    }
    double total() const { return total_; }

    /// @param quantile  of the flux, 0 to 1
    void emit(double quantile, double weight, Random& random, Walk& walk) const {
        const auto found = std::upper_bound(up_to_.begin(), up_to_.end() - 1, quantile * total_);
        const auto triangle = static_cast<std::uint32_t>(found - up_to_.begin());
        const double brightness = mean(triangle);
        if (!(brightness > 0)) return;
        const double a = std::sqrt(random());
        const double b = random();
        const glm::dvec3 at(1.0 - a, a * (1.0 - b), a * b);
        const glm::uvec3& t = body_.triangles()[triangle];
        glm::dvec3 position(0.0);
        double here = 0;
        for (int k = 0; k < 3; ++k) {
            position += at[k] * body_.point(t[k]);
            here += at[k] * irradiance_[t[k]];
        }
        walk.start(triangle, position, weight * here / brightness);
    }

    WeightWindow window(const TurbidMedium& medium, std::span<const glm::dvec3> targets) const {
        std::vector<DimmedPoint> lit;
        const double brightest = *std::max_element(irradiance_.begin(), irradiance_.end());
        for (std::uint32_t i = 0; i < body_.triangles().size(); ++i) {
            const glm::uvec3& t = body_.triangles()[i];
            const glm::dvec3 center = (body_.point(t.x) + body_.point(t.y) + body_.point(t.z)) / 3.0;
            if (mean(i) > 1e-4 * brightest) lit.push_back({center, std::log(brightest / mean(i))});
        }
        const double reduced = medium.scattering * (1.0 - medium.anisotropy);
        // Somewhat less than diffusion dims: photons too many in the dark cost more than photons too few.
        const double rate = 0.85 * std::sqrt(3.0 * medium.absorption * (medium.absorption + reduced));
        return {lit, targets, rate};
    }

  private:
    double mean(std::uint32_t triangle) const {
        const glm::uvec3& t = body_.triangles()[triangle];
        return (irradiance_[t.x] + irradiance_[t.y] + irradiance_[t.z]) / 3.0;
    }

    const RayBody& body_;
    std::span<const double> irradiance_;
    std::vector<double> up_to_;
    double total_ = 0;
};

}  // namespace

Exitance volume_monte_carlo(std::span<const glm::dvec3> points, std::span<const glm::uvec3> triangles,
                            std::span<const double> irradiance, const TurbidMedium& medium,
                            const PhotonBudget& budget) {
    const RayBody body(points, triangles);
    const Source source(body, irradiance);
    Exitance result;
    for (auto& half : result.half) half.assign(points.size(), 0.0);
    result.incident = source.total();
    if (!(source.total() > 0)) return result;

    std::vector<glm::dvec3> targets;
    for (const std::uint32_t vertex : budget.targets) targets.push_back(points[vertex]);
    if (targets.empty()) targets.assign(points.begin(), points.end());
    const WeightWindow window = source.window(medium, targets);

    const std::int64_t photons = std::max<std::int64_t>(1, budget.photons / 2);  // of a half
    std::vector<Tally> tallies(2 * blocks_per_half);
    for_each_block(
        tallies.size(), budget.threads,
        [&](std::size_t block, std::size_t) {
            Tally& tally = tallies[block];
            tally.flux.assign(points.size(), 0.0);
            Random random(budget.seed, block);
            const double weight = source.total() / static_cast<double>(photons);
            Walk walk(body, medium, window, weight, Random(budget.seed, tallies.size() + block), tally);
            const auto part = static_cast<std::int64_t>(block % blocks_per_half);
            const auto end = photons * (part + 1) / static_cast<std::int64_t>(blocks_per_half);
            for (auto i = photons * part / static_cast<std::int64_t>(blocks_per_half); i < end; ++i) {
                const double quantile = (static_cast<double>(i) + random()) / static_cast<double>(photons);
                source.emit(quantile, weight, random, walk);
            }
        },
        {}, 1);

    std::vector<double> area(points.size(), 0.0);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) area[triangles[i][k]] += body.area(i) / 3.0;
    }
    for (std::size_t block = 0; block < tallies.size(); ++block) {
        std::vector<double>& half = result.half[block / blocks_per_half];
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (area[i] > 0) half[i] += tallies[block].flux[i] / area[i];
        }
        result.entered += 0.5 * tallies[block].entered;
        result.left += 0.5 * tallies[block].left;
        result.absorbed += 0.5 * tallies[block].absorbed;
        result.lost += 0.5 * tallies[block].lost;
    }
    return result;
}

}  // namespace skinglow::testing
