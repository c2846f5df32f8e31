/// Which triangles of a mesh and a copy of it touch.

#include "bench/tasks/detail/mesh_pair_task.h"
#include "bench/truth/mesh_pair_truth.h"

#include <xxhash.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

class AllTouches final : public MeshPairContender {
  public:
    AllTouches(const Job& job, BuildFunction build, MeshVolume volume)
        : MeshPairContender(job, std::move(build), volume),
          executor_(make_executor(job.executor, job.threads)) {}

  private:
    void run(Answers& answers, Work* work) override {
        std::vector<PosedPair>& touching = list_of<PosedPair>(answers);
        touching.clear();
        for (std::uint32_t i = 0; i < scene_.poses.size(); ++i) {
            if (executor_->threads() > 1 && !work)
                pairs_ = touching_triangles(mesh(), copy(), scene_.poses[i], *executor_);
            else
                touching_triangles(mesh(), copy(), scene_.poses[i],
                                   std::numeric_limits<std::size_t>::max(), pairs_, work);
            for (const Pair pair : pairs_)
                touching.push_back({i, pair.a, pair.b});
        }
    }

    std::unique_ptr<Executor> executor_;
    std::vector<Pair> pairs_;
};

class CollideAll final : public MeshPairTask {
  public:
    std::string_view name() const override { return "collide_all"; }
    std::string title() const override { return "triangles of two meshes that touch"; }
    std::string_view summary() const override {
        return "every pair of triangles of the scene's mesh and a copy of it that touch, pose "
               "after "
               "pose";
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<PosedPair>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<PosedPair> sorted = list_of<PosedPair>(answers);
        std::ranges::sort(sorted);
        return XXH3_64bits(sorted.data(), sorted.size() * sizeof(PosedPair));
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_touching_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"pairs", answers.size()}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    Make make(const Choice&) const override { return mesh_pair_contender<AllTouches>; }
    RunsOn runs_on() const override { return RunsOn::any_executor; }
    Promise promise() const override { return Promise::exact; }
};

} // namespace

const Task& collide_all_task() {
    static const CollideAll task;
    return task;
}

} // namespace boxwood::bench
