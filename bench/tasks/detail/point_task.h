#pragma once

#include "bench/tasks/detail/tree_contender.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/point_truth.h"

namespace boxwood::bench {

/// One tree that answers queries of many points or regions. `run` answers; work, if given, is
/// counted, on the executor serial().
class PointContender : public TreeContender {
  public:
    using TreeContender::TreeContender;
    void query(Answers& answers) override { run(answers, *executor_, nullptr); }
    std::optional<Work> counted_query(Answers& answers) override {
        Work work;
        run(answers, serial(), &work);
        return work;
    }

  protected:
    virtual void run(Answers& answers, const Executor& executor, Work* work) = 0;
};

/// A task about the points of a scene, or its regions, with the key n_points.
class PointTask : public TreeTask {
  public:
    explicit PointTask(PointQuery query) : query_(query) {}

    std::vector<std::string_view> keys() const override;
    std::optional<std::string> missing(const Scene& scene) const override;
    std::uint64_t n_queries(const Scene& scene) const override;
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_point_truth(scene, query_, threads);
    }

  protected:
    std::vector<SceneSpec> with_queries(const BlockReader& block,
                                        const SceneSpec& scene) const override;

  private:
    PointQuery query_;
};

} // namespace boxwood::bench
