#include "bench/peers/answering.h"
#include "bench/peers/embree/embree_handles.h"
#include "bench/peers/kernel_peers.h"

#include <map>
#include <memory>
#include <vector>

namespace boxwood::bench {
namespace {

/// One Embree scene per triangle or fan, as Embree offers its triangle test through a scene alone.
class RayCasesContender final : public Contender {
  public:
    RayCasesContender(const Job& job, RTCSceneFlags flags)
        : cases_(std::get<RayCases>(job.scene->cases)), device_(make_device(job)) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, RTCScene> made;
        for (const RayCase& c : cases_.rays) {
            RTCScene& scene = made[{c.first, c.count}];
            if (!scene) {
                scenes_.push_back(scene_of(c.first, c.count, flags));
                scene = scenes_.back().get();
            }
            scene_of_case_.push_back(scene);
        }
    }

    void build() override {}

    void query(Answers& answers) override {
        const FlushDenormals flush;
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(cases_.rays.size());
        QueryContext context;
        for (std::size_t i = 0; i < cases_.rays.size(); ++i) {
            RTCRayHit query{};
            query.ray = converted(cases_.rays[i].ray);
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            Tracing(scene_of_case_[i], false, context).intersect(query);
            hits[i] = hit_in(query);
        }
    }

  private:
    SceneHandle scene_of(std::uint32_t first, std::uint32_t count, RTCSceneFlags flags) const {
        Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        auto* corners = static_cast<Vec3<float>*>(
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Vec3<float>), std::size_t{3} * count));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), count));
        for (std::uint32_t i = 0; i < count; ++i) {
            const Triangle<float>& t = cases_.triangles[first + i];
            corners[3 * i] = t.a;
            corners[3 * i + 1] = t.b;
            corners[3 * i + 2] = t.c;
        }
        for (std::uint32_t i = 0; i < 3 * count; ++i)
            indices[i] = i;
        return commit(device_.get(), std::move(geometry), RTC_BUILD_QUALITY_MEDIUM, flags);
    }

    const RayCases& cases_;
    Device device_;
    std::vector<SceneHandle> scenes_;
    std::vector<RTCScene> scene_of_case_;
};

ContenderEntry entry(bool robust) {
    ContenderEntry e;
    e.name = robust ? "embree.triangle.robust" : "embree.triangle";
    e.library = "embree";
    e.kernel = e.name;
    e.summary = robust ? "Embree's triangle test in a ROBUST scene (watertight)"
                       : "Embree's triangle test in a default scene";
    e.notes = "a scene per triangle or fan, made before timing; the time holds rtcIntersect1 with "
              "its traversal of that scene; denormals flushed, as Embree wants";
    e.precision = "f32";
    e.runs_on = RunsOn::one_thread;
    e.answers = {answering<RayCasesContender>("ray_triangle", robust ? RTC_SCENE_FLAG_ROBUST
                                                                     : RTC_SCENE_FLAG_NONE)};
    return e;
}

} // namespace

std::vector<ContenderEntry> embree_kernels() { return {entry(false), entry(true)}; }

} // namespace boxwood::bench
