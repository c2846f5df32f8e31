/// For each point every box that contains it, as pairs (point, box).

#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/point_task.h"

namespace boxwood::bench {
namespace {

class Containing final : public PointContender {
  public:
    using PointContender::PointContender;

  private:
    void run(Answers& answers, const Executor& executor, Work* work) override {
        layout_->points(scene_.points, executor, pairs_.to(answers), work);
    }
    PairsInto pairs_;
};

class ContainingOnDevice final : public ItemsOfQueries {
  public:
    using ItemsOfQueries::ItemsOfQueries;

  protected:
    std::uint64_t upload_queries() override {
        points_ = DeviceArray<Vec3<float>>(scene_.points, options_.place);
        return points_.size_bytes();
    }
    void query_there() override { found_ = bvh_->containing(std::as_const(points_).span()); }

  private:
    DeviceArray<Vec3<float>> points_;
};

class Points final : public PairAnswers<PointTask> {
  public:
    Points() : PairAnswers(PointQuery::containing) {}
    std::string_view name() const override { return "points"; }
    std::string title() const override { return "boxes at a point"; }
    std::string_view summary() const override {
        return "for each point every box that contains it";
    }

  protected:
    Way way(const Choice& choice) const override {
        return {.traversal = "points",
                .make = maker<Containing>(),
                .query = Query::points,
                .make_on_device = on_device<ContainingOnDevice>(choice)};
    }
};

} // namespace

const Task& points_task() {
    static const Points task;
    return task;
}

} // namespace boxwood::bench
