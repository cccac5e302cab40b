#include "shape/thin_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "geometry/vector.h"
#include "numerics/job.h"
#include "numerics/parallel_blocks.h"
#include "rays/direction_sampling.h"
#include "shape/site_groups.h"
#include "shape/space_blocks.h"

namespace skinglow::detail {
namespace {

constexpr int thickness_rays = 9;
constexpr int rays_below = 3;  ///< that are shorter than the thickness: light takes the short ways
constexpr double cone_half_angle = 25 * std::numbers::pi / 180;
/// Sites within a margin of thin ones count, up to this part of it in full.
constexpr double full_weight = 0.5;

float thickness_of(const FleshSurface& surface, const Site& site, const std::vector<glm::dvec3>& directions,
                   double max_thickness) {
    const glm::dmat3 frame = frame_around(-glm::normalize(glm::dvec3(site.normal)));
    const glm::vec3 origin = site.position - site.normal * surface.gap();
    std::array<float, thickness_rays> lengths{};
    for (std::size_t r = 0; r < lengths.size(); ++r) {
        const auto hit = surface.nearest(origin, frame * directions[r], static_cast<float>(max_thickness));
        lengths[r] = hit ? hit->distance : std::numeric_limits<float>::infinity();
    }
    std::nth_element(lengths.begin(), lengths.begin() + rays_below, lengths.end());
    return lengths[rays_below];
}

bool is_thin(const SiteThickness& thickness, double max_thickness) {
    return static_cast<double>(std::min(thickness.along_normal, thickness.to_light)) < max_thickness;
}

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

/// The vertices whose light matters somewhere, by blocks of the distance that it comes from.
SpaceBlocks vertices_by_light(const Body& body, double distance) {
    SpaceBlocks vertices(distance);
    for (std::uint32_t v = 0; v < body.welded_of().size(); ++v)
        vertices.add(body.positions()[body.welded_of()[v]], v);
    // A large triangle brings light from corners that may be far away.
    for (std::size_t f = 0; f < body.triangles().size(); ++f) {
        stop_if_asked(f);
        const BodyTriangle& t = body.triangles()[f];
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 a = body.corner(t, k);
            const glm::vec3 b = body.corner(t, (k + 1) % 3);
            const auto steps = static_cast<int>(glm::length(b - a) / static_cast<float>(distance));
            if (steps == 0) continue;
            for (const glm::vec3& p : triangle_points(body, t, std::min(steps + 1, max_steps))) {
                for (int c = 0; c < 3; ++c) vertices.add(p, t.corners[c]);
            }
            break;
        }
    }
    return vertices;
}

/// Of each site, how much a solution about the thin ones counts: a crease between thin flesh and thick is
/// lit by the thin one however deep the flesh is below it, and farther on the light fades.
std::vector<float> site_weights(const SurfaceSites& sites, const std::vector<SiteThickness>& thickness,
                                double max_thickness, double margin) {
    NearestDistance to_thin(margin);
    for (std::size_t i = 0; i < thickness.size(); ++i) {
        if (is_thin(thickness[i], max_thickness)) to_thin.add(sites.sites()[i].position);
    }
    std::vector<float> weights(thickness.size(), 0.0F);
    for (std::size_t i = 0; i < thickness.size(); ++i) {
        stop_if_asked(i);
        const Site& site = sites.sites()[i];
        if (!site.on_surface) continue;
        if (is_thin(thickness[i], max_thickness)) {
            weights[i] = 1;
            continue;
        }
        const double left = (1 - to_thin(site.position) / margin) / (1 - full_weight);
        weights[i] = static_cast<float>(std::clamp(left, 0.0, 1.0));
    }
    return weights;
}

ThinPart make_part(const Body& body, const SurfaceSites& sites, std::vector<std::uint32_t> group,
                   const std::vector<SiteThickness>& thickness, const std::vector<float>& weights,
                   const SpaceBlocks& vertices, double margin) {
    ThinPart part;
    part.sites = std::move(group);
    std::sort(part.sites.begin(), part.sites.end());
    SpaceBlocks::Keys about;
    std::vector<float> sorted;
    for (const std::uint32_t i : part.sites) {
        stop_if_asked(part.weight.size());
        part.weight.push_back(weights[i]);
        sorted.push_back(thickness[i].along_normal);
        for (const glm::vec3& p : sites.spread(body, sites.sites()[i], static_cast<float>(margin))) {
            if (!about.insert(vertices.key(p)).second) continue;
            vertices.visit_about(vertices.key(p),
                                 [&](const glm::dvec3&, const std::vector<std::uint32_t>& items) {
                                     part.vertices.insert(part.vertices.end(), items.begin(), items.end());
                                 });
        }
    }
    const auto twentieth = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 20);
    std::nth_element(sorted.begin(), twentieth, sorted.end());
    part.thin_mm = static_cast<double>(*twentieth);
    std::sort(part.vertices.begin(), part.vertices.end());
    part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
    return part;
}

/// Gives each vertex to the part that it is nearest to.
void share_vertices(const Body& body, const SurfaceSites& sites, double margin,
                    std::vector<ThinPart>& parts) {
    const std::size_t count = body.welded_of().size();
    std::vector<double> least(count, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> owner(count, parts.size());
    for (std::size_t p = 0; p < parts.size(); ++p) {
        NearestDistance to_part(margin);
        for (const std::uint32_t i : parts[p].sites) {
            for (const glm::vec3& point :
                 sites.spread(body, sites.sites()[i], static_cast<float>(0.5 * margin)))
                to_part.add(point);
        }
        for (const std::uint32_t v : parts[p].vertices) {
            const double distance = to_part(body.positions()[body.welded_of()[v]]);
            stop_if_asked(v);
            if (distance >= least[v]) continue;
            least[v] = distance;
            owner[v] = p;
        }
    }
    for (std::uint32_t v = 0; v < count; ++v) {
        if (owner[v] < parts.size()) parts[owner[v]].own_vertices.push_back(v);
    }
}

}  // namespace

std::vector<SiteThickness> site_thickness(const FleshSurface& surface, const SurfaceSites& sites,
                                          double max_thickness, int threads, const SitesDone& done) {
    const auto narrow = cone_directions(thickness_rays, cone_half_angle);
    const auto wide = cosine_directions(thickness_rays);
    std::vector<SiteThickness> thickness(sites.sites().size());
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Site& site = sites.sites()[i];
            if (!site.on_surface || site.normal == glm::vec3(0.0F)) continue;
            thickness[i].along_normal = thickness_of(surface, site, narrow, max_thickness);
            thickness[i].to_light = thickness_of(surface, site, wide, max_thickness);
        }
    };
    for_each_block(thickness.size(), threads, work, done, 512);
    return thickness;
}

std::vector<ThinPart> thin_parts(const Body& body, const SurfaceSites& sites,
                                 const std::vector<SiteThickness>& thickness, double max_thickness,
                                 double margin, double light_distance) {
    const std::vector<float> weights = site_weights(sites, thickness, max_thickness, margin);
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        if (weights[i] > 0) chosen.push_back(i);
    }
    if (chosen.empty()) return {};
    const SpaceBlocks vertices = vertices_by_light(body, light_distance);
    std::vector<ThinPart> parts;
    for (std::vector<std::uint32_t>& group : site_groups(body, sites, chosen, margin))
        parts.push_back(make_part(body, sites, std::move(group), thickness, weights, vertices, margin));
    if (!sites.are_vertices()) share_vertices(body, sites, margin, parts);
    return parts;
}

}  // namespace skinglow::detail
