#include "rays/embree_triangles.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <limits>
#include <stdexcept>
#include <string>

namespace skinglow {
namespace {

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

/// What Embree hands back to the filter: its own context first, so that one points to the other.
struct FilterContext {
    QueryContext embree;
    std::span<const TriangleRange> without;
};

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("Embree: " + what);
}

void check(RTCDevice device, const char* doing) {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        fail(std::string(doing) + " failed with error code " + std::to_string(error));
}

RTCDevice open_device() {
    // No thread count: with TBB that would limit the whole process, and with it the host's renderer.
    RTCDevice device = rtcNewDevice("ignore_config_files=1");
    if (device == nullptr) fail("no device, error code " + std::to_string(rtcGetDeviceError(nullptr)));
    // Embree 3 and 4 share their names but not their calling conventions. Where a host has loaded the other
    // one for everybody, the calls land there and rays silently miss: refuse instead.
    const auto loaded = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_MAJOR);
    if (loaded != RTC_VERSION_MAJOR) {
        rtcReleaseDevice(device);
        fail("version " + std::to_string(loaded) +
             " answers in this process, but this was built for version " + std::to_string(RTC_VERSION_MAJOR) +
             "; load skinglow through `import skinglow`, or build it with a static Embree");
    }
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

/// Called for what a shadow ray meets: says no to triangles that do not count, and the ray goes on.
void leave_out(const RTCFilterFunctionNArguments* arguments) {
    const auto& without = reinterpret_cast<const FilterContext*>(arguments->context)->without;
    for (unsigned int i = 0; i < arguments->N; ++i) {
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
        for (const TriangleRange& range : without) {
            if (triangle >= range.begin && triangle < range.end) arguments->valid[i] = 0;
        }
    }
}

void add_triangles(RTCDevice device, RTCScene scene, std::span<const glm::dvec3> points,
                   std::span<const glm::uvec3> corners) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* to_point = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points.size()));
    auto* to_corner = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), corners.size()));
    if (to_point == nullptr || to_corner == nullptr) {
        rtcReleaseGeometry(geometry);
        fail("no memory for the mesh");
    }
    for (const glm::dvec3& p : points) {
        for (int k = 0; k < 3; ++k) *to_point++ = static_cast<float>(p[k]);
    }
    for (const glm::uvec3& t : corners) {
        for (int k = 0; k < 3; ++k) *to_corner++ = t[k];
    }
    rtcSetGeometryOccludedFilterFunction(geometry, leave_out);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

}  // namespace

struct EmbreeTriangles::Handles {
    RTCDevice device = open_device();
    RTCScene scene = rtcNewScene(device);

    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

EmbreeTriangles::EmbreeTriangles(std::span<const glm::dvec3> points, std::span<const glm::uvec3> corners)
    : handles_(std::make_unique<Handles>()) {
    // Robust: no ray slips through between two triangles that share an edge.
    rtcSetSceneFlags(handles_->scene, RTC_SCENE_FLAG_ROBUST);
    if (!corners.empty()) add_triangles(handles_->device, handles_->scene, points, corners);
    rtcCommitScene(handles_->scene);
    check(handles_->device, "building the scene");
}

EmbreeTriangles::~EmbreeTriangles() = default;

std::optional<EmbreeTriangles::Hit> EmbreeTriangles::nearest(const glm::dvec3& origin,
                                                             const glm::dvec3& direction, float from) const {
    RTCRayHit query{};
    query.ray = ray_from(origin, direction, from, std::numeric_limits<float>::infinity());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(handles_->scene, &query, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(handles_->scene, &context, &query);
#endif
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return Hit{query.hit.primID, query.ray.tfar};
}

bool EmbreeTriangles::occluded(const glm::dvec3& origin, const glm::dvec3& direction, float from, float to,
                               std::span<const TriangleRange> without) const {
    RTCRay ray = ray_from(origin, direction, from, to);
    FilterContext context{.embree = {}, .without = without};
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context.embree);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context.embree;
    rtcOccluded1(handles_->scene, &ray, &arguments);
#else
    rtcInitIntersectContext(&context.embree);
    rtcOccluded1(handles_->scene, &context.embree, &ray);
#endif
    return ray.tfar < 0;
}

}  // namespace skinglow
