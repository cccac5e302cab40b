#include <skinglow/occlusion.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <string>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "numerics/parallel_blocks.h"
#include "radiometry/prepared_light.h"
#include "rays/occluder_scene.h"
#include "rays/visible_fraction.h"
#include "rig/rig_data.h"

namespace skinglow {
namespace detail {
namespace {

/// Left out at the ends of a ray, relative to their coordinates: some ten roundings of single precision.
constexpr double end_tolerance = 1e-6;
/// The same at the very origin, in units of the scene.
constexpr double min_end = 1e-12;
/// Added to the box of all triangles, for what rounding moves a corner.
constexpr double box_margin = 1e-6;

/// Distances along a ray; empty where `from` is above `to`.
struct Interval {
    double from;
    double to;
};

/// The part of a ray that lies in a box.
Interval inside_box(const glm::dvec3& start, const glm::dvec3& direction, const Box& box) {
    Interval inside{0.0, std::numeric_limits<double>::infinity()};
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0.0) {
            if (start[k] < box.min[k] || start[k] > box.max[k]) return {1.0, 0.0};
            continue;
        }
        const double a = (box.min[k] - start[k]) / direction[k];
        const double b = (box.max[k] - start[k]) / direction[k];
        inside.from = std::max(inside.from, std::min(a, b));
        inside.to = std::min(inside.to, std::max(a, b));
    }
    return inside;
}

}  // namespace

OccluderScene::OccluderScene(std::span<const MeshView> meshes, const std::optional<glm::dvec3>& origin) {
    if (origin) require_finite("origin", *origin);
    std::size_t total = 0;
    for (const MeshView& mesh : meshes) total += mesh.triangles().size();
    if (total > std::numeric_limits<std::uint32_t>::max() / 3)
        refuse_argument("number of triangles", std::to_string(total), "a third of what 32 bits can count");
    fit(meshes, origin);
    std::vector<glm::dvec3> points;
    std::vector<glm::uvec3> corners;
    for (const MeshView& mesh : meshes) {
        const auto begin = static_cast<std::uint32_t>(corners.size());
        const auto first = static_cast<std::uint32_t>(points.size());
        if (scale_ > 0.0) {
            const auto vertices = mesh.vertices();
            // A vertex that no triangle uses may lie anywhere; it only has to be a number.
            for (const glm::dvec3& v : vertices) points.push_back(glm::clamp(local(v), -2.0, 2.0));
            for (const glm::uvec3& t : mesh.triangles()) {
                if (triangle_normal(vertices[t.x], vertices[t.y], vertices[t.z]) != glm::dvec3(0.0))
                    corners.push_back(t + first);
            }
        }
        ranges_.push_back({begin, static_cast<std::uint32_t>(corners.size())});
    }
    if (!corners.empty()) triangles_ = std::make_unique<EmbreeTriangles>(points, corners);
}

void OccluderScene::fit(std::span<const MeshView> meshes, const std::optional<glm::dvec3>& origin) {
    const std::optional<Box> box = box_of(meshes);
    if (!box) return;
    origin_ = origin ? *origin : box->center();
    // With halves, because the difference of two huge coordinates may overflow where theirs does not.
    scale_ = 2.0 * std::max(max_abs(0.5 * box->min - 0.5 * origin_), max_abs(0.5 * box->max - 0.5 * origin_));
    if (!std::isfinite(scale_)) {
        refuse_argument("meshes", "as far as " + to_text(box->max) + " from " + to_text(origin_),
                        "distances below the largest double");
    }
    if (scale_ > 0.0) bounds_ = {local(box->min) - box_margin, local(box->max) + box_margin};
}

glm::dvec3 OccluderScene::local(const glm::dvec3& point) const {
    return (0.5 * point - 0.5 * origin_) / (0.5 * scale_);
}

std::vector<TriangleRange> OccluderScene::triangles_of(std::span<const std::size_t> meshes) const {
    std::vector<TriangleRange> found;
    for (const std::size_t mesh : meshes) {
        if (mesh >= ranges_.size()) {
            refuse_argument("excluded mesh", std::to_string(mesh),
                            "below the number of meshes (" + std::to_string(ranges_.size()) + ")");
        }
        found.push_back(ranges_[mesh]);
    }
    return found;
}

bool OccluderScene::occluded(const glm::dvec3& point, const glm::dvec3& direction, double distance,
                             std::span<const TriangleRange> excluded) const {
    if (!triangles_) return false;
    const glm::dvec3 start = local(point);
    // So far off that all meshes together are a point to it.
    if (!std::isfinite(start.x) || !std::isfinite(start.y) || !std::isfinite(start.z)) return false;
    const Interval inside = inside_box(start, direction, bounds_);
    const double local_distance = distance / scale_;
    const double from = std::max({inside.from, end_tolerance * max_abs(start), min_end});
    const double to =
        std::min(inside.to, local_distance - end_tolerance * (local_distance + max_abs(start)) - min_end);
    if (!(from < to)) return false;
    // A ray from outside begins at the box: over a longer distance single precision would lose the box.
    const glm::dvec3 moved = start + inside.from * direction;
    return triangles_->occluded(moved, direction, static_cast<float>(from - inside.from),
                                static_cast<float>(to - inside.from), excluded);
}

}  // namespace detail

Occluders::Occluders(std::span<const MeshView> meshes, const std::optional<glm::dvec3>& origin)
    : scene_(std::make_shared<detail::OccluderScene>(meshes, origin)) {}

std::size_t Occluders::meshes() const {
    return scene_->meshes();
}

std::size_t Occluders::triangles() const {
    return scene_->triangles();
}

namespace {

constexpr int max_samples = 4096;
/// Relative error of the irradiance, which only weighs points against one another.
constexpr double weight_tolerance = 1e-4;

void validate(const VisibilityOptions& options) {
    require_between("samples", options.samples, 1, max_samples);
    if (options.threads < 0) refuse_argument("threads", std::to_string(options.threads), "0 (all) or more");
}

/// Weighted mean of a column; 1 where all weights are 0.
double weighted_mean(std::span<const double> values, std::span<const double> weights, std::size_t column,
                     std::size_t columns) {
    double largest = 0;
    for (std::size_t i = column; i < weights.size(); i += columns) largest = std::max(largest, weights[i]);
    if (largest == 0.0) return 1.0;
    double sum = 0;
    double total = 0;
    for (std::size_t i = column; i < weights.size(); i += columns) {
        sum += weights[i] / largest * values[i];
        total += weights[i] / largest;
    }
    return std::min(1.0, sum / total);
}

}  // namespace

VisibleFraction visible_fraction(const Occluders& occluders, const PreparedRig& rig,
                                 std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals,
                                 const VisibilityOptions& options) {
    validate(options);
    require_surface(points, normals);
    const OccluderScene& scene = occluders.scene();
    const std::vector<TriangleRange> excluded = scene.triangles_of(options.excluded);
    const std::vector<RigLight>& lights = rig.data().prepared;
    const std::size_t columns = lights.size();
    VisibleFraction result{std::vector<double>(points.size() * columns, 1.0),
                           std::vector<double>(columns, 1.0)};
    if (scene.triangles() == 0) return result;
    std::vector<double> irradiance(result.at_points.size(), 0.0);
    const auto work = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t p = i / columns;
            const std::size_t k = i % columns;
            if (!lights[k].shines || normals[p] == glm::dvec3(0.0)) continue;
            const glm::dvec3 normal = unit(normals[p]);
            irradiance[i] = lights[k].light.irradiance(points[p], normal, weight_tolerance);
            if (!(irradiance[i] > 0.0)) continue;
            const auto sees = [&](const LightSample& ray) {
                return !scene.occluded(points[p], ray.direction, ray.distance, excluded);
            };
            result.at_points[i] = visible_fraction_at(LightSampler(lights[k].light, points[p], normal), p,
                                                      options.samples, sees);
        }
    };
    for_each_block(irradiance.size(), options.threads, work, {});
    for (std::size_t k = 0; k < columns; ++k)
        result.mean[k] = weighted_mean(result.at_points, irradiance, k, columns);
    return result;
}

}  // namespace skinglow
