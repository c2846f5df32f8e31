/// When a copy of a mesh that moves from pose to pose first touches it.

#include "trees/world/continuous.h"
#include "bench/plan/block_reader.h"
#include "bench/tasks/detail/mesh_pair_task.h"
#include "bench/truth/first_meeting_truth.h"
#include "kernels/suggest.h"
#include "scenes/sampling/poses.h"

#include <xxhash.h>

#include <bit>

namespace boxwood::bench {
namespace {

Meets meets(Answer hit) {
    return hit == Answer::yes ? Meets::yes : hit == Answer::no ? Meets::no : Meets::left_open;
}

class FirstMeetings final : public MeshPairContender {
  public:
    using MeshPairContender::MeshPairContender;

  private:
    void run(Answers& answers, Work* work) override {
        std::vector<FirstMeeting>& meetings = list_of<FirstMeeting>(answers);
        meetings.clear();
        const MotionPath path =
            scene_.spec.motion == "screw" ? MotionPath::screw : MotionPath::linear;
        for (std::size_t i = 0; i < scene_.poses.size(); ++i) {
            const Motion motion(scene_.poses[i], scene_.poses[next_pose(i, scene_.poses.size())],
                                path);
            const FirstContact c = first_contact(mesh(), Motion{}, copy(), motion, options_, work);
            meetings.push_back({c.t_free, c.t_hit, meets(c.hit)});
        }
    }

    ContinuousOptions options_{.tolerance = meeting_tolerance(scene_.mesh)};
};

class Continuous final : public MeshPairTask {
  public:
    std::string_view name() const override { return "continuous"; }
    std::string title() const override { return "first contact of moving meshes"; }
    std::string_view summary() const override {
        return "when a copy of the scene's mesh, on its way from each pose to the next, first "
               "touches it, if it does";
    }
    std::vector<std::string_view> keys() const override {
        std::vector<std::string_view> all = MeshPairTask::keys();
        all.push_back("motions");
        return all;
    }
    std::optional<std::string> missing(const Scene& scene) const override {
        if (scene.poses.size() < 2)
            return "the scene has no two poses to move between";
        return std::nullopt;
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<FirstMeeting>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint64_t> words;
        for (const FirstMeeting& m : list_of<FirstMeeting>(answers)) {
            words.push_back(std::bit_cast<std::uint64_t>(m.t_free));
            words.push_back(std::bit_cast<std::uint64_t>(m.t_hit));
            words.push_back(static_cast<std::uint64_t>(m.meets));
        }
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_first_meeting_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::uint64_t yes = 0;
        for (const FirstMeeting& m : list_of<FirstMeeting>(answers))
            yes += m.meets == Meets::yes;
        std::vector<NamedCount> counts{{"hits", yes}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    Make make(const Choice&) const override { return mesh_pair_contender<FirstMeetings>; }
    Promise promise() const override { return Promise::certified; }
    std::vector<std::string> usual_poses() const override { return {"apart", "near"}; }
    std::vector<SceneSpec> posed_scenes(const BlockReader& block) const override {
        std::vector<SceneSpec> scenes;
        for (const SceneSpec& scene : MeshPairTask::posed_scenes(block)) {
            if (scene.n_poses < 2)
                block.fail("motions are from pose to pose: n_poses must be at least 2", "n_poses");
            for (const std::string& path :
                 block.names("motions", names_of(motion_paths()), {"linear", "screw"})) {
                scenes.push_back(scene);
                scenes.back().motion = path;
            }
        }
        return scenes;
    }
    std::string_view query_notes() const override {
        return "motion after motion, each made from its two poses in the query, by conservative "
               "advancement until nearer than 1e-5 of the mesh's diagonal";
    }
};

} // namespace

const Task& continuous_task() {
    static const Continuous task;
    return task;
}

} // namespace boxwood::bench
