#include "shape/thin_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

#include "geometry/vector.h"
#include "geometry/weld.h"
#include "numerics/parallel_blocks.h"
#include "rays/direction_sampling.h"

namespace skinglow::detail {
namespace {

constexpr int thickness_rays = 9;
constexpr int rays_below = 3;  ///< that are shorter than the thickness: light takes the short ways
constexpr double cone_half_angle = 25 * std::numbers::pi / 180;

/// Sites by cubes of space.
class Blocks {
  public:
    Blocks(double edge, const glm::vec3& low) : edge_(edge), low_(low) {}

    glm::dvec3 key(const glm::vec3& p) const { return glm::floor(glm::dvec3(p - low_) / edge_); }

    void add(const glm::vec3& p, std::uint32_t item) {
        std::vector<std::uint32_t>& items = of_[key(p)];
        if (items.empty() || items.back() != item) items.push_back(item);
    }

    /// Whether this is the first call for a block.
    bool visit_once(const glm::dvec3& key) { return visited_.insert(key).second; }

    std::vector<std::uint32_t>* find(const glm::dvec3& key) {
        const auto found = of_.find(key);
        return found == of_.end() ? nullptr : &found->second;
    }

  private:
    struct Hash {
        std::size_t operator()(const glm::dvec3& v) const { return hash_of(v); }
    };
    double edge_;
    glm::vec3 low_;
    std::unordered_map<glm::dvec3, std::vector<std::uint32_t>, Hash> of_;
    std::unordered_set<glm::dvec3, Hash> visited_;
};

/// Parts along an edge of a triangle that is larger than a block.
constexpr int max_steps = 300;

std::vector<glm::vec3> triangle_points(const Body& body, const BodyTriangle& t, int parts) {
    std::vector<glm::vec3> points;
    const auto scale = static_cast<float>(parts);
    for (int i = 0; i <= parts; ++i) {
        for (int j = 0; i + j <= parts; ++j)
            points.push_back(body.at(t, static_cast<float>(i) / scale, static_cast<float>(j) / scale));
    }
    return points;
}

template <typename Visit>
void visit_neighborhood(Blocks& blocks, const glm::dvec3& key, const Visit& visit) {
    for (int n = 0; n < 27; ++n) {
        const glm::dvec3 next = key + glm::dvec3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
        if (auto* items = blocks.find(next)) visit(next, *items);
    }
}

/// Sites that are thin, and those about them: a crease between thin flesh and thick is lit by the thin one
/// however deep the flesh is below it. Not 0, one per site.
std::vector<std::uint8_t> thin_and_about(const SurfaceSites& sites, const std::vector<float>& thickness,
                                         double max_thickness, double margin, const glm::vec3& low) {
    // About means in the same or a neighboring block: half the margin to all of it away.
    Blocks thin(0.5 * margin, low);
    for (std::uint32_t i = 0; i < thickness.size(); ++i) {
        if (static_cast<double>(thickness[i]) < max_thickness) thin.add(sites.sites()[i].position, i);
    }
    std::vector<std::uint8_t> result(thickness.size(), 0);
    for (std::uint32_t i = 0; i < thickness.size(); ++i) {
        const Site& site = sites.sites()[i];
        if (!site.on_surface) continue;
        visit_neighborhood(thin, thin.key(site.position),
                           [&](const glm::dvec3&, const std::vector<std::uint32_t>&) { result[i] = 1; });
    }
    return result;
}

}  // namespace

std::vector<float> site_thickness(const FleshSurface& surface, const SurfaceSites& sites, int threads,
                                  const SitesDone& done) {
    const auto directions = cone_directions(thickness_rays, cone_half_angle);
    std::vector<float> thickness(sites.sites().size(), std::numeric_limits<float>::infinity());
    const auto work = [&](std::size_t begin, std::size_t end) {
        std::array<float, thickness_rays> lengths;
        for (std::size_t i = begin; i < end; ++i) {
            const Site& site = sites.sites()[i];
            if (!site.on_surface || site.normal == glm::vec3(0.0F)) continue;
            const glm::dmat3 frame = frame_around(-glm::normalize(glm::dvec3(site.normal)));
            const glm::vec3 origin = site.position - site.normal * surface.gap();
            for (std::size_t r = 0; r < lengths.size(); ++r) {
                const auto hit = surface.nearest(origin, frame * directions[r], 0.0F);
                lengths[r] = hit ? hit->distance : std::numeric_limits<float>::infinity();
            }
            std::nth_element(lengths.begin(), lengths.begin() + rays_below, lengths.end());
            thickness[i] = lengths[rays_below];
        }
    };
    for_each_block(thickness.size(), threads, work, done, 512);
    return thickness;
}

std::vector<ThinPart> thin_parts(const Body& body, const SurfaceSites& sites,
                                 const std::vector<float>& thickness, double max_thickness, double margin) {
    glm::vec3 low(0.0F);
    for (const glm::vec3& p : body.positions()) low = glm::min(low, p);
    Blocks thin(margin, low);
    Blocks vertices(margin, low);
    const std::vector<std::uint8_t> counts = thin_and_about(sites, thickness, max_thickness, margin, low);
    const auto is_thin = [&](std::size_t i) { return counts[i] != 0; };
    for (std::uint32_t i = 0; i < thickness.size(); ++i) {
        if (!is_thin(i)) continue;
        for (const glm::vec3& p : sites.spread(body, sites.sites()[i], static_cast<float>(margin)))
            thin.add(p, i);
    }
    for (std::uint32_t v = 0; v < body.welded_of().size(); ++v)
        vertices.add(body.positions()[body.welded_of()[v]], v);
    // A large triangle brings light from corners that may be far away.
    for (const BodyTriangle& t : body.triangles()) {
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 a = body.corner(t, k);
            const glm::vec3 b = body.corner(t, (k + 1) % 3);
            const auto steps = static_cast<int>(glm::length(b - a) / static_cast<float>(margin));
            if (steps == 0) continue;
            for (const glm::vec3& p : triangle_points(body, t, std::min(steps + 1, max_steps))) {
                for (int c = 0; c < 3; ++c) vertices.add(p, t.corners[c]);
            }
            break;
        }
    }
    std::vector<std::uint8_t> seen(thickness.size(), 0);
    std::vector<ThinPart> parts;
    for (std::uint32_t first = 0; first < thickness.size(); ++first) {
        if (seen[first] != 0 || !is_thin(first)) continue;
        ThinPart part;
        std::vector<glm::dvec3> open{thin.key(sites.sites()[first].position)};
        thin.visit_once(open.front());
        for (std::size_t next = 0; next < open.size(); ++next) {
            const glm::dvec3 key = open[next];
            for (const std::uint32_t i : *thin.find(key)) {
                if (seen[i] != 0) continue;
                seen[i] = 1;
                part.sites.push_back(i);
            }
            visit_neighborhood(thin, key, [&](const glm::dvec3& other, const std::vector<std::uint32_t>&) {
                if (thin.visit_once(other)) open.push_back(other);
            });
            visit_neighborhood(vertices, key,
                               [&](const glm::dvec3&, const std::vector<std::uint32_t>& items) {
                                   part.vertices.insert(part.vertices.end(), items.begin(), items.end());
                               });
        }
        std::sort(part.sites.begin(), part.sites.end());
        std::vector<float> sorted;
        for (const std::uint32_t i : part.sites) sorted.push_back(thickness[i]);
        const auto twentieth = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 20);
        std::nth_element(sorted.begin(), twentieth, sorted.end());
        part.thin_mm = static_cast<double>(*twentieth);
        std::sort(part.vertices.begin(), part.vertices.end());
        part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
        parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace skinglow::detail
