#pragma once

#include "bench/tasks/contender.h"
#include "kernels/primitives/ray.h"

#if defined(BOXWOOD_EMBREE_4)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

/// Embree's handles with owners, and what its versions 3 and 4 call differently, for the files of
/// its peer.
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

constexpr std::array build_qualities{RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM,
                                     RTC_BUILD_QUALITY_HIGH};
inline const char* word_of(RTCBuildQuality quality) {
    switch (quality) {
    case RTC_BUILD_QUALITY_LOW:
        return "low";
    case RTC_BUILD_QUALITY_MEDIUM:
        return "medium";
    case RTC_BUILD_QUALITY_HIGH:
        return "high";
    case RTC_BUILD_QUALITY_REFIT:
        return "refit";
    }
    throw std::logic_error("embree: no such build quality");
}

/// For the threads and the instruction set of a job. While it lives, all of TBB in this process is
/// held to so many threads.
inline Device make_device(const Job& job) {
    std::string settings = fmt::format("threads={},set_affinity=0", job.threads);
    if (!job.isa.empty())
        settings += ",isa=" + (job.isa == "baseline" ? "sse4.2" : job.isa);
    Device device(rtcNewDevice(settings.c_str()));
    if (!device)
        throw std::runtime_error(fmt::format("embree: no device with {} (error {})", settings,
                                             static_cast<int>(rtcGetDeviceError(nullptr))));
    return device;
}

inline void throw_if_failed(RTCDevice device, const char* what) {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        throw std::runtime_error(
            fmt::format("embree: {} failed (error {})", what, static_cast<int>(error)));
}

/// The triangles of a mesh, shared with it; one vertex more than the mesh has follows, as Embree
/// reads 16 bytes at the last one.
inline Geometry triangle_geometry(RTCDevice device, std::span<const Vec3<float>> vertices_and_one,
                                  const TriangleMesh& mesh) {
    Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               vertices_and_one.data(), 0, sizeof(Vec3<float>),
                               vertices_and_one.size() - 1);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(mesh.triangles[0]),
                               mesh.triangles.size());
    return geometry;
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

/// In Embree's form, which has no room for a hit.
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

inline RayHit hit_in(const RTCRayHit& answered) {
    if (answered.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return {};
    return {answered.ray.tfar, answered.hit.u, answered.hit.v, answered.hit.primID};
}
/// A hit has some triangle number; Embree does not say which triangle it was.
inline RayHit any_hit_by(float tfar) {
    RayHit hit;
    if (tfar < 0) // -inf marks a hit
        hit.triangle = 0;
    return hit;
}

#if defined(BOXWOOD_EMBREE_4)
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

/// Rays at one scene, 1, 8 or 16 in a call, or a stream. The flag and the context, which has to
/// live as long, hold for all of them.
class Tracing {
  public:
    Tracing(RTCScene scene, bool is_coherent, QueryContext& context) : scene_(scene) {
#if defined(BOXWOOD_EMBREE_4)
        rtcInitRayQueryContext(&context);
        rtcInitIntersectArguments(&closest_);
        rtcInitOccludedArguments(&any_);
        closest_.context = any_.context = &context;
        if (is_coherent)
            closest_.flags = any_.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
        rtcInitIntersectContext(&context);
        if (is_coherent)
            context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        context_ = &context;
#endif
    }

    void intersect(RTCRayHit& ray) { closest(rtcIntersect1, ray); }
    void intersect(const int* valid, RTCRayHit8& rays) { closest(rtcIntersect8, rays, valid); }
    void intersect(const int* valid, RTCRayHit16& rays) { closest(rtcIntersect16, rays, valid); }
    void occluded(RTCRay& ray) { any(rtcOccluded1, ray); }
    void occluded(const int* valid, RTCRay8& rays) { any(rtcOccluded8, rays, valid); }
    void occluded(const int* valid, RTCRay16& rays) { any(rtcOccluded16, rays, valid); }
#if !defined(BOXWOOD_EMBREE_4)
    void intersect(std::span<RTCRayHit> rays) {
        rtcIntersect1M(scene_, context_, rays.data(), static_cast<unsigned>(rays.size()),
                       sizeof(RTCRayHit));
    }
    void occluded(std::span<RTCRay> rays) {
        rtcOccluded1M(scene_, context_, rays.data(), static_cast<unsigned>(rays.size()),
                      sizeof(RTCRay));
    }
    void intersect(const RTCRayHitNp& rays, std::size_t n) {
        rtcIntersectNp(scene_, context_, &rays, static_cast<unsigned>(n));
    }
    void occluded(const RTCRayNp& rays, std::size_t n) {
        rtcOccludedNp(scene_, context_, &rays, static_cast<unsigned>(n));
    }
#endif

  private:
#if defined(BOXWOOD_EMBREE_4)
    template <class Function, class Rays, class... Valid>
    void closest(Function function, Rays& rays, Valid... valid) {
        function(valid..., scene_, &rays, &closest_);
    }
    template <class Function, class Rays, class... Valid>
    void any(Function function, Rays& rays, Valid... valid) {
        function(valid..., scene_, &rays, &any_);
    }
    RTCIntersectArguments closest_;
    RTCOccludedArguments any_;
#else
    template <class Function, class Rays, class... Valid>
    void closest(Function function, Rays& rays, Valid... valid) {
        function(valid..., scene_, context_, &rays);
    }
    template <class Function, class Rays, class... Valid>
    void any(Function function, Rays& rays, Valid... valid) {
        closest(function, rays, valid...);
    }
    QueryContext* context_;
#endif
    RTCScene scene_;
};

} // namespace boxwood::bench
