#include "bench/stages/stages_contender.h"

#include "bench/stages/scene_player.h"
#include "bench/tasks/detail/bench_place.h"
#include "trees/executor.h"

#include "results/words.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

bool has_effect(const SceneFile& file, std::string_view name) {
    return std::ranges::any_of(file.groups, [&](const BodyGroup& group) {
        return std::ranges::find(group.effects, name, &EffectChoice::name) != group.effects.end();
    });
}

/// As the job names it, less one effect.
SceneFile file_of(const Job& job, std::string_view without) {
    SceneFile file = *job.scene->spec.moving;
    file.n = job.scene->spec.n;
    file.seed = job.scene->spec.seed;
    for (BodyGroup& group : file.groups)
        std::erase_if(group.effects,
                      [&](const EffectChoice& effect) { return effect.name == without; });
    return file;
}

Where where_of(std::string_view executor) {
    return executor == device_executor     ? Where::device
           : executor == resident_executor ? Where::resident
                                           : Where::host;
}

class Played final : public Contender {
  public:
    Played(const Job& job, Extent extent, std::string_view without)
        : executor_(make_executor(
              is_device(job.executor) ? default_executor(job.threads) : job.executor, job.threads)),
          player_(MovingScene(file_of(job, without), {}, true), extent, *executor_,
                  where_of(job.executor), bench_place()) {}

    void build() override { player_.start(); }
    void update(const Frame&) override { player_.advance(); }
    void query(Answers& answers) override {
        dynamic_cast<StageAnswers&>(answers).frame = &player_.query();
    }
    std::optional<StructureInfo> structure() const override {
        StructureInfo info;
        for (const LedgerRow& row : player_.ledger().rows())
            info.bytes += row.is_crossing() ? 0 : row.bytes;
        return info;
    }
    const Ledger* ledger() override { return &player_.ledger(); }

  private:
    std::unique_ptr<Executor> executor_;
    mutable ScenePlayer player_;
};

} // namespace

ContenderEntry stages_contender(Extent extent, std::string_view left_out) {
    ContenderEntry entry;
    entry.place = extent == Extent::all_stages ? 1 : 0;
    if (!left_out.empty()) // throws for an unknown one
        entry.place = 2 + static_cast<std::size_t>(&effect_of(left_out) - effects().data());
    entry.library = "boxwood";
    entry.is_peer = false;
    entry.precision = "f32";
    entry.layout = "packed";
    entry.name = extent == Extent::all_stages ? all_stages_variant : required_variant;
    entry.summary = extent == Extent::all_stages
                        ? "every stage, for every body in every frame"
                        : "the stages that the scene requires, for the bodies that it requires";
    entry.stages = extent == Extent::all_stages ? results::all_stages : results::required_stages;
    if (!left_out.empty()) {
        entry.stages = left_out;
        entry.name += fmt::format(".without_{}", left_out);
        entry.summary += fmt::format("; the scene without {}", left_out);
    }
    entry.notes =
        "build makes what frame 0 needs; update advances the scene itself, so that the "
        "cost of its effects is in it; on a device pairs come down in each frame, also where "
        "bodies stay";
    entry.cannot = [extent,
                    without = std::string(left_out)](const Job& job) -> std::optional<std::string> {
        if (!without.empty() && !has_effect(*job.scene->spec.moving, without))
            return fmt::format("the scene has no {}", without);
        if (is_device(job.executor))
            return why_not(MovingScene(file_of(job, without)), extent, where_of(job.executor));
        return std::nullopt;
    };
    const auto make = [extent, without = std::string(left_out)](const Job& job) {
        return std::make_unique<Played>(job, extent, without);
    };
    entry.answers = {{"scene_queries", make, make}};
    return entry;
}

} // namespace boxwood::bench
