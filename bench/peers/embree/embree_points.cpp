#include "bench/peers/answering.h"
#include "bench/peers/embree/embree_handles.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/query_order.h"
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
class EmbreePoints final : public Contender {
  public:
    EmbreePoints(const Job& job, PointQuery query, RTCBuildQuality quality, Asked asked)
        : scene_(*job.scene), query_(query), quality_(quality), k_(neighbours_of(scene_)),
          order_(job, query, asked), threads_(job.threads), vertices_(scene_.mesh.vertices),
          device_(make_device(job)), arena_(static_cast<int>(job.threads)) {
        vertices_.emplace_back(); // Embree reads 16 bytes at the last vertex
    }

    void build() override {
        arena_.execute([&] {
            embree_scene_.reset();
            embree_scene_ = commit(device_.get(),
                                   query_ == PointQuery::surface_point
                                       ? triangle_geometry(device_.get(), vertices_, scene_.mesh)
                                       : items(),
                                   quality_, RTC_SCENE_FLAG_NONE);
        });
    }

    void query(Answers& answers) override {
        const std::size_t n =
            query_ == PointQuery::overlapping ? scene_.spheres.size() : scene_.points.size();
        Out out;
        if (query_ == PointQuery::nearest)
            (out.neighbours = &list_of<Neighbour>(answers))->resize(k_ * n);
        else if (query_ == PointQuery::surface_point)
            (out.surface = &list_of<SurfacePoint>(answers))->resize(n);
        else
            (out.pairs = &list_of<Pair>(answers))->clear();
        order_.find();
        if (threads_ == 1)
            return answer_all(0, n, out);
        for (std::vector<Pair>& part : parts_)
            part.clear();
        arena_.execute([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 256),
                              [&](const tbb::blocked_range<std::size_t>& r) {
                                  Out own = out;
                                  own.pairs = &parts_.local();
                                  answer_all(r.begin(), r.end(), own);
                              });
        });
        if (out.pairs)
            for (const std::vector<Pair>& part : parts_)
                out.pairs->insert(out.pairs->end(), part.begin(), part.end());
    }

  private:
    /// Where the answers go, by the kind of query.
    struct Out {
        std::vector<Pair>* pairs = nullptr;
        std::vector<Neighbour>* neighbours = nullptr;
        std::vector<SurfacePoint>* surface = nullptr;
    };

    Geometry items() const {
        Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(geometry.get(),
                                         static_cast<unsigned>(scene_.boxes.size()));
        rtcSetGeometryUserData(geometry.get(), const_cast<Aabb<float>*>(scene_.boxes.data()));
        rtcSetGeometryBoundsFunction(geometry.get(), bounds_of_item, nullptr);
        return geometry;
    }
    struct Current {
        const EmbreePoints* self;
        std::uint32_t query;
        std::vector<Pair>* pairs;
        NearestOfPeer* nearest;
        SurfacePoint* surface;
    };

    void answer_all(std::size_t begin, std::size_t end, const Out& out) const {
        const FlushDenormals flush;
        for (std::size_t i = begin; i < end; ++i)
            answer(order_[i], out);
    }

    void answer(std::uint32_t i, const Out& out) const {
        Current current{this, i, out.pairs, nullptr, nullptr};
        const Vec3<float> p =
            query_ == PointQuery::overlapping ? scene_.spheres[i].centre : scene_.points[i];
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        RTCPointQuery query{p.x, p.y, p.z, 0, std::numeric_limits<float>::infinity()};
        switch (query_) {
        case PointQuery::containing:
            query.radius = 0;
            rtcPointQuery(embree_scene_.get(), &query, &context, take_point, &current);
            return;
        case PointQuery::overlapping:
            query.radius = scene_.spheres[i].radius * (1 + 0x1p-20f);
            rtcPointQuery(embree_scene_.get(), &query, &context, take_ball, &current);
            return;
        case PointQuery::nearest: {
            NearestOfPeer nearest(std::span(*out.neighbours).subspan(i * k_, k_));
            current.nearest = &nearest;
            rtcPointQuery(embree_scene_.get(), &query, &context, take_nearest, &current);
            return;
        }
        case PointQuery::surface_point:
            current.surface = &((*out.surface)[i] = {});
            rtcPointQuery(embree_scene_.get(), &query, &context, take_triangle, &current);
        }
    }

    static bool take_point(RTCPointQueryFunctionArguments* args) {
        const Current& current = *static_cast<const Current*>(args->userPtr);
        const Scene& scene = current.self->scene_;
        if (scene.boxes[args->primID].contains(scene.points[current.query]))
            current.pairs->push_back({current.query, args->primID});
        return false;
    }
    static bool take_ball(RTCPointQueryFunctionArguments* args) {
        const Current& current = *static_cast<const Current*>(args->userPtr);
        const Scene& scene = current.self->scene_;
        if (meets(scene.spheres[current.query], scene.boxes[args->primID]))
            current.pairs->push_back({current.query, args->primID});
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
        const Current& current = *static_cast<const Current*>(args->userPtr);
        const Scene& scene = current.self->scene_;
        current.nearest->offer({args->primID, squared_distance(scene.points[current.query],
                                                               scene.boxes[args->primID])});
        return shrink(args, current.nearest->worst());
    }
    static bool take_triangle(RTCPointQueryFunctionArguments* args) {
        const Current& current = *static_cast<const Current*>(args->userPtr);
        const Scene& scene = current.self->scene_;
        const auto at = point_triangle::Regions::nearest(scene.points[current.query],
                                                         scene.mesh.triangle(args->primID));
        const auto squared = static_cast<double>(dot(at.offset, at.offset));
        if (!(squared < current.surface->squared_distance))
            return false;
        *current.surface = {at.b, args->primID, squared};
        return shrink(args, squared);
    }

    const Scene& scene_;
    PointQuery query_;
    RTCBuildQuality quality_;
    std::size_t k_;
    QueryOrder order_;
    unsigned threads_;
    std::vector<Vec3<float>> vertices_;
    Device device_;
    tbb::task_arena arena_;
    SceneHandle embree_scene_;
    tbb::enumerable_thread_specific<std::vector<Pair>> parts_;
};

ContenderEntry point_query(RTCBuildQuality quality, Asked asked) {
    ContenderEntry e;
    e.name = "embree.rtc_point_query";
    if (quality != RTC_BUILD_QUALITY_HIGH)
        e.name += fmt::format(".{}", word_of(quality));
    e.name += name_of(asked);
    e.library = "embree";
    e.summary = "Embree's rtcPointQuery, a callback per item or triangle within the radius";
    e.notes = fmt::format(
        "build quality {}; {}; points: radius 0; balls: the ball's radius, tested in doubles by "
        "the "
        "callback; nearest and closest_points: a radius that the callback shrinks; distances to "
        "triangles by our kernel in floats, as Embree brings none; no regions that are boxes; with "
        "several threads pairs go to one list per thread that are joined at the end",
        word_of(quality), words_for(asked));
    e.precision = "f32";
    e.runs_on = RunsOn::tbb;
    e.classes = classes_of(asked);
    e.answers = {
        answering<EmbreePoints>("points", PointQuery::containing, quality, asked),
        answering<EmbreePoints>("regions", PointQuery::overlapping, quality, asked),
        answering<EmbreePoints>("nearest", PointQuery::nearest, quality, asked),
        answering<EmbreePoints>("closest_points", PointQuery::surface_point, quality, asked)};
    e.cannot = [](const Job& job) -> std::optional<std::string> {
        if (!job.scene->regions.empty())
            return "takes balls as regions, not boxes";
        return std::nullopt;
    };
    return e;
}

} // namespace

std::vector<ContenderEntry> embree_points() {
    std::vector<ContenderEntry> all;
    for (const Asked asked : {Asked::as_given, Asked::along_a_curve})
        for (const RTCBuildQuality quality : build_qualities)
            all.push_back(point_query(quality, asked));
    return all;
}

} // namespace boxwood::bench
