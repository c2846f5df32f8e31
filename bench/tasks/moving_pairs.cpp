/// Frame after frame of a moving scene: take the new boxes, then every overlapping pair. Ours are
/// the update policies.

#include "bench/tasks/moving_pairs.h"
#include "bench/tasks/detail/bench_place.h"

#include "bench/plan/scenes.h"
#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/tree_contender.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/moving_truth.h"
#include "bench/truth/truth.h"
#include "kernels/suggest.h"
#include "scenes/moving/frames.h"
#include "trees/device.h"
#include "trees/dynamic/update.h"

#include <fmt/format.h>

namespace boxwood::bench {
namespace {

class Follower final : public Contender {
  public:
    Follower(const Job& job, const UpdateEntry& policy, const Settings& settings)
        : scene_(*job.scene), executor_(make_executor(job.executor, job.threads)),
          updater_(policy.make(settings)), may_cache_(policy.may_cache_pairs) {}

    void build() override {
        updater_->start(scene_.boxes, *executor_);
        placed_ = rebuilds_ = from_cache_ = 0;
    }
    void update(const Frame& frame) override {
        updater_->update(frame.boxes, frame.moved, *executor_);
        const UpdateStep step = updater_->last_step();
        placed_ += step.placed;
        rebuilds_ += step.rebuilt;
        from_cache_ += step.answers_from_cache;
    }
    void query(Answers& answers) override { updater_->self_pairs(*executor_, pairs_.to(answers)); }
    std::optional<Work> counted_query(Answers& answers) override {
        return updater_->self_pairs_counted(pairs_.to(answers));
    }
    std::vector<NamedCount> more_counts() const override {
        return {
            {"items_placed", placed_}, {"rebuilds", rebuilds_}, {"frames_from_cache", from_cache_}};
    }
    std::optional<std::vector<std::string>> classes() const override {
        if (!may_cache_)
            return std::nullopt;
        return from_cache_ > 0 ? std::vector{cached_pairs_class} : std::vector<std::string>{};
    }
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{updater_->bytes(), nullptr, updater_->sah()};
    }

  private:
    const Scene& scene_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<Updater> updater_;
    PairsInto pairs_;
    bool may_cache_;                                           ///< pairs, and answer with them
    std::uint64_t placed_ = 0, rebuilds_ = 0, from_cache_ = 0; ///< in all frames since the build
};

/// The boxes of a frame come from the host, and its pairs go there.
class FollowerOnDevice final : public Contender {
  public:
    FollowerOnDevice(const Job& job, bool rebuilds) : scene_(*job.scene), rebuilds_(rebuilds) {}

    void build() override {
        if (bvh_)
            bvh_->rebuild(scene_.boxes);
        else
            bvh_.emplace(scene_.boxes, DeviceBvhOptions{.place = bench_place()});
    }
    void update(const Frame& frame) override {
        if (rebuilds_)
            bvh_->rebuild(frame.boxes);
        else
            bvh_->update(frame.boxes);
        wait_for(bench_place()); // what is enqueued is no part of the query
    }
    void query(Answers& answers) override {
        bvh_->self_pairs_on_device().read(list_of<Pair>(answers));
    }

  private:
    const Scene& scene_;
    bool rebuilds_;
    std::optional<DeviceBvh> bvh_;
};

/// Of refit, and of rebuild in every frame.
Answering::Make on_device(const BuilderChoice& policy) {
    const auto& settings = policy.settings;
    const bool rebuilds = policy.name == "rebuild" && settings.size() == 1 &&
                          settings.contains("trigger") && to_text(settings.at("trigger")) == "0";
    if (!rebuilds && (policy.name != "refit" || !settings.empty()))
        return nullptr;
    return [rebuilds](const Job& job) { return std::make_unique<FollowerOnDevice>(job, rebuilds); };
}

class FramesTruth final : public Truth {
  public:
    explicit FramesTruth(unsigned threads) : truth_(threads) {}

    void note_frame(std::size_t index, const Frame& frame, const Answers& answers,
                    const ContenderEntry&) override {
        if (index == 0)
            judgement_ = {};
        if (!truth_.check(index, frame, list_of<Pair>(answers), judgement_.check))
            judgement_.status = Status::wrong;
    }
    Judgement judge(const Answers&, const ContenderEntry&) override { return judgement_; }

  private:
    MovingTruth truth_;
    Judgement judgement_; ///< of the frames since frame 0
};

class MovingPairs final : public PairAnswers<Task> {
  public:
    std::string_view name() const override { return "moving_pairs"; }
    std::string title() const override { return "moving boxes"; }
    std::string_view summary() const override {
        return "frame after frame: the new boxes taken, then every overlapping pair";
    }
    std::vector<std::string_view> keys() const override {
        return {"scene",   "n",         "overlaps", "effects", "frames",
                "updates", "executors", "threads",  "peers"};
    }
    SceneKind scenes() const override { return SceneKind::moving; }
    Phases phases() const override { return Phases::frames; }
    std::unique_ptr<Truth> make_truth(const Scene&, unsigned threads) const override {
        return std::make_unique<FramesTruth>(threads);
    }

    void expand(const BlockReader& block, AddCell add) const override {
        const std::vector<BuilderChoice> policies =
            block.choices("updates", "an update", names_of(updates()),
                          [](const std::string& policy, const Settings& settings) {
                              find_update(policy).make(settings);
                          });
        if (policies.empty() && !block.has("peers"))
            block.fail("[[cells]] needs updates, peers, or both");
        std::vector<ContenderEntry> ours;
        for (const BuilderChoice& policy : policies)
            ours.push_back(moving_contender(policy));
        const std::vector<ContenderEntry> peers = block.peers(name());
        for (const SceneSpec& scene : moving_scenes(block))
            add_cells(block, scene, ours, peers, add);
    }
};

} // namespace

ContenderEntry moving_contender(const BuilderChoice& policy) {
    const UpdateEntry& update = entry_named(policy.name, updates(), "update policy");
    update.make(policy.settings); // throws for a bad setting

    ContenderEntry entry;
    entry.library = "boxwood";
    entry.is_peer = false;
    entry.precision = "f32";
    entry.builder = name_with_settings(policy.name, policy.settings);
    entry.place = static_cast<std::size_t>(&update - updates().data());
    entry.answers_from_cache = update.answers_from_cache;
    if (update.may_cache_pairs)
        entry.classes = {cached_pairs_class};
    entry.is_plain = policy.settings.empty();
    entry.layout = "packed";
    entry.traversal = "self_pairs";
    entry.name = fmt::format("{}.{}.{}", entry.builder, entry.layout, entry.traversal);
    entry.summary = update.summary;
    entry.notes = "update: the frame's boxes and the list of those that moved; answers in the same "
                  "order for any number of threads";
    entry.params_json = settings_json(policy.settings);
    entry.cannot = [](const Job& job) -> std::optional<std::string> {
        if (is_device(job.executor) && job.executor != device_executor)
            return "has no form for a device where frames come from the host";
        return std::nullopt;
    };
    entry.answers = {{"moving_pairs",
                      [&update, settings = policy.settings](const Job& job) {
                          return std::make_unique<Follower>(job, update, settings);
                      },
                      on_device(policy)}};
    return entry;
}

const Task& moving_pairs_task() {
    static const MovingPairs task;
    return task;
}

} // namespace boxwood::bench
