#include "bench/tasks/scene_queries.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

constexpr std::string_view without_prefix = "required.without_";

/// The words of all effects of a scene, each once.
std::vector<std::string> effects_of(const SceneFile& scene) {
    std::vector<std::string> words;
    for (const BodyGroup& group : scene.groups)
        for (const EffectChoice& effect : group.effects)
            if (std::ranges::find(words, effect.name) == words.end())
                words.push_back(effect.name);
    return words;
}

SceneFile without(SceneFile scene, std::string_view effect) {
    for (BodyGroup& group : scene.groups)
        std::erase_if(group.effects,
                      [&](const EffectChoice& choice) { return choice.name == effect; });
    return scene;
}

} // namespace

std::vector<ContenderEntry> scene_contenders(std::span<const std::string> stages,
                                             std::span<const std::string> without_effects,
                                             const SceneFile& scene) {
    std::vector<ContenderEntry> all;
    for (const std::string& word : stages)
        all.push_back(
            stages_contender(word == "all_stages" ? Extent::all_stages : Extent::required));
    for (const std::string& word : without_effects)
        for (const std::string& effect :
             word == "each" ? effects_of(scene) : std::vector<std::string>{word})
            all.push_back(stages_contender(Extent::required, effect));
    return all;
}

void play_scene(StagesContender& contender, std::size_t n_frames, std::span<FrameTime> times,
                FunctionRef<void(std::size_t index, const FrameAnswers& answers)> after_frame) {
    const Frame none; // the contender plays its own
    Answers answers;
    for (std::size_t index = 0; index < n_frames; ++index) {
        play_frame(contender, none, answers, times[index]);
        times[index].pairs = contender.frame_answers().pairs.size();
        after_frame(index, contender.frame_answers());
    }
}

SceneTruth::Played& SceneTruth::played_by(const std::string& contender_name) {
    const std::string effect = contender_name.starts_with(without_prefix)
                                   ? contender_name.substr(without_prefix.size())
                                   : std::string();
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
    played.pairs = std::make_unique<MovingTruth>(*played.frames, threads_, std::move(is_left_out));
    return played;
}

std::uint64_t SceneTruth::check(StagesContender& contender, const std::string& contender_name,
                                std::span<FrameTime> times, results::Check& check) {
    Played& played = played_by(contender_name);
    check.status = "exact";
    check.oracle = "first_contender";
    played.frames->rewind();
    FramesHash hash;
    Answers answers;
    play_scene(contender, played.frames->size(), times,
               [&](std::size_t index, const FrameAnswers& got) {
                   if (played.pairs) {
                       answers.pairs.assign(got.pairs.begin(), got.pairs.end());
                       played.pairs->check(index, *played.frames->next(), answers, check);
                   }
                   const std::uint64_t all = answers_hash(got);
                   hash.add(all);
                   if (index == played.first_hashes.size())
                       played.first_hashes.push_back(all);
                   if (played.first_hashes[index] == all)
                       return;
                   check.status = "wrong";
                   if (check.witness.empty())
                       check.witness = fmt::format(
                           "frame {}: other answers than the first contender of the scene", index);
               });
    return hash.value();
}

void add_ledger(std::vector<results::EffectRow>& rows, const Ledger& ledger) {
    if (rows.empty())
        for (const LedgerRow& stage : ledger.rows()) {
            results::EffectRow& row = rows.emplace_back();
            row.stage = stage.stage;
            row.required = stage.is_required;
            row.calls = stage.calls;
            row.items = stage.items;
            row.total_ns = 0;
        }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].total_ns += ledger.rows()[i].ns;
        rows[i].bytes = std::max(rows[i].bytes, ledger.rows()[i].bytes);
    }
}

} // namespace boxwood::bench
