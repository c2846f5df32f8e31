#pragma once

#include "kernels/primitives/ray.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

/// Embree's handles with owners, for the files of its peer.
namespace boxwood::bench {

/// Embree wants its callers to flush denormals; the thread's own setting comes back at the end.
class FlushDenormals {
  public:
#if defined(__SSE2__)
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); } // FTZ and DAZ
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;

  private:
    unsigned saved_;
#endif
};

template <auto Release> struct Releaser {
    template <class Handle> void operator()(Handle handle) const { Release(handle); }
};
template <class Handle, auto Release>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Releaser<Release>>;
using Device = Owned<RTCDevice, rtcReleaseDevice>;
using SceneHandle = Owned<RTCScene, rtcReleaseScene>;
using Geometry = Owned<RTCGeometry, rtcReleaseGeometry>;

/// While a device with so many threads lives, all of TBB in this process is held to them.
inline Device make_device(unsigned threads) {
    Device device(rtcNewDevice(fmt::format("threads={},set_affinity=0", threads).c_str()));
    if (!device)
        throw std::runtime_error(fmt::format("embree: no device with {} threads (error {})",
                                             threads,
                                             static_cast<int>(rtcGetDeviceError(nullptr))));
    return device;
}

inline void throw_if_failed(RTCDevice device, const char* what) {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        throw std::runtime_error(
            fmt::format("embree: {} failed (error {})", what, static_cast<int>(error)));
}

/// A committed scene of one geometry. What a geometry wants of REFIT counts in a scene of LOW
/// alone.
inline SceneHandle commit(RTCDevice device, Geometry geometry, RTCBuildQuality quality,
                          RTCSceneFlags flags) {
    rtcSetGeometryBuildQuality(geometry.get(), quality);
    rtcCommitGeometry(geometry.get());
    SceneHandle scene(rtcNewScene(device));
    rtcSetSceneBuildQuality(scene.get(),
                            quality == RTC_BUILD_QUALITY_REFIT ? RTC_BUILD_QUALITY_LOW : quality);
    rtcSetSceneFlags(scene.get(), flags);
    rtcAttachGeometry(scene.get(), geometry.get());
    rtcCommitScene(scene.get());
    throw_if_failed(device, "building the scene");
    return scene;
}

inline RTCRay converted(const Ray<float>& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            ray.t_min,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            ray.t_max,
            ~0u,
            0,
            0};
}

/// With room for a hit.
inline RTCRayHit hit_by(const Ray<float>& ray) {
    RTCRayHit query{};
    query.ray = converted(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

inline RayHit hit_of(const RTCRayHit& query) {
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return {};
    return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
}

inline RayHit closest(RTCScene scene, RTCRayHit query) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
    return hit_of(query);
}

} // namespace boxwood::bench
