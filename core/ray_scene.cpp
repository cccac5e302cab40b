#include "ray_scene.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

#include "cone_sampling.h"

namespace skinglow {
namespace {

/// Step past a hit, in edges of the unit box. Single precision places a hit to some 1e-7 of it.
constexpr float step_past_hit = 1e-6F;
/// Surfaces a ray may cross; a mesh so tangled gives no answer rather than an endless loop.
constexpr int most_crossings = 256;

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

RTCRayHit ray_from(const glm::dvec3& origin, const glm::dvec3& direction) {
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(origin.x);
    query.ray.org_y = static_cast<float>(origin.y);
    query.ray.org_z = static_cast<float>(origin.z);
    query.ray.dir_x = static_cast<float>(direction.x);
    query.ray.dir_y = static_cast<float>(direction.y);
    query.ray.dir_z = static_cast<float>(direction.z);
    query.ray.mask = ~0U;
    return query;
}

void intersect(RTCScene scene, RTCRayHit& query, float from) {
    query.ray.tnear = from;
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &query, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
#endif
}

bool occluded(RTCScene scene, RTCRay ray) {
    ray.tnear = step_past_hit;  // past the triangle the ray starts on
    ray.tfar = std::numeric_limits<float>::infinity();
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, &ray, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
#endif
    return ray.tfar < 0;
}

void add_mesh(RTCDevice device, RTCScene scene, const WeldedMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions().size()));
    auto* corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles().size()));
    if (points == nullptr || corners == nullptr) {
        rtcReleaseGeometry(geometry);
        fail("no memory for the mesh");
    }
    for (const glm::dvec3& p : mesh.positions()) {
        for (int k = 0; k < 3; ++k) *points++ = static_cast<float>(p[k]);
    }
    for (const WeldedTriangle& t : mesh.triangles()) {
        for (int k = 0; k < 3; ++k) *corners++ = t.corners[k];
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

}  // namespace

struct RayScene::Embree {
    RTCDevice device = open_device();
    RTCScene scene = rtcNewScene(device);

    Embree() = default;
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

RayScene::RayScene(const WeldedMesh& mesh) : mesh_(mesh), embree_(std::make_unique<Embree>()) {
    // Robust: no ray slips through between two triangles that share an edge.
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    if (!mesh.triangles().empty()) add_mesh(embree_->device, embree_->scene, mesh);
    rtcCommitScene(embree_->scene);
    check(embree_->device, "building the scene");
}

RayScene::~RayScene() = default;

double RayScene::openness(std::uint32_t triangle, std::span<const glm::dvec3> directions) const {
    const WeldedTriangle& t = mesh_.triangles()[triangle];
    const auto& p = mesh_.positions();
    const glm::dvec3 middle = (p[t.corners.x] + p[t.corners.y] + p[t.corners.z]) / 3.0;
    const Frame frame = Frame::around(t.unit_normal);
    std::size_t free = 0;
    for (const glm::dvec3& local : directions) {
        if (!occluded(embree_->scene, ray_from(middle, frame.to_world(local)).ray)) ++free;
    }
    return static_cast<double>(free) / static_cast<double>(directions.size());
}

std::optional<std::uint32_t> RayScene::exit_triangle(std::uint32_t welded,
                                                     const glm::dvec3& direction) const {
    const auto own = mesh_.triangles_at(welded);
    RTCRayHit query = ray_from(mesh_.positions()[welded], direction);
    float from = step_past_hit;
    int bodies =
        1;  // around the ray; the start counts as inside, so that a ray that begins outside never reaches 0
    for (int crossing = 0; crossing < most_crossings; ++crossing) {
        intersect(embree_->scene, query, from);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
        from = query.ray.tfar + step_past_hit;
        const std::uint32_t triangle = query.hit.primID;
        // A ray meets the triangles of the vertex it starts from nowhere else: such a hit is a rounding
        // error.
        if (std::binary_search(own.begin(), own.end(), triangle)) continue;
        if (!closed_.empty() && closed_[triangle] != 0) continue;
        const double along = glm::dot(direction, mesh_.triangles()[triangle].unit_normal);
        if (along > 0 && --bodies == 0) return triangle;
        if (along < 0) ++bodies;
    }
    return std::nullopt;
}

}  // namespace skinglow
