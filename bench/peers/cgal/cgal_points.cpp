#include "bench/peers/answering.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/query_order.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace boxwood::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point_of(Vec3<float> p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

class ClosestPoint final : public Contender {
  public:
    ClosestPoint(const Job& job, Asked asked)
        : scene_(*job.scene), threads_(job.threads), arena_(static_cast<int>(job.threads)),
          order_(job, PointQuery::surface_point, asked) {
        for (std::size_t i = 0; i < scene_.mesh.triangles.size(); ++i) {
            const Triangle<float> t = scene_.mesh.triangle(i);
            triangles_.emplace_back(point_of(t.a), point_of(t.b), point_of(t.c));
        }
    }

    void build() override {
        tree_.clear();
        tree_.insert(triangles_.cbegin(), triangles_.cend());
        tree_.build();
        tree_.accelerate_distance_queries();
    }

    void query(Answers& answers) override {
        order_.find();
        std::vector<SurfacePoint>& nearest = list_of<SurfacePoint>(answers);
        nearest.resize(scene_.points.size());
        const auto answer = [&](std::size_t place) {
            const std::uint32_t i = order_[place];
            const Kernel::Point_3 p = point_of(scene_.points[i]);
            const auto [at, triangle] = tree_.closest_point_and_primitive(p);
            nearest[i] = {Vec3<float>(Vec3<double>{at.x(), at.y(), at.z()}),
                          static_cast<std::uint32_t>(triangle - triangles_.cbegin()),
                          CGAL::squared_distance(p, at)};
        };
        if (threads_ == 1)
            for (std::size_t i = 0; i < scene_.points.size(); ++i)
                answer(i);
        else
            arena_.execute(
                [&] { tbb::parallel_for(std::size_t{0}, scene_.points.size(), answer); });
    }

  private:
    const Scene& scene_;
    unsigned threads_;
    tbb::task_arena arena_;
    QueryOrder order_;
    Triangles triangles_;
    Tree tree_;
};

} // namespace

std::vector<ContenderEntry> cgal_points() {
    std::vector<ContenderEntry> all;
    for (const Asked asked : {Asked::as_given, Asked::along_a_curve}) {
        ContenderEntry& e = all.emplace_back();
        e.name = fmt::format("cgal.aabb_tree.closest_point{}", name_of(asked));
        e.library = "cgal";
        e.summary = "CGAL's AABB_tree: the closest point and primitive";
        e.notes = fmt::format(
            "Simple_cartesian<double>; build = insert, build and accelerate_distance_queries (a "
            "search tree of the corners that gives the first bound); {}",
            words_for(asked));
        e.precision = "f64";
        e.runs_on = RunsOn::tbb;
        e.classes = classes_of(asked);
        e.answers = {answering<ClosestPoint>("closest_points", asked)};
    }
    return all;
}

} // namespace boxwood::bench
