#include "bench/tasks/detail/kernel_task.h"

#include "bench/plan/scenes.h"
#include "kernels/suggest.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace boxwood::bench {

KernelTask::KernelTask(std::string_view name, std::string_view summary,
                       std::vector<CaseKernel> kernels, MakeTruth of_scene)
    : name_(name), summary_(summary), kernels_(std::move(kernels)), make_truth_(of_scene) {
    for (const CaseKernel& kernel : kernels_)
        infos_.push_back(kernel.info);
}

std::vector<std::string_view> KernelTask::keys() const {
    return {"scene", "n", "k", "scale", "kernels", "executors", "peers"};
}

void KernelTask::expand(const BlockReader& block, AddCell add) const {
    std::vector<ContenderEntry> contenders;
    for (const std::string& kernel : block.kernels(names_of(kernels()), {"all"}))
        contenders.push_back(kernel_contender(kernel));
    const std::vector<ContenderEntry> peers = block.peers(name());
    const Place usual{std::string(default_executor(1)), 1};
    const std::vector<Place> places =
        block.has("executors") ? block.places() : std::vector<Place>{usual};
    for (const SceneSpec& scene : case_scenes(block, *this)) {
        for (const Place& place : places)
            for (const ContenderEntry& entry : contenders)
                add(scene, entry, place.executor, place.threads);
        for (const ContenderEntry& peer : peers)
            add(scene, peer, usual.executor, usual.threads);
    }
}

ContenderEntry KernelTask::kernel_contender(std::string_view kernel) const {
    const auto found =
        std::ranges::find(kernels_, kernel, [](const CaseKernel& k) { return k.info.name; });
    if (found == kernels_.end())
        throw std::invalid_argument(
            unknown_name(std::string(name()) + " kernel", kernel, names_of(kernels())));
    ContenderEntry entry;
    entry.name = entry.kernel = kernel;
    entry.library = "boxwood";
    entry.is_peer = false;
    entry.promise = found->info.promise;
    entry.relative_width = found->info.relative_width;
    entry.yes_is_proven = found->info.yes_is_proven;
    entry.has_witnesses = found->info.has_witnesses;
    entry.summary = found->info.summary;
    entry.notes = found->how_called;
    entry.precision = found->precision;
    entry.params_json = fmt::format("{{\"family\": \"{}\", \"promise\": \"{}\"}}", name(),
                                    to_string(found->info.promise));
    entry.runs_on = RunsOn::one_thread;
    entry.answers = {{std::string(name()),
                      [make = found->make](const Job& job) { return make(job.scene->cases); },
                      found->make_on_device}};
    return entry;
}

std::vector<ContenderEntry> KernelTask::contenders_on_cases() const {
    std::vector<ContenderEntry> all;
    for (const KernelInfo& kernel : kernels())
        all.push_back(kernel_contender(kernel.name));
    return all;
}

std::optional<std::string> KernelTask::missing(const Scene& scene) const {
    if (!fits(scene.cases))
        return fmt::format("the scene has no cases for {}", name());
    return std::nullopt;
}

std::unique_ptr<Truth> KernelTask::make_truth(const Scene& scene, unsigned threads) const {
    if (!fits(scene.cases))
        throw std::invalid_argument(fmt::format("{} has no cases for {}", scene.name, name()));
    return make_truth_({scene, name(), threads});
}

namespace {

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

std::uint64_t word_of(Answer answer, std::uint8_t tier) {
    return static_cast<std::uint64_t>(answer) * 256 + tier;
}

} // namespace

void append_words(std::vector<std::uint64_t>& words, const Decision& verdict) {
    words.push_back(word_of(verdict.answer, verdict.tier));
}
void append_words(std::vector<std::uint64_t>& words, const Distance& distance) {
    words.insert(words.end(), {bits(distance.distance), bits(distance.lo), bits(distance.hi)});
}
void append_words(std::vector<std::uint64_t>& words, const Impact& impact) {
    words.insert(words.end(),
                 {word_of(impact.answer, impact.tier), bits(impact.t_free), bits(impact.t_hit)});
}
void append_words(std::vector<std::uint64_t>& words, const Aabb<double>& box) {
    for (int k = 0; k < 3; ++k)
        words.insert(words.end(), {bits(box.min[k]), bits(box.max[k])});
}
void append_words(std::vector<std::uint64_t>& words, const RayHit& hit) {
    words.push_back(hit.hit() ? std::bit_cast<std::uint32_t>(hit.t) : ~std::uint64_t{0});
}

std::uint64_t hash_of_words(const std::vector<std::uint64_t>& words) {
    return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
}

} // namespace boxwood::bench
