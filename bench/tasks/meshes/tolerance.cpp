/// In which poses a copy of a mesh is nearer to it than a tolerance, which about half of them are.

#include "bench/tasks/detail/median_distance.h"
#include "bench/tasks/detail/mesh_pair_task.h"
#include "bench/truth/mesh_pair_truth.h"

#include <xxhash.h>

namespace boxwood::bench {
namespace {

class Nearer final : public MeshPairContender {
  public:
    using MeshPairContender::MeshPairContender;

  private:
    void run(Answers& answers, Work* work) override {
        std::vector<std::uint8_t>& nearer = list_of<std::uint8_t>(answers);
        nearer.clear();
        for (const Pose& pose : scene_.poses)
            nearer.push_back(within(mesh(), copy(), pose, tolerance_, work).within);
    }

    double tolerance_ = median_distance(scene_);
};

class Tolerance final : public MeshPairTask {
  public:
    std::string_view name() const override { return "tolerance"; }
    std::string title() const override { return "are two meshes near"; }
    std::string_view summary() const override {
        return "in which poses a copy of the scene's mesh is at most a tolerance away, which about "
               "half of the poses are";
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<std::uint8_t>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        const std::vector<std::uint8_t>& nearer = list_of<std::uint8_t>(answers);
        return XXH3_64bits(nearer.data(), nearer.size());
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_within_truth(scene, median_distance(scene), threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::uint64_t yes = 0;
        for (const std::uint8_t near : list_of<std::uint8_t>(answers))
            yes += near;
        std::vector<NamedCount> counts{{"hits", yes}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    Make make(const Choice&) const override { return mesh_pair_contender<Nearer>; }
    Promise promise() const override { return Promise::certified; }
    std::vector<std::string> usual_poses() const override { return {"apart", "near"}; }
    std::string_view query_notes() const override {
        return "pose after pose, until it is certain on which side of the tolerance the least "
               "distance is";
    }
};

} // namespace

const Task& tolerance_task() {
    static const Tolerance task;
    return task;
}

} // namespace boxwood::bench
