/// In which poses a copy of a mesh touches it.

#include "bench/tasks/detail/mesh_pair_task.h"
#include "bench/truth/mesh_pair_truth.h"

#include <xxhash.h>

namespace boxwood::bench {
namespace {

class FirstTouch final : public MeshPairContender {
  public:
    using MeshPairContender::MeshPairContender;

    void query_part(Answers& answers, std::size_t part) override {
        list_of<std::uint8_t>(answers).push_back(collide(mesh(), copy(), scene_.poses[part]));
    }

  private:
    void run(Answers& answers, Work* work) override {
        std::vector<std::uint8_t>& touches = list_of<std::uint8_t>(answers);
        touches.clear();
        for (const Pose& pose : scene_.poses)
            touches.push_back(collide(mesh(), copy(), pose, work));
    }
};

class Collide final : public MeshPairTask {
  public:
    std::string_view name() const override { return "collide"; }
    std::string title() const override { return "do two meshes touch"; }
    std::string_view summary() const override {
        return "in which poses a copy of the scene's mesh touches it, at the first pair of "
               "triangles";
    }
    std::vector<std::string_view> keys() const override {
        std::vector<std::string_view> all = MeshPairTask::keys();
        all.emplace_back("cold_caches");
        return all;
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<std::uint8_t>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        const std::vector<std::uint8_t>& touches = list_of<std::uint8_t>(answers);
        return XXH3_64bits(touches.data(), touches.size());
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_touch_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::uint64_t yes = 0;
        for (const std::uint8_t touch : list_of<std::uint8_t>(answers))
            yes += touch;
        std::vector<NamedCount> counts{{"hits", yes}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    Make make(const Choice&) const override { return mesh_pair_contender<FirstTouch>; }
    Promise promise() const override { return Promise::exact; }
};

} // namespace

const Task& collide_task() {
    static const Collide task;
    return task;
}

} // namespace boxwood::bench
