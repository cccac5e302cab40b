#include "shape/reentry.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "geometry/vector.h"
#include "numerics/job.h"
#include "numerics/parallel_blocks.h"
#include "rays/direction_sampling.h"

namespace skinglow::detail {
namespace {

constexpr int rays = 64;
constexpr std::size_t sites_per_reentry_block = 128;

}  // namespace

Reentry::Reentry(const FleshSurface& surface, const SurfaceSites& sites, std::span<const std::uint8_t> wanted,
                 int threads)
    : row_of_(wanted.size(), not_wanted), seen_(wanted.size(), 0) {
    const Body& body = surface.body();
    std::vector<std::uint32_t> row_of_site(sites.sites().size(), not_wanted);
    std::vector<std::uint32_t> chosen;
    for (std::size_t v = 0; v < wanted.size(); ++v) {
        const std::uint32_t s = sites.site_of()[v];
        if (wanted[v] == 0 || !sites.sites()[s].on_surface) continue;
        if (row_of_site[s] == not_wanted) {
            row_of_site[s] = static_cast<std::uint32_t>(chosen.size());
            chosen.push_back(s);
        }
        row_of_[v] = row_of_site[s];
    }
    const auto directions = cosine_directions(rays);
    const std::size_t blocks = (chosen.size() + sites_per_reentry_block - 1) / sites_per_reentry_block;
    std::vector<SparseRows<float>> parts(blocks);
    const auto work = [&](std::size_t begin, std::size_t end) {
        RowSums<float> sums(wanted.size());
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t last = std::min(chosen.size(), (b + 1) * sites_per_reentry_block);
            for (std::size_t i = b * sites_per_reentry_block; i < last; ++i) {
                stop_if_asked(i);
                const Site& site = sites.sites()[chosen[i]];
                if (site.normal != glm::vec3(0.0F)) {
                    const glm::dmat3 frame = frame_around(glm::normalize(glm::dvec3(site.normal)));
                    const glm::vec3 origin = site.position + site.normal * (4 * surface.gap());
                    for (const glm::dvec3& local : directions) {
                        const glm::vec3 direction = frame * local;
                        const auto hit = surface.nearest(origin, direction);
                        if (!hit) continue;
                        const BodyTriangle& t = body.triangles()[hit->triangle];
                        if (glm::dot(t.normal, direction) >= 0) continue;
                        sums.at(t.corners.x) += (1 - hit->u - hit->v) / rays;
                        sums.at(t.corners.y) += hit->u / rays;
                        sums.at(t.corners.z) += hit->v / rays;
                    }
                }
                sums.take([&](std::uint32_t column, float value) { parts[b].add(column, value); });
                parts[b].end_row();
            }
        }
    };
    for_each_block(blocks, threads, work, {}, std::max<std::size_t>(1, blocks / 16));
    std::size_t entries = 0;
    for (const SparseRows<float>& part : parts) entries += part.entries();
    rows_.reserve(chosen.size(), entries);
    for (SparseRows<float>& part : parts) {
        rows_.append(part);
        part = {};
    }
    for (const std::uint32_t v : rows_.all_columns()) seen_[v] = 1;
}

void Reentry::add_irradiance(std::span<const Lanes> exitance, std::span<Lanes> irradiance,
                             int threads) const {
    std::vector<Lanes> of_row(rows_.rows());
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
            const auto from = rows_.columns(r);
            const auto weight = rows_.values(r);
            for (std::size_t i = 0; i < from.size(); ++i) of_row[r] += exitance[from[i]] * weight[i];
        }
    };
    for_each_block(of_row.size(), threads, work, {}, 2048);
    for (std::size_t v = 0; v < row_of_.size(); ++v) {
        if (row_of_[v] != not_wanted) irradiance[v] += of_row[row_of_[v]];
    }
}

}  // namespace skinglow::detail
