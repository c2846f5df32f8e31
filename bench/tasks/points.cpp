#include "bench/tasks/points.h"

#include "bench/tasks/ours.h"
#include "bench/tasks/tree_contender.h"

namespace boxwood::bench {
namespace {

class PointQueries final : public TreeContender {
  public:
    using TreeContender::TreeContender;

    void query(Answers& answers) override { run(answers, *executor_, nullptr); }
    std::optional<Work> counted_query(Answers& answers) override {
        Work work;
        run(answers, serial(), &work);
        return work;
    }

  private:
    void run(Answers& answers, const Executor& executor, Work* work) {
        switch (ask_) {
        case Ask::points:
            return layout_->points(scene_.points, executor, pairs_.to(answers.pairs), work);
        case Ask::regions:
            return scene_.spheres.empty()
                       ? layout_->regions(scene_.regions, executor, pairs_.to(answers.pairs), work)
                       : layout_->regions(scene_.spheres, executor, pairs_.to(answers.pairs), work);
        case Ask::nearest: {
            const std::size_t k = neighbours_of(scene_);
            answers.neighbours.resize(k * scene_.points.size());
            return layout_->nearest(scene_.points, k, executor, answers.neighbours, work);
        }
        default:
            answers.surface_points.resize(scene_.points.size());
            return layout_->closest_points(scene_.points, scene_.mesh, executor,
                                           answers.surface_points, work);
        }
    }

    PairsInto pairs_;
};

} // namespace

std::unique_ptr<Contender> make_point_queries(const Job& job, BuildFunction build,
                                              const LayoutEntry& layout) {
    return std::make_unique<PointQueries>(job, std::move(build), layout);
}

std::optional<std::string> no_queries(const Scene* scene, Ask ask) {
    if (!scene)
        return std::nullopt;
    if (ask == Ask::closest_points && scene->mesh.triangles.empty())
        return "the scene has no triangles";
    if (ask == Ask::regions && scene->regions.empty() && scene->spheres.empty())
        return "the scene has no regions";
    if (ask != Ask::regions && scene->points.empty())
        return "the scene has no points";
    return std::nullopt;
}

} // namespace boxwood::bench
