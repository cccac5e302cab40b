#include "shape/last_flight.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "numerics/job.h"
#include "numerics/parallel_blocks.h"
#include "shape/cosine_direction.h"
#include "shape/random_numbers.h"
#include "shape/surface_optics.h"

namespace skinglow::detail {
namespace {

/// Steps along a ray, in cells.
constexpr float step_cells = 0.6F;
constexpr int max_bounces = 6;
/// A ray that carries less goes on by chance, and carries this much then.
constexpr float least_weight = 0.05F;
/// A step counts where at least this part of the cells about it is known.
constexpr float least_part = 1e-3F;
constexpr float negligible_weight = 1e-6F;
constexpr std::size_t sites_per_flight_block = 64;

float largest(const Lanes& weight) {
    return std::max({weight[0], weight[1], weight[2], weight[3]});
}

/// Traces the rays of sites into rows.
class FlightTracer {
  public:
    FlightTracer(const FleshSurface& surface, const VoxelGrid& grid, const Ghosts& ghosts,
                 const LaneMedium& medium, const LastFlightOptions& options)
        : surface_(surface),
          body_(surface.body()),
          grid_(grid),
          ghosts_(ghosts),
          options_(options),
          fluence_(grid.size() + ghosts.of_modes.rows()),
          light_(body_.welded_of().size()),
          extinction_(medium.lanes([](const Sp3Medium& m) { return m.extinction; })),
          scattered_(medium.lanes([](const Sp3Medium& m) { return 0.25 * m.albedo; })),
          bend_(medium.lanes([&](const Sp3Medium& m) {
              const double x = m.decay[0] * static_cast<double>(grid.cell());
              return x * x / 6;
          })),
          per_step_(decay(step_cells * grid.cell())),
          index_n_(medium[0].refractive_index),
          escaping_(static_cast<float>(1 / (index_n_ * index_n_))),
          inside_reflectance_(static_cast<float>(medium[0].inside_reflectance)),
          transmittance_(static_cast<float>(medium[0].transmittance)),
          max_length_(static_cast<float>(max_flight_depth / medium.min_extinction())),
          step_(step_cells * grid.cell()),
          max_extinction_(std::max({extinction_[0], extinction_[1], extinction_[2], extinction_[3]})),
          center_(step_center(step_)) {
        for (std::size_t c = 0; c < corner_.size(); ++c)
            corner_[c] = grid.linear(
                {static_cast<int>(c >> 2U), static_cast<int>(c >> 1U & 1U), static_cast<int>(c & 1U)});
    }

    void trace(const SurfaceSites& all, std::uint32_t index, LastFlight& rows) {
        const Site& site = all.sites()[index];
        const auto pieces = all.pieces(site);
        float area = 0;
        for (const SitePiece& piece : pieces) area += body_.triangles()[piece.triangle].area;
        const Lattice5 lattice(options_.rays, index);
        for (int r = 0; r < options_.rays && site.on_surface; ++r) {
            const auto x = lattice.at(r);
            Ray ray = site.pieces == 0 ? from_point(site) : from_vertex(pieces, area, x);
            // From a point the even coordinate is free, and goes with the one of the golden ratio.
            const float turn = static_cast<float>(r) * 0.618034F + lattice.at(0)[1];
            ray.direction = site.pieces == 0
                                ? cosine_direction(-ray.normal, escaping_ * x[0], turn - std::floor(turn))
                                : cosine_direction(-ray.normal, escaping_ * x[3], x[4]);
            // About a smooth normal a few rays would leave through the triangle that they start from.
            if (site.pieces == 0) {
                const glm::vec3 outward = body_.triangles()[site.point.triangle].normal;
                const float out = glm::dot(ray.direction, outward);
                if (out > 0) ray.direction -= outward * (2 * out);
            }
            follow(ray, 131 * static_cast<std::uint64_t>(index) + static_cast<std::uint64_t>(r));
        }
        store(index, rows);
    }

  private:
    struct Ray {
        glm::vec3 origin;
        glm::vec3 normal;  ///< of the surface it starts from
        glm::vec3 direction{0.0F};
    };

    Lanes decay(float length) const {
        return each_lane([&](std::size_t k) { return std::exp(-extinction_[k] * length); });
    }

    Ray from_point(const Site& site) const {
        const BodyTriangle& t = body_.triangles()[site.point.triangle];
        return {site.position - t.normal * surface_.gap(), site.normal};
    }

    /// A point about a vertex, by its hat function.
    Ray from_vertex(std::span<const SitePiece> pieces, float area, const std::array<float, 5>& x) const {
        float pick = x[0] * area;
        const SitePiece* piece = &pieces.front();
        for (const SitePiece& each : pieces) {
            piece = &each;
            const float own = body_.triangles()[each.triangle].area;
            if (pick < own) break;
            pick -= own;
        }
        const BodyTriangle& t = body_.triangles()[piece->triangle];
        // Nearness b to the corner has the density 6 b (1 - b).
        const float b = 0.5F - std::sin(std::asin(1 - 2 * x[1]) / 3);
        const int k = piece->corner;
        const glm::vec3 point = body_.corner(t, k) * b + body_.corner(t, (k + 1) % 3) * ((1 - b) * x[2]) +
                                body_.corner(t, (k + 2) % 3) * ((1 - b) * (1 - x[2]));
        return {point - t.normal * surface_.gap(), t.normal};
    }

    void follow(Ray ray, std::uint64_t seed) {
        Lanes weight = Lanes::all(1 - inside_reflectance_);
        if (index_n_ > 1) weight = weight * (escaping_ * (1 - fresnel(ray.direction, ray.normal)));
        for (int bounce = 0; bounce < max_bounces; ++bounce) {
            const auto hit = surface_.nearest(ray.origin, ray.direction, max_length_);
            const float length = hit ? hit->distance : std::numeric_limits<float>::infinity();
            collect(ray, std::min(length, max_length_), weight);
            if (!hit) return;
            weight = weight * decay(length);
            if (largest(weight) < negligible_weight) return;
            const BodyTriangle& t = body_.triangles()[hit->triangle];
            const float reflected = index_n_ > 1 ? fresnel(ray.direction, t.normal) : inside_reflectance_;
            const auto n_sq = static_cast<float>(index_n_ * index_n_);
            const float entering = index_n_ > 1 ? n_sq * (1 - reflected) : transmittance_;
            const std::array<float, 3> at = {1 - hit->u - hit->v, hit->u, hit->v};
            for (int k = 0; k < 3; ++k)
                light_.at(t.corners[k]) += weight * (entering * at[static_cast<std::size_t>(k)]);
            weight = weight * reflected;
            const std::uint64_t salt = 3 * (seed * max_bounces + static_cast<std::uint64_t>(bounce));
            const float going_on = largest(weight) / least_weight;
            if (going_on < 1) {
                if (!(uniform_of(salt + 2) < going_on)) return;
                weight = weight * (1 / going_on);
            }
            const glm::vec3 inward = glm::dot(t.normal, ray.direction) < 0 ? t.normal : -t.normal;
            const glm::vec3 start = ray.origin + ray.direction * length + inward * surface_.gap();
            const glm::vec3 next = index_n_ > 1
                                       ? ray.direction - inward * (2 * glm::dot(ray.direction, inward))
                                       : cosine_direction(inward, uniform_of(salt), uniform_of(salt + 1));
            ray = {start, -inward, next};
        }
    }

    float fresnel(const glm::vec3& direction, const glm::vec3& normal) const {
        return static_cast<float>(
            fresnel_reflectance(index_n_, 1.0, std::min(1.0F, std::abs(glm::dot(direction, normal)))));
    }

    /// Where in a step what comes out of it was scattered last, in the mean, for the node that falls fastest.
    float step_center(float step) const {
        const float x = max_extinction_ * step;
        return x < 1e-2F ? 0.5F * step : step * (1 / x - 1 / std::expm1(x));
    }

    /// Linear interpolation between cells lies above a field that obeys laplace psi = decay^2 psi; by how
    /// much in the mean over directions, for the mode that reaches far.
    Lanes interpolation_factor(const glm::vec3& f) const {
        Lanes above = Lanes::all(1);
        for (int k = 0; k < 3; ++k) above = above * (Lanes::all(1) + bend_ * (f[k] * (1 - f[k])));
        return each_lane([&](std::size_t k) { return 1 / above[k]; });
    }

    /// Shares what each step of a ray scatters out among the cells about its middle.
    void collect(const Ray& ray, float length, Lanes weight) {
        const float scale = 1 / grid_.cell();
        const glm::vec3 start = (ray.origin - grid_.low()) * scale - 0.5F;
        // In a clear medium a ray that hits nothing is thousands of times as long as the body.
        const float leaving =
            grid_.leaving(start, ray.direction) * grid_.cell() + step_;  // rounding takes less
        for (float done = 0; done < length && done <= leaving; done += step_) {
            const float step = std::min(step_, length - done);
            const Lanes left = weight * (step < step_ ? decay(step) : per_step_);
            const float center = step < step_ ? step_center(step) : center_;
            const glm::vec3 at = start + ray.direction * ((done + center) * scale);
            const glm::ivec3 voxel(glm::floor(at));
            const glm::vec3 f = at - glm::vec3(voxel);
            // All eight lie in the box where the first and the last do.
            const bool is_in_box = grid_.has(voxel) && grid_.has(voxel + 1);
            const std::size_t first = is_in_box ? grid_.linear(voxel) : 0;
            std::array<std::int32_t, 8> cell;
            std::array<float, 8> part;
            float sum = 0;
            for (int c = 0; c < 8; ++c) {
                const auto i = static_cast<std::size_t>(c);
                if (is_in_box) {
                    cell[i] = ghosts_.index[first + corner_[i]];
                } else {
                    const glm::ivec3 corner = voxel + glm::ivec3(c >> 2, (c >> 1) & 1, c & 1);
                    cell[i] = grid_.has(corner) ? ghosts_.index[grid_.linear(corner)] : VoxelGrid::unknown;
                }
                part[i] = cell[i] < 0 ? 0.0F
                                      : ((c & 4) != 0 ? f.x : 1 - f.x) * ((c & 2) != 0 ? f.y : 1 - f.y) *
                                            ((c & 1) != 0 ? f.z : 1 - f.z);
                sum += part[i];
            }
            const Lanes left_in_step = weight - left;
            weight = left;
            if (sum < least_part) continue;
            const Lanes deposit = left_in_step * interpolation_factor(f) * (1 / sum);
            for (std::size_t i = 0; i < 8; ++i) {
                if (part[i] > 0) fluence_.at(static_cast<std::uint32_t>(cell[i])) += deposit * part[i];
            }
        }
    }

    void store(std::uint32_t index, LastFlight& rows) {
        const float per_ray = 1 / static_cast<float>(options_.rays);
        fluence_.take([&](std::uint32_t column, const Lanes& value) {
            const float kept = std::min(1.0F, largest(value) * per_ray / options_.small_entry);
            const std::uint64_t salt = (static_cast<std::uint64_t>(index) << 32U) + column;
            if (uniform_of(salt) < kept)
                rows.of_fluence.add(column, pack(value * scattered_ * (per_ray / kept)));
        });
        light_.take([&](std::uint32_t column, const Lanes& value) {
            rows.of_light.add(column, pack(value * per_ray));
        });
        rows.of_fluence.end_row();
        rows.of_light.end_row();
    }

    const FleshSurface& surface_;
    const Body& body_;
    const VoxelGrid& grid_;
    const Ghosts& ghosts_;
    LastFlightOptions options_;
    RowSums<Lanes> fluence_;
    RowSums<Lanes> light_;
    Lanes extinction_;
    Lanes scattered_;
    Lanes bend_;
    Lanes per_step_;
    double index_n_;
    float escaping_;  ///< of cosine-distributed rays, those that a smooth surface does not reflect totally
    float inside_reflectance_;
    float transmittance_;
    float max_length_;
    float step_;
    float max_extinction_;
    float center_;
    std::array<std::size_t, 8> corner_{};  ///< of a cube of cells, from the first one's place in the grid
};

}  // namespace

LastFlight last_flight(const FleshSurface& surface, const VoxelGrid& grid, const Ghosts& ghosts,
                       const LaneMedium& medium, const SurfaceSites& all,
                       std::span<const std::uint32_t> sites, const LastFlightOptions& options) {
    const std::size_t blocks = (sites.size() + sites_per_flight_block - 1) / sites_per_flight_block;
    std::vector<LastFlight> rows(blocks);
    // A few long runs of blocks, so that a tracer's tables are made seldom.
    const std::size_t per_run = std::max<std::size_t>(1, blocks / 16);
    const auto work = [&](std::size_t begin, std::size_t end) {
        FlightTracer tracer(surface, grid, ghosts, medium, options);
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t last = std::min(sites.size(), (b + 1) * sites_per_flight_block);
            for (std::size_t i = b * sites_per_flight_block; i < last; ++i) {
                stop_if_asked(8 * i);
                tracer.trace(all, sites[i], rows[b]);
            }
            rows[b].of_fluence.shrink();
            rows[b].of_light.shrink();
            finish_work(static_cast<double>(last - b * sites_per_flight_block));
        }
    };
    for_each_block(blocks, options.threads, work, {}, per_run);
    LastFlight result;
    std::size_t of_fluence = 0;
    std::size_t of_light = 0;
    for (const LastFlight& block : rows) {
        of_fluence += block.of_fluence.entries();
        of_light += block.of_light.entries();
    }
    result.of_fluence.reserve(sites.size(), of_fluence);
    result.of_light.reserve(sites.size(), of_light);
    for (LastFlight& block : rows) {
        stop_if_asked();
        result.of_fluence.append(block.of_fluence);
        result.of_light.append(block.of_light);
        block = {};
    }
    return result;
}

}  // namespace skinglow::detail
