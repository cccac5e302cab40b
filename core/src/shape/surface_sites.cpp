#include "shape/surface_sites.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "numerics/job.h"
#include "numerics/parallel_blocks.h"

namespace skinglow::detail {
namespace {

/// Cosine of the angle up to which triangles at a vertex are one smooth surface: between a corner of a box
/// and anything that is modeled as round.
constexpr float smooth = 0.5F;

glm::vec3 unit_or_zero(const glm::vec3& v) {
    const float l = glm::length(v);
    return l > 0 ? v / l : glm::vec3(0.0F);
}

int corner_at(const BodyTriangle& t, std::uint32_t welded) {
    return t.welded.x == welded ? 0 : (t.welded.y == welded ? 1 : 2);
}

/// Normal of some triangles, each counting by its area.
glm::vec3 normal_of(const Body& body, std::span<const std::uint32_t> triangles) {
    glm::vec3 sum(0.0F);
    for (const std::uint32_t i : triangles) sum += body.triangles()[i].normal * body.triangles()[i].area;
    return unit_or_zero(sum);
}

}  // namespace

SurfaceSites::SurfaceSites(const Body& body) : are_vertices_(true) {
    const std::vector<std::uint32_t>& welded_of = body.welded_of();
    site_of_.resize(welded_of.size());
    // The triangles of each vertex given; of one that has none (a repeated triangle's, a stray one), all at
    // its position.
    std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, std::uint32_t> known;
    for (std::uint32_t v = 0; v < welded_of.size(); ++v) {
        stop_if_asked(v);
        const std::uint32_t welded = welded_of[v];
        const auto around = body.triangles_at(welded);
        std::vector<std::uint32_t> own;
        for (const std::uint32_t i : around) {
            const glm::uvec3& c = body.triangles()[i].corners;
            if (c.x == v || c.y == v || c.z == v) own.push_back(i);
        }
        std::vector<std::uint32_t> taken(around.begin(), around.end());
        if (!own.empty() && own.size() < around.size()) {
            const glm::vec3 normal = normal_of(body, own);
            std::erase_if(taken, [&](std::uint32_t i) {
                return !std::binary_search(own.begin(), own.end(), i) &&
                       glm::dot(body.triangles()[i].normal, normal) < smooth;
            });
        }
        const auto [entry, is_new] =
            known.try_emplace({welded, taken}, static_cast<std::uint32_t>(sites_.size()));
        site_of_[v] = entry->second;
        if (!is_new) continue;
        Site site{body.positions()[welded], normal_of(body, taken)};
        site.first_piece = static_cast<std::uint32_t>(pieces_.size());
        site.pieces = static_cast<std::uint32_t>(taken.size());
        site.on_surface = !taken.empty();
        for (const std::uint32_t i : taken)
            pieces_.push_back({i, static_cast<std::uint8_t>(corner_at(body.triangles()[i], welded))});
        sites_.push_back(site);
    }
}

SurfaceSites::SurfaceSites(const Body& body, const TriangleTree& tree, std::span<const glm::vec3> points,
                           std::span<const glm::vec3> normals, int threads)
    : sites_(points.size()), site_of_(points.size()), are_vertices_(false) {
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 facing = normals.empty() ? glm::vec3(0.0F) : normals[i];
            Site& site = sites_[i];
            site = {points[i], facing};
            if (const auto found = tree.nearest(points[i], facing)) {
                const BodyTriangle& t = body.triangles()[found->triangle];
                site.position = body.at(t, found->u, found->v);
                // The given normal where the surface is smooth: on an edge the nearest triangle is either.
                site.normal = glm::dot(facing, t.normal) > smooth ? facing : t.normal;
                site.point = *found;
                site.on_surface = true;
            }
            site_of_[i] = static_cast<std::uint32_t>(i);
        }
    };
    for_each_block(points.size(), threads, work);
}

std::vector<glm::vec3> SurfaceSites::spread(const Body& body, const Site& site, float length) const {
    constexpr float most_parts = 300;
    std::vector<glm::vec3> points{site.position};
    for (const SitePiece& piece : pieces(site)) {
        const BodyTriangle& t = body.triangles()[piece.triangle];
        float longest = 0;
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, glm::length(body.corner(t, k) - body.corner(t, (k + 1) % 3)));
        if (longest <= length) continue;
        const int parts = static_cast<int>(std::min(most_parts, std::ceil(longest / length)));
        for (int i = 0; i <= parts; ++i) {
            for (int j = 0; i + j <= parts; ++j) {
                points.push_back(body.at(t, static_cast<float>(i) / static_cast<float>(parts),
                                         static_cast<float>(j) / static_cast<float>(parts)));
            }
        }
    }
    return points;
}

}  // namespace skinglow::detail
