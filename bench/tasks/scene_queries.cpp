/// Frame after frame of a moving scene: all that its file queries, by a plan of stages.

#include "bench/io/scene_strip.h"
#include "bench/plan/scenes.h"
#include "bench/stages/stages_contender.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/moving_truth.h"
#include "bench/truth/truth.h"
#include "kernels/suggest.h"
#include "scenes/effects/effect.h"
#include "scenes/moving/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace boxwood::bench {
namespace {

/// The names of all effects of a scene, each once.
std::vector<std::string> effects_of(const SceneFile& scene) {
    std::vector<std::string> names;
    for (const BodyGroup& group : scene.groups)
        for (const EffectChoice& effect : group.effects)
            if (std::ranges::find(names, effect.name) == names.end())
                names.push_back(effect.name);
    return names;
}

SceneFile without(SceneFile scene, std::string_view effect) {
    for (BodyGroup& group : scene.groups)
        std::erase_if(group.effects,
                      [&](const EffectChoice& choice) { return choice.name == effect; });
    return scene;
}

/// Holds the contenders of one scene together: the pairs of each frame against the oracle of
/// MovingTruth, less those that the scene leaves out, and all answers against those of the first
/// contender that played the same scene.
class SceneTruth final : public Truth {
  public:
    SceneTruth(std::shared_ptr<const SceneFile> file, unsigned threads)
        : file_(std::move(file)), threads_(threads) {}

    void note_frame(std::size_t index, const Frame&, const Answers& answers,
                    const ContenderEntry& contender) override {
        Played& played = played_by(contender.stages);
        const FrameAnswers& got = *dynamic_cast<const StageAnswers&>(answers).frame;
        if (index == 0) {
            judgement_ = {};
            judgement_.check.oracle = "first_contender";
            played.frames->rewind();
        }
        if (played.pairs &&
            !played.pairs->check(index, *played.frames->next(), got.pairs, judgement_.check))
            judgement_.status = Status::wrong;
        const std::uint64_t all = answers_hash(got);
        if (index == played.first_hashes.size())
            played.first_hashes.push_back(all);
        if (played.first_hashes[index] == all)
            return;
        judgement_.status = Status::wrong;
        if (judgement_.check.witness.empty())
            judgement_.check.witness =
                fmt::format("frame {}: other answers than the first contender of the scene", index);
    }
    Judgement judge(const Answers&, const ContenderEntry&) override { return judgement_; }

  private:
    /// Of the scene as it is, or without one of its effects.
    struct Played {
        std::unique_ptr<Frames> frames;
        std::unique_ptr<MovingTruth> pairs;      ///< if the scene queries them
        std::vector<std::uint64_t> first_hashes; ///< by frame
    };
    Played& played_by(const std::string& stages) {
        const bool is_whole = stages == results::required_stages || stages == results::all_stages;
        const std::string effect = is_whole ? std::string() : stages;
        const auto [at, is_new] = played_.try_emplace(effect);
        Played& played = at->second;
        if (!is_new)
            return played;
        const auto file = std::make_shared<const SceneFile>(without(*file_, effect));
        played.frames = std::make_unique<Frames>(file);
        played.first_hashes.reserve(file->frames);
        if (!query_named(*file, "pairs"))
            return played;
        std::function<bool(Pair)> is_left_out;
        const auto scene = std::make_shared<const MovingScene>(*file);
        if (!scene->ignored().empty())
            is_left_out = [scene](Pair p) { return scene->is_ignored(p.a, p.b); };
        played.pairs = std::make_unique<MovingTruth>(threads_, std::move(is_left_out));
        return played;
    }

    std::shared_ptr<const SceneFile> file_;
    unsigned threads_;
    std::map<std::string, Played> played_; ///< by the effect that is left out
    Judgement judgement_;                  ///< of the frames since frame 0
};

class SceneQueries final : public Task {
  public:
    std::string_view name() const override { return "scene_queries"; }
    std::string title() const override { return "a whole scene"; }
    std::string_view summary() const override {
        return "frame after frame of a moving scene: all that its file queries";
    }
    std::vector<std::string_view> keys() const override {
        return {"scene",  "n",       "overlaps",  "effects", "frames",
                "stages", "without", "executors", "threads"};
    }
    SceneKind scenes() const override { return SceneKind::moving; }
    Phases phases() const override { return Phases::frames; }
    bool plays_own_frames() const override { return true; }
    std::optional<std::string> missing(const Scene& scene) const override {
        return scene.spec.moving ? std::nullopt : std::optional("plays moving scenes only");
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<StageAnswers>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        return answers_hash(*dynamic_cast<const StageAnswers&>(answers).frame);
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return std::make_unique<SceneTruth>(scene.spec.moving, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work*) const override {
        return {{"pairs", answers.size()}};
    }
    std::map<std::string, std::string> texts(const Scene& scene) const override {
        return {{"strip_" + scene.name, scene_strip(*scene.spec.moving)}};
    }

    void expand(const BlockReader& block, AddCell add) const override {
        const std::vector<std::string> stages =
            block.names("stages", {required_variant, all_stages_variant});
        BlockReader::Names known = names_of(effects());
        known.insert(known.begin(), "each");
        const std::vector<std::string> left_out = block.names("without", known);
        if (stages.empty() && left_out.empty())
            block.fail("scene_queries needs stages: required, all_stages, or both");
        for (const SceneSpec& scene : moving_scenes(block)) {
            if (scene.moving->recording)
                block.fail(
                    "a recorded motion holds boxes and no effects: its task is moving_pairs");
            std::vector<ContenderEntry> ours;
            for (const std::string& extent : stages)
                ours.push_back(stages_contender(extent == all_stages_variant ? Extent::all_stages
                                                                             : Extent::required));
            for (const std::string& name : left_out)
                for (const std::string& effect :
                     name == "each" ? effects_of(*scene.moving) : std::vector<std::string>{name})
                    ours.push_back(stages_contender(Extent::required, effect));
            add_cells(block, scene, ours, {}, add);
        }
    }
};

} // namespace

const Task& scene_queries_task() {
    static const SceneQueries task;
    return task;
}

} // namespace boxwood::bench
