#include "bench/stages/scene_player.h"

#include "bench/stages/playing.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace boxwood::bench {

ScenePlayer::ScenePlayer(MovingScene scene, Extent extent, const Executor& executor, Where where,
                         DevicePlace place)
    : playing_(std::make_unique<Playing>(Playing{std::move(scene), executor, extent})),
      plan_(plan_stages(playing_->scene, extent, where)), ledger_(plan_) {
    const auto runs = [&](std::string_view name) { return stage_of(plan_, name).runs; };
    const MovingScene& played = playing_->scene;
    const bool on_device = where != Where::host, resident = where == Where::resident;
    if (const auto why = why_not(played, extent, where))
        throw std::invalid_argument(fmt::format("scene {}: {}", played.file().name, *why));
    if (on_device)
        playing_->device = std::make_unique<OnDevice>(OnDevice{place});
    const bool full = extent == Extent::all_stages;
    const bool moves = full || !played.effects().empty();

    const Runs while_it_moves = moves ? Runs::from_the_start : Runs::at_the_start;

    if (resident)
        add("upload", upload_bodies_stage(), Runs::at_the_start);
    for (std::size_t i = 0; i < played.effects().size(); ++i) {
        const bool ends = !runs("move") && i + 1 == played.effects().size();
        add(std::ranges::find(plan_, played.effects()[i].entry->name, &PlannedStage::effect)->name,
            resident ? advance_there_stage(i) : advance_stage(i, ends), Runs::advancing);
    }
    if (runs("move"))
        add("move", resident ? move_there_stage() : move_stage(), Runs::advancing);
    if (runs("fit")) {
        const bool wide = runs("tree") && !played.margins().empty();
        add("fit", resident ? fit_there_stage() : fit_stage(runs("box_tree") || !wide, wide),
            while_it_moves);
    }
    if (on_device && !resident)
        add("upload", upload_boxes_stage(), while_it_moves);
    if (runs("tree"))
        add("tree", on_device ? tree_there_stage() : tree_stage(), Runs::at_the_start);
    if (runs("update"))
        add("update", on_device ? update_there_stage() : update_stage(), Runs::advancing);
    if (runs("box_tree"))
        add("box_tree", box_tree_stage(), while_it_moves);

    if (runs("pairs"))
        add("pairs", on_device ? pairs_there_stage() : query_stage("pairs"), Runs::querying);
    if (on_device)
        add("download", download_stage(), Runs::querying);
    if (runs("filter"))
        add("filter", filter_stage(), Runs::querying);
    if (runs("transform")) {
        add("transform", transform_stage(), Runs::querying);
        if (moves)
            noting_.push_back(stages_.size() - 1);
    }
    if (runs("mesh_trees"))
        add("mesh_trees", mesh_trees_stage(), Runs::querying);
    if (runs("triangle_pairs"))
        add("triangle_pairs", query_stage("triangle_pairs"), Runs::querying);
    if (runs("surface")) {
        add("surface", surface_stage(), Runs::querying);
        if (moves)
            noting_.push_back(stages_.size() - 1);
    }
    if (runs("aim"))
        add("aim", aim_stage(), Runs::querying);
    for (const SceneQueryEntry& query : scene_queries())
        if (query.probes != Probes::none && runs(query.name))
            add(query.name, query_stage(query.name), Runs::querying);
}

ScenePlayer::~ScenePlayer() = default;

void ScenePlayer::add(std::string_view name, std::unique_ptr<SceneStage> stage, Runs when) {
    Made made{ledger_.index_of(name), std::move(stage)};
    const auto at = stages_.size();
    if (when == Runs::at_the_start || when == Runs::from_the_start)
        starting_.push_back(at);
    if (when == Runs::advancing || when == Runs::from_the_start)
        advancing_.push_back(at);
    if (when == Runs::querying)
        querying_.push_back(at);
    stages_.push_back(std::move(made));
}

template <class Run> void ScenePlayer::timed(Made& made, std::size_t calls, const Run& run) {
    const auto before = std::chrono::steady_clock::now();
    const std::size_t items = run(*made.stage);
    const auto after = std::chrono::steady_clock::now();
    ledger_.add(made.row, calls, items,
                std::chrono::duration<double, std::nano>(after - before).count());
}

void ScenePlayer::start() {
    if (playing_->scene.frame() > 0)
        playing_->scene.rewind();
    playing_->changed = {};
    playing_->last_change = 0;
    ledger_.clear();
    for (std::size_t i = 0; i < stages_.size(); ++i)
        if (std::ranges::find(starting_, i) != starting_.end())
            timed(stages_[i], 1, [&](SceneStage& stage) { return stage.start(*playing_); });
        else
            stages_[i].stage->start(*playing_);
}

void ScenePlayer::advance() {
    playing_->scene.begin_frame();
    for (const std::size_t i : advancing_)
        timed(stages_[i], 1, [&](SceneStage& stage) { return stage.run(*playing_); });
    for (const std::size_t i : noting_)
        timed(stages_[i], 0, [&](SceneStage& stage) {
            stage.note_changes(*playing_);
            return std::size_t{0};
        });
}

const FrameAnswers& ScenePlayer::query() {
    for (const std::size_t i : querying_)
        timed(stages_[i], 1, [&](SceneStage& stage) { return stage.run(*playing_); });
    return playing_->answers;
}

const FrameAnswers& ScenePlayer::answers() const { return playing_->answers; }

const MovingScene& ScenePlayer::scene() const { return playing_->scene; }

const Ledger& ScenePlayer::ledger() {
    for (const LedgerRow& row : ledger_.rows()) {
        std::size_t bytes = 0;
        for (const Made& made : stages_)
            if (&ledger_.rows()[made.row] == &row)
                bytes += made.stage->bytes(*playing_);
        ledger_.set_bytes(static_cast<std::size_t>(&row - ledger_.rows().data()), bytes);
    }
    return ledger_;
}

} // namespace boxwood::bench
