#include "bench/peers/embree_handles.h"
#include "bench/peers/point_peers.h"
#include "kernels/features/point_triangle.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace boxwood::bench {
namespace {

void bounds_of_item(const RTCBoundsFunctionArguments* args) {
    const Aabb<float>& box = static_cast<const Aabb<float>*>(args->geometryUserPtr)[args->primID];
    *args->bounds_o = {box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, 0};
}

/// rtcPointQuery around points: all within a radius, or the nearest with a radius that shrinks.
class PointQuery final : public Contender {
  public:
    explicit PointQuery(const Job& job)
        : scene_(*job.scene), ask_(job.task), k_(neighbours_of(scene_)), threads_(job.threads),
          vertices_(scene_.mesh.vertices), device_(make_device(job.threads)),
          arena_(static_cast<int>(job.threads)) {
        vertices_.emplace_back(); // Embree reads 16 bytes at the last vertex
    }

    void build() override {
        arena_.execute([&] {
            embree_scene_ = commit(device_.get(), ask_ == Ask::closest_points ? mesh() : items(),
                                   RTC_BUILD_QUALITY_HIGH, RTC_SCENE_FLAG_NONE);
        });
    }

    void query(Answers& answers) override {
        answers.pairs.clear();
        const std::size_t n = ask_ == Ask::regions ? scene_.spheres.size() : scene_.points.size();
        if (ask_ == Ask::nearest)
            answers.neighbours.resize(k_ * n);
        if (ask_ == Ask::closest_points)
            answers.surface_points.resize(n);
        const auto ask = [&](std::size_t begin, std::size_t end, std::vector<Pair>& pairs) {
            const FlushDenormals flush;
            for (std::size_t i = begin; i < end; ++i)
                answer(i, answers, pairs);
        };
        if (threads_ == 1)
            return ask(0, n, answers.pairs);
        for (std::vector<Pair>& part : parts_)
            part.clear();
        arena_.execute([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 256),
                              [&](const tbb::blocked_range<std::size_t>& r) {
                                  ask(r.begin(), r.end(), parts_.local());
                              });
        });
        for (const std::vector<Pair>& part : parts_)
            answers.pairs.insert(answers.pairs.end(), part.begin(), part.end());
    }

  private:
    Geometry items() const {
        Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(geometry.get(),
                                         static_cast<unsigned>(scene_.boxes.size()));
        rtcSetGeometryUserData(geometry.get(), const_cast<Aabb<float>*>(scene_.boxes.data()));
        rtcSetGeometryBoundsFunction(geometry.get(), bounds_of_item, nullptr);
        return geometry;
    }
    Geometry mesh() const {
        Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   vertices_.data(), 0, sizeof(Vec3<float>), vertices_.size() - 1);
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   scene_.mesh.triangles.data(), 0,
                                   sizeof(scene_.mesh.triangles[0]), scene_.mesh.triangles.size());
        return geometry;
    }

    struct Asked {
        const PointQuery* self;
        std::uint32_t query;
        std::vector<Pair>* pairs;
        NearestOfPeer* nearest;
        SurfacePoint* surface;
    };

    void answer(std::size_t i, Answers& answers, std::vector<Pair>& pairs) const {
        Asked asked{this, static_cast<std::uint32_t>(i), &pairs, nullptr, nullptr};
        const Vec3<float> p = ask_ == Ask::regions ? scene_.spheres[i].centre : scene_.points[i];
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        RTCPointQuery query{p.x, p.y, p.z, 0, std::numeric_limits<float>::infinity()};
        switch (ask_) {
        case Ask::points:
            query.radius = 0;
            rtcPointQuery(embree_scene_.get(), &query, &context, take_point, &asked);
            return;
        case Ask::regions:
            query.radius = scene_.spheres[i].radius * (1 + 0x1p-20f);
            rtcPointQuery(embree_scene_.get(), &query, &context, take_ball, &asked);
            return;
        case Ask::nearest: {
            NearestOfPeer nearest(std::span(answers.neighbours).subspan(i * k_, k_));
            asked.nearest = &nearest;
            rtcPointQuery(embree_scene_.get(), &query, &context, take_nearest, &asked);
            return;
        }
        default:
            asked.surface = &(answers.surface_points[i] = {});
            rtcPointQuery(embree_scene_.get(), &query, &context, take_triangle, &asked);
        }
    }

    static bool take_point(RTCPointQueryFunctionArguments* args) {
        const Asked& asked = *static_cast<const Asked*>(args->userPtr);
        const Scene& scene = asked.self->scene_;
        if (scene.boxes[args->primID].contains(scene.points[asked.query]))
            asked.pairs->push_back({asked.query, args->primID});
        return false;
    }
    static bool take_ball(RTCPointQueryFunctionArguments* args) {
        const Asked& asked = *static_cast<const Asked*>(args->userPtr);
        const Scene& scene = asked.self->scene_;
        if (meets(scene.spheres[asked.query], scene.boxes[args->primID]))
            asked.pairs->push_back({asked.query, args->primID});
        return false;
    }
    /// True once the radius has shrunk.
    static bool shrink(RTCPointQueryFunctionArguments* args, double squared) {
        const auto radius = static_cast<float>(std::sqrt(squared)) * (1 + 0x1p-22f);
        if (!(radius < args->query->radius))
            return false;
        args->query->radius = radius;
        return true;
    }
    static bool take_nearest(RTCPointQueryFunctionArguments* args) {
        const Asked& asked = *static_cast<const Asked*>(args->userPtr);
        const Scene& scene = asked.self->scene_;
        asked.nearest->offer(
            {args->primID, squared_distance(scene.points[asked.query], scene.boxes[args->primID])});
        return shrink(args, asked.nearest->worst());
    }
    static bool take_triangle(RTCPointQueryFunctionArguments* args) {
        const Asked& asked = *static_cast<const Asked*>(args->userPtr);
        const Scene& scene = asked.self->scene_;
        const auto at = point_triangle::Regions::nearest(scene.points[asked.query],
                                                         scene.mesh.triangle(args->primID));
        const auto squared = static_cast<double>(dot(at.offset, at.offset));
        if (!(squared < asked.surface->squared_distance))
            return false;
        *asked.surface = {at.b, args->primID, squared};
        return shrink(args, squared);
    }

    const Scene& scene_;
    Ask ask_;
    std::size_t k_;
    unsigned threads_;
    std::vector<Vec3<float>> vertices_;
    Device device_;
    tbb::task_arena arena_;
    SceneHandle embree_scene_;
    tbb::enumerable_thread_specific<std::vector<Pair>> parts_;
};

} // namespace

std::vector<ContenderEntry> embree_points() {
    ContenderEntry e;
    e.name = "embree.rtc_point_query";
    e.library = "embree";
    e.summary = "Embree's rtcPointQuery, a callback per item or triangle within the radius";
    e.notes = "build quality high (the fastest to query); points: radius 0; balls: the ball's "
              "radius, tested in doubles by the callback; nearest and closest_points: a radius "
              "that the callback shrinks; distances to triangles by our kernel in floats, as "
              "Embree brings none; no regions that are boxes; with several threads pairs go to "
              "one list per thread that are joined at the end";
    e.precision = "f32";
    e.unsupported = [](const Job& job) -> Unsupported {
        if (!is_point_ask(job.task))
            return "answers points, regions, nearest and closest_points only";
        if (job.task == Ask::regions && job.scene && !job.scene->regions.empty())
            return "asks about balls, not boxes";
        if (auto why = no_queries(job.scene, job.task))
            return why;
        return not_tbb(job);
    };
    e.make = [](const Job& job) { return std::make_unique<PointQuery>(job); };
    return {e};
}

} // namespace boxwood::bench
