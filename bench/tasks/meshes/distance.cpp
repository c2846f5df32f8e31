/// How far a mesh and a copy of it are apart.

#include "bench/tasks/detail/mesh_pair_task.h"
#include "bench/truth/mesh_pair_truth.h"

#include <xxhash.h>

#include <bit>

namespace boxwood::bench {
namespace {

template <bool is_warm> class LeastDistance final : public MeshPairContender {
  public:
    using MeshPairContender::MeshPairContender;

  private:
    void run(Answers& answers, Work* work) override {
        std::vector<PosedDistance>& distances = list_of<PosedDistance>(answers);
        distances.clear();
        DistanceOptions options;
        for (const Pose& pose : scene_.poses) {
            const MeshDistance d = distance(*tree_, *tree_, pose, options, work);
            distances.push_back({d.distance, d.lo, d.hi, d.triangles});
            if (is_warm && d.found())
                options.start = d.triangles;
        }
    }
};

class DistanceOfMeshes final : public MeshPairTask {
  public:
    std::string_view name() const override { return "distance"; }
    std::string title() const override { return "distance of two meshes"; }
    std::string_view summary() const override {
        return "how far the scene's mesh and a copy of it are apart, pose after pose";
    }
    std::vector<std::string_view> keys() const override {
        std::vector<std::string_view> all = MeshPairTask::keys();
        all.push_back("starts");
        return all;
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<PosedDistance>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint64_t> words;
        for (const PosedDistance& d : list_of<PosedDistance>(answers))
            words.push_back(std::bit_cast<std::uint64_t>(d.distance));
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_mesh_distance_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"answers", answers.size()}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    std::vector<bool> warm_starts(const BlockReader& block) const override {
        std::vector<bool> starts;
        for (const std::string& start : block.names("starts", {"cold", "warm"}, {"cold"}))
            starts.push_back(start == "warm");
        return starts;
    }
    Make make(const Choice& choice) const override {
        return choice.warm_start ? mesh_pair_contender<LeastDistance<true>>
                                 : mesh_pair_contender<LeastDistance<false>>;
    }
    Promise promise() const override { return Promise::certified; }
};

} // namespace

const Task& distance_task() {
    static const DistanceOfMeshes task;
    return task;
}

} // namespace boxwood::bench
