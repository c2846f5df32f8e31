/// For each point every box that contains it, as pairs (point, box).

#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/point_task.h"

namespace boxwood::bench {
namespace {

class Containing final : public PointPairsContender {
  public:
    using PointPairsContender::PointPairsContender;

  private:
    std::size_t n_queries() const override { return scene_.points.size(); }
    void find(std::size_t first, std::size_t n, const Executor& executor, PairSink& sink,
              Work* work) const override {
        layout_->points(std::span(scene_.points).subspan(first, n), executor, sink, work);
    }
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
        Way way = way_of<Containing>(choice, "points", "single_points", Query::points);
        if (calls_of(choice) == Calls::batch)
            way.make_on_device = on_device<ContainingOnDevice>(choice);
        return way;
    }
};

} // namespace

const Task& points_task() {
    static const Points task;
    return task;
}

} // namespace boxwood::bench
