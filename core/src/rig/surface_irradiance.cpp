#include "rig/surface_irradiance.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "numerics/argument_check.h"
#include "radiometry/area_angular_weight.h"
#include "radiometry/lamp_kernels.h"
#include "radiometry/prepared_light.h"

namespace skinglow {
namespace {

/// Beyond this, squares of squares overflow: such places and lamps are worked out one by one.
constexpr double widest_vectorized = 1e70;

struct Lamp {
    PreparedLight light;
    glm::dvec3 strength;  ///< power * color
    bool vectorized;
    std::optional<AreaAngularWeight> area_weight;  ///< of an area lamp, where angles count
};

double reach_of(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

std::vector<Lamp> prepare(std::span<const Light> lights, const AngularWeight* angular_weight) {
    std::vector<Lamp> lamps;
    for (const Light& light : lights) {
        validate(light);
        PreparedLight prepared(light);
        if (!is_on(light) || prepared.dark()) continue;
        const double reach = std::max({reach_of(light.position), light.radius, light.size_x, light.size_y});
        const bool tiny = light.kind == LightKind::area && std::max(light.size_x, light.size_y) < 1e-9;
        const glm::dvec3 strength = light.color * light.power;
        lamps.push_back({prepared, strength, reach < widest_vectorized && !tiny, {}});
        if (angular_weight != nullptr && prepared.area()) {
            lamps.back().area_weight.emplace(prepared, *angular_weight);
        }
    }
    return lamps;
}

/// Without leaving early: so the loop is vectorized.
bool all_finite(std::span<const glm::dvec3> values) {
    constexpr double most = std::numeric_limits<double>::max();
    int bad = 0;
    for (const glm::dvec3& v : values) {
        bad |= static_cast<int>(!(std::abs(v.x) <= most)) | static_cast<int>(!(std::abs(v.y) <= most)) |
               static_cast<int>(!(std::abs(v.z) <= most));
    }
    return bad == 0;
}

/// One thread's work on one block after another.
class BlockWorker {
  public:
    BlockWorker(std::span<const Lamp> lamps, const SurfaceOptions& options)
        : lamps_(lamps), options_(options) {}

    /// Fills sums; false, and then not all of them, where what is given or comes out is not finite.
    bool work(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
              std::span<glm::dvec3> sums) {
        load(points, normals);
        if (!(near_ || are_finite(places_.x, places_.y, places_.z)) ||
            !are_finite(places_.nx, places_.ny, places_.nz)) {
            return false;
        }
        normalize(places_);
        sum_ = {};
        for (const Lamp& lamp : lamps_) add(lamp);
        for (std::size_t i = 0; i < places_.count; ++i) {
            sums[i] = {sum_.red[i], sum_.green[i], sum_.blue[i]};
            if (options_.environment == nullptr || normal(i) == glm::dvec3(0.0)) continue;
            sums[i] += options_.environment->irradiance(normal(i), options_.angular_weight);
        }
        return all_finite(sums);
    }

  private:
    glm::dvec3 place(std::size_t i) const { return {places_.x[i], places_.y[i], places_.z[i]}; }
    glm::dvec3 normal(std::size_t i) const { return {places_.nx[i], places_.ny[i], places_.nz[i]}; }

    void load(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals) {
        places_.count = points.size();
        for (std::size_t i = 0; i < points.size(); ++i) {
            places_.x[i] = points[i].x;
            places_.y[i] = points[i].y;
            places_.z[i] = points[i].z;
            places_.nx[i] = normals[i].x;
            places_.ny[i] = normals[i].y;
            places_.nz[i] = normals[i].z;
        }
        near_ = are_within(places_.x, places_.y, places_.z, widest_vectorized);
    }

    bool are_within(const BlockValues& x, const BlockValues& y, const BlockValues& z, double most) const {
        const std::size_t count = places_.count;
        return all_within(x, count, most) && all_within(y, count, most) && all_within(z, count, most);
    }

    bool are_finite(const BlockValues& x, const BlockValues& y, const BlockValues& z) const {
        return are_within(x, y, z, std::numeric_limits<double>::max());
    }

    void add(const Lamp& lamp) {
        if (near_ && lamp.vectorized) {
            block_irradiance(lamp.light, places_, one_);
        } else {
            one_.special.fill(1.0);
        }
        if (any_special(one_, places_.count)) ask_one_by_one(lamp);
        if (options_.angular_weight != nullptr) return add_weighted(lamp);
        add_block(one_, lamp.strength, places_.count, sum_);
    }

    void ask_one_by_one(const Lamp& lamp) {
        for (std::size_t i = 0; i < places_.count; ++i) {
            if (one_.special[i] == 0.0) continue;
            const glm::dvec3 n = normal(i);
            one_.value[i] =
                n == glm::dvec3(0.0) ? 0.0 : lamp.light.irradiance(place(i), n, options_.area_tolerance);
        }
    }

    void add_weighted(const Lamp& lamp) {
        if (!lamp.area_weight) block_cosine(lamp.light, places_, cosine_);
        for (std::size_t i = 0; i < places_.count; ++i) {
            if (one_.value[i] == 0.0) continue;
            const glm::dvec3 term = lamp.strength * one_.value[i] * entering(lamp, i);
            sum_.red[i] += term.r;
            sum_.green[i] += term.g;
            sum_.blue[i] += term.b;
        }
    }

    /// What a lamp's light counts by its angle at a place.
    glm::dvec3 entering(const Lamp& lamp, std::size_t i) const {
        if (lamp.area_weight) return lamp.area_weight->mean(place(i), normal(i));
        const bool is_special = one_.special[i] != 0.0;
        return options_.angular_weight->at(is_special ? glm::dot(lamp.light.to_light(place(i)), normal(i))
                                                      : cosine_[i]);
    }

    std::span<const Lamp> lamps_;
    SurfaceOptions options_;
    bool near_ = true;
    PlaceBlock places_{};
    BlockIrradiance one_{};
    BlockValues cosine_{};
    BlockSum sum_{};
};

std::size_t thread_count(int wanted, std::size_t blocks, std::size_t lamps) {
    // A thread costs some 20 us to start, a block and lamp about 0.5 us.
    const std::size_t worth = blocks * std::max<std::size_t>(lamps, 1) / 256 + 1;
    const std::size_t allowed = wanted > 0 ? static_cast<std::size_t>(wanted)
                                           : std::max<std::size_t>(1, std::thread::hardware_concurrency());
    return std::min({allowed, worth, std::max<std::size_t>(1, blocks)});
}

void require_a_normal_each(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals) {
    if (points.size() == normals.size()) return;
    refuse_argument("number of normals", std::to_string(normals.size()),
                    "as many as points (" + std::to_string(points.size()) + ")");
}

}  // namespace

void require_places(std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals) {
    require_a_normal_each(points, normals);
    const auto validate_all = [](const char* name, std::span<const glm::dvec3> values) {
        if (all_finite(values)) return;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::dvec3& v = values[i];
            if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
            refuse_argument(std::string(name) + "[" + std::to_string(i) + "]", to_text(v),
                            "three finite numbers");
        }
    };
    validate_all("points", points);
    validate_all("normals", normals);
}

std::vector<glm::dvec3> surface_irradiance(std::span<const Light> lights, std::span<const glm::dvec3> points,
                                           std::span<const glm::dvec3> normals,
                                           const SurfaceOptions& options) {
    require_a_normal_each(points, normals);
    require_positive("area_tolerance", options.area_tolerance);
    const std::vector<Lamp> lamps = prepare(lights, options.angular_weight);
    std::vector<glm::dvec3> sums(points.size());
    const std::size_t blocks = (points.size() + block_capacity - 1) / block_capacity;
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> all_well = true;
    const auto take_blocks = [&] {
        const auto worker = std::make_unique<BlockWorker>(lamps, options);
        for (std::size_t block = next++; block < blocks; block = next++) {
            const std::size_t begin = block * block_capacity;
            const std::size_t count = std::min(block_capacity, points.size() - begin);
            if (!worker->work(points.subspan(begin, count), normals.subspan(begin, count),
                              std::span(sums).subspan(begin, count))) {
                all_well = false;
            }
        }
    };
    std::vector<std::thread> helpers;
    for (std::size_t i = 1; i < thread_count(options.threads, blocks, lamps.size()); ++i)
        helpers.emplace_back(take_blocks);
    take_blocks();
    for (std::thread& helper : helpers) helper.join();
    if (all_well) return sums;
    require_places(points, normals);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        require_finite("irradiance at points[" + std::to_string(i) + "]", sums[i]);
    }
    return sums;
}

Places far_side(std::span<const glm::dvec3> vertices, std::span<const glm::dvec3> normals,
                std::span<const double> depth) {
    require_places(vertices, normals);
    if (depth.size() != vertices.size() && depth.size() != 1) {
        refuse_argument("number of depths", std::to_string(depth.size()),
                        "1 or as many as vertices (" + std::to_string(vertices.size()) + ")");
    }
    for (std::size_t i = 0; i < depth.size(); ++i) {
        // The name is only put together where it is needed: this is a large part of the time otherwise.
        if (!(depth[i] >= 0.0 && std::isfinite(depth[i])))
            require_not_negative("depth[" + std::to_string(i) + "]", depth[i]);
    }
    Places far{std::vector<glm::dvec3>(vertices.size()), std::vector<glm::dvec3>(vertices.size())};
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (normals[i] != glm::dvec3(0.0)) far.normals[i] = -unit(normals[i]);
        far.points[i] = vertices[i] + far.normals[i] * (depth.size() == 1 ? depth[0] : depth[i]);
    }
    return far;
}

std::vector<glm::dvec3> far_side_irradiance(std::span<const Light> lights,
                                            std::span<const glm::dvec3> vertices,
                                            std::span<const glm::dvec3> normals,
                                            std::span<const double> depth, const SurfaceOptions& options) {
    const Places far = far_side(vertices, normals, depth);
    return surface_irradiance(lights, far.points, far.normals, options);
}

}  // namespace skinglow
