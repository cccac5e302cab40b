#pragma once

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>

/// Rays by Embree alone: a lower bound for what is built on it.
namespace skinglow::benchmarks {

class BareEmbree {
  public:
    BareEmbree(std::span<const glm::dvec3> points, std::span<const glm::uvec3> corners) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* position = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points.size()));
        auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), corners.size()));
        for (const glm::dvec3& p : points) {
            for (int k = 0; k < 3; ++k) *position++ = static_cast<float>(p[k]);
        }
        for (const glm::uvec3& t : corners) {
            for (int k = 0; k < 3; ++k) *index++ = t[k];
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~BareEmbree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    BareEmbree(const BareEmbree&) = delete;
    BareEmbree& operator=(const BareEmbree&) = delete;

    /// rtcIntersect1: distance to the nearest triangle, infinite where there is none.
    float nearest(const glm::dvec3& origin, const glm::dvec3& direction) const {
        RTCRayHit query{};
        query.ray = ray(origin, direction);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(scene_, &query, nullptr);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &query);
#endif
        return query.ray.tfar;
    }

    /// rtcOccluded1.
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction) const {
        RTCRay query = ray(origin, direction);
#if RTC_VERSION_MAJOR >= 4
        rtcOccluded1(scene_, &query, nullptr);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(scene_, &context, &query);
#endif
        return query.tfar < 0;
    }

  private:
    static RTCRay ray(const glm::dvec3& origin, const glm::dvec3& direction) {
        RTCRay query{};
        query.org_x = static_cast<float>(origin.x);
        query.org_y = static_cast<float>(origin.y);
        query.org_z = static_cast<float>(origin.z);
        query.dir_x = static_cast<float>(direction.x);
        query.dir_y = static_cast<float>(direction.y);
        query.dir_z = static_cast<float>(direction.z);
        query.tnear = 1e-6F;
        query.tfar = std::numeric_limits<float>::infinity();
        query.mask = ~0U;
        return query;
    }

    RTCDevice device_ = rtcNewDevice("ignore_config_files=1");
    RTCScene scene_ = rtcNewScene(device_);
};

}  // namespace skinglow::benchmarks
