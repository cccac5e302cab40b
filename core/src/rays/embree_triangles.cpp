#include "rays/embree_triangles.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "numerics/job.h"

namespace skinglow::detail {
namespace {

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

/// What Embree hands back to a filter: its own context first, so that one points to the other.
struct FilterContext {
    QueryContext embree;
    std::span<const TriangleRange> excluded;  ///< for reject_excluded
    const HitVisitor* visitor;                ///< for show_to_visitor
};

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("Embree: " + what);
}

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

Owned<RTCDevice> open_device() {
    // No thread count: with TBB that would limit the whole process, and with it the host's renderer.
    Owned<RTCDevice> device(rtcNewDevice("ignore_config_files=1"));
    if (device == nullptr) fail("no device, error code " + std::to_string(rtcGetDeviceError(nullptr)));
    require_embree(rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                   rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED));
    return device;
}

RTCRay ray_from(const glm::dvec3& origin, const glm::dvec3& direction, float from, float to) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tnear = from;
    ray.tfar = to;
    ray.mask = ~0U;
    return ray;
}

/// Occlusion filter: rejects hits on excluded triangles.
void reject_excluded(const RTCFilterFunctionNArguments* arguments) {
    const auto& excluded = reinterpret_cast<const FilterContext*>(arguments->context)->excluded;
    for (unsigned int i = 0; i < arguments->N; ++i) {
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
        for (const TriangleRange& range : excluded) {
            if (triangle >= range.begin && triangle < range.end) arguments->valid[i] = 0;
        }
    }
}

/// Intersection filter: shows each hit to the visitor and rejects it, so that the ray goes on; or accepts it
/// to end the ray at the limit. Without a visitor every hit counts.
void show_to_visitor(const RTCFilterFunctionNArguments* arguments) {
    const HitVisitor* asked = reinterpret_cast<const FilterContext*>(arguments->context)->visitor;
    if (asked == nullptr) return;
    const HitVisitor& visitor = *asked;
    for (unsigned int i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        float& end = RTCRayN_tfar(arguments->ray, arguments->N, i);
        const float limit = visitor(end, RTCHitN_primID(arguments->hit, arguments->N, i));
        if (limit == std::numeric_limits<float>::infinity()) {
            arguments->valid[i] = 0;
        } else {
            end = limit;
        }
    }
}

/// Whether building a scene goes on.
bool is_wanted(void* job, double) {
    return !static_cast<const Job*>(job)->is_stopped();
}

void add_triangles(RTCDevice device, RTCScene scene, std::span<const glm::dvec3> points,
                   std::span<const glm::uvec3> corners, HitFilters filters) {
    const Owned<RTCGeometry> owner(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    RTCGeometry geometry = owner.get();
    auto* to_point = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points.size()));
    auto* to_corner = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), corners.size()));
    if (to_point == nullptr || to_corner == nullptr) fail("no memory for the mesh");
    for (const glm::dvec3& p : points) {
        for (int k = 0; k < 3; ++k) *to_point++ = static_cast<float>(p[k]);
    }
    for (const glm::uvec3& t : corners) {
        for (int k = 0; k < 3; ++k) *to_corner++ = t[k];
    }
    if (filters == HitFilters::on) {
        rtcSetGeometryOccludedFilterFunction(geometry, reject_excluded);
        rtcSetGeometryIntersectFilterFunction(geometry, show_to_visitor);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
}

RTCRayHit intersect(RTCScene scene, const glm::dvec3& origin, const glm::dvec3& direction, float from,
                    float to, const HitVisitor* visitor) {
    RTCRayHit query{};
    query.ray = ray_from(origin, direction, from, to);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    FilterContext context{.embree = {}, .excluded = {}, .visitor = visitor};
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context.embree);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context.embree;
    rtcIntersect1(scene, &query, &arguments);
#else
    rtcInitIntersectContext(&context.embree);
    rtcIntersect1(scene, &context.embree, &query);
#endif
    return query;
}

#if RTC_VERSION_MAJOR >= 4
RTCOccludedArguments coherent_arguments(QueryContext& context) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    return arguments;
}
#endif

void occluded_by(RTCScene scene, const int* valid, RTCRay4& rays, QueryContext& context) {
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments = coherent_arguments(context);
    rtcOccluded4(valid, scene, &rays, &arguments);
#else
    rtcOccluded4(valid, scene, &context, &rays);
#endif
}

void occluded_by(RTCScene scene, const int* valid, RTCRay8& rays, QueryContext& context) {
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments = coherent_arguments(context);
    rtcOccluded8(valid, scene, &rays, &arguments);
#else
    rtcOccluded8(valid, scene, &context, &rays);
#endif
}

/// @tparam Packet  RTCRay4 or RTCRay8
template <typename Packet>
void find_occluded(RTCScene scene, std::span<const RaySegment> rays, std::span<std::uint8_t> result) {
    constexpr std::size_t width = std::extent_v<decltype(Packet::tfar)>;
    FilterContext context{.embree = {}, .excluded = {}, .visitor = nullptr};
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context.embree);
#else
    rtcInitIntersectContext(&context.embree);
    context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
    for (std::size_t begin = 0; begin < rays.size(); begin += width) {
        const std::size_t count = std::min(width, rays.size() - begin);
        alignas(32) std::array<int, width> valid{};
        Packet packet{};
        for (std::size_t i = 0; i < count; ++i) {
            const RaySegment& ray = rays[begin + i];
            valid[i] = -1;
            packet.org_x[i] = ray.origin.x;
            packet.org_y[i] = ray.origin.y;
            packet.org_z[i] = ray.origin.z;
            packet.dir_x[i] = ray.direction.x;
            packet.dir_y[i] = ray.direction.y;
            packet.dir_z[i] = ray.direction.z;
            packet.tnear[i] = ray.from;
            packet.tfar[i] = ray.to;
            packet.mask[i] = ~0U;
        }
        occluded_by(scene, valid.data(), packet, context.embree);
        for (std::size_t i = 0; i < count; ++i) result[begin + i] = packet.tfar[i] < 0 ? 1 : 0;
    }
}

}  // namespace

void require_embree(long version_major, long filter_functions) {
    // Embree 3 and 4 share their names but not their calling conventions: where a host has loaded the other
    // one for everybody, the calls land there and rays silently miss.
    if (version_major != RTC_VERSION_MAJOR) {
        fail("version " + std::to_string(version_major) +
             " answers in this process, but this was built for version " + std::to_string(RTC_VERSION_MAJOR) +
             "; build it with a static Embree, as its packages have");
    }
    // Embree stores a filter that it was built not to call, and reports nothing.
    if (filter_functions == 0) {
        fail(
            "this build of it calls no filter functions, which leave meshes out of occlusion and find "
            "thickness; "
            "build Embree with EMBREE_FILTER_FUNCTION=ON, its default");
    }
}

struct EmbreeTriangles::Handles {
    Owned<RTCDevice> device = open_device();
    Owned<RTCScene> scene{rtcNewScene(device.get())};
    // What Embree was built without it refuses, or does ray by ray.
    bool has_packets_of_8 =
        rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
    bool has_packets_of_4 =
        rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED) != 0;
};

EmbreeTriangles::EmbreeTriangles(std::span<const glm::dvec3> points, std::span<const glm::uvec3> corners,
                                 HitFilters filters)
    : handles_(std::make_shared<Handles>()) {
    RTCDevice device = handles_->device.get();
    RTCScene scene = handles_->scene.get();
    // Robust: no ray slips through between two triangles that share an edge.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    if (!corners.empty()) add_triangles(device, scene, points, corners, filters);
    Job* const job = Job::current();
    if (job != nullptr) rtcSetSceneProgressMonitorFunction(scene, is_wanted, job);
    rtcCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
    stop_if_asked();
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        fail("building the scene failed with error code " + std::to_string(error));
}

void EmbreeTriangles::visit(const glm::dvec3& origin, const glm::dvec3& direction, float from,
                            const HitVisitor& visitor) const {
    intersect(handles_->scene.get(), origin, direction, from, std::numeric_limits<float>::infinity(),
              &visitor);
}

std::optional<TriangleHit> EmbreeTriangles::nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                                                    float from, float to) const {
    const RTCRayHit found = intersect(handles_->scene.get(), origin, direction, from, to, nullptr);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return TriangleHit{found.ray.tfar, found.hit.primID, found.hit.u, found.hit.v};
}

bool EmbreeTriangles::occluded(const glm::dvec3& origin, const glm::dvec3& direction, float from, float to,
                               std::span<const TriangleRange> excluded) const {
    RTCRay ray = ray_from(origin, direction, from, to);
    FilterContext context{.embree = {}, .excluded = excluded, .visitor = nullptr};
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context.embree);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context.embree;
    rtcOccluded1(handles_->scene.get(), &ray, &arguments);
#else
    rtcInitIntersectContext(&context.embree);
    rtcOccluded1(handles_->scene.get(), &context.embree, &ray);
#endif
    return ray.tfar < 0;
}

void EmbreeTriangles::occluded(std::span<const RaySegment> rays, std::span<std::uint8_t> result) const {
    RTCScene scene = handles_->scene.get();
    if (handles_->has_packets_of_8) {
        find_occluded<RTCRay8>(scene, rays, result);
    } else if (handles_->has_packets_of_4) {
        find_occluded<RTCRay4>(scene, rays, result);
    } else {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const RaySegment& ray = rays[i];
            result[i] = occluded(ray.origin, ray.direction, ray.from, ray.to) ? 1 : 0;
        }
    }
}

}  // namespace skinglow::detail
