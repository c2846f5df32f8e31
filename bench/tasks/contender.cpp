#include "bench/tasks/contender.h"

#include "bench/tasks/instruction_sets.h"
#include "bench/tasks/task.h"
#include "kernels/suggest.h"
#include "peers_found.h"
#include "trees/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood::bench {

#define BOXWOOD_DECLARE(name) Peer name##_peer();
BOXWOOD_PEERS_FOUND(BOXWOOD_DECLARE)
#undef BOXWOOD_DECLARE

namespace {

/// Why no device can be used; empty if one can.
const std::string& no_device() {
    static const std::string why = devices().empty() ? "no CUDA device: " + why_no_device() : "";
    return why;
}

std::optional<std::string> cannot_run_on_device(const Answering& answering, const Job& job) {
    if (!answering.make_on_device)
        return "has no form for a device";
    if (job.executor == graph_executor && !answering.make_by_graph)
        return "has no form for a device that a graph could record";
    if (job.threads != 1)
        return fmt::format("a device counts as one thread, not {}", job.threads);
    if (!no_device().empty())
        return no_device();
    return std::nullopt;
}

std::optional<std::string> cannot_run(RunsOn where, const Job& job) {
    if (where == RunsOn::device)
        return "runs on a device only";
    const unsigned max_threads = entry_named(job.executor, executors(), "executor").max_threads;
    if (max_threads == 1 && job.threads == 1)
        return std::nullopt;
    if (where == RunsOn::one_thread)
        return "runs on one thread only";
    if (where == RunsOn::tbb && job.executor != "tbb")
        return "runs on TBB only";
    if (job.threads > max_threads)
        return fmt::format("the executor {} cannot have {} threads", job.executor, job.threads);
    return std::nullopt;
}

} // namespace

const Answering* ContenderEntry::answering(std::string_view task) const {
    const auto found = std::ranges::find(answers, task, &Answering::task);
    return found == answers.end() ? nullptr : &*found;
}

std::optional<std::string> ContenderEntry::unsupported(const Job& job) const {
    const Answering* const answering = this->answering(job.task->name());
    if (!answering) {
        std::vector<std::string_view> known;
        for (const Answering& other : answers)
            known.push_back(other.task);
        return fmt::format("answers {} only", fmt::join(known, ", "));
    }
    if (job.scene)
        if (auto why = job.task->missing(*job.scene))
            return why;
    if (cannot && job.scene)
        if (auto why = cannot(job))
            return why;
    if (auto why = missing_instruction_set(job.isa))
        return why;
    return is_device(job.executor) ? cannot_run_on_device(*answering, job)
                                   : cannot_run(runs_on, job);
}

std::unique_ptr<Contender> ContenderEntry::make(const Job& job) const {
    const Answering* const answering = this->answering(job.task->name());
    if (!answering)
        throw std::logic_error(fmt::format("{} does not answer {}", name, job.task->name()));
    return (job.executor == graph_executor ? answering->make_by_graph
            : is_device(job.executor)      ? answering->make_on_device
                                           : answering->make)(job);
}

std::span<const Peer> peers() {
#define BOXWOOD_CALL(name) name##_peer(),
#define BOXWOOD_NAME(name) #name,
    static const std::vector<Peer> found = [] {
        constexpr std::string_view names[] = {BOXWOOD_PEERS(BOXWOOD_NAME)};
        std::vector<Peer> all{BOXWOOD_PEERS_FOUND(BOXWOOD_CALL)};
        for (Peer& peer : all)
            peer.place = static_cast<std::size_t>(std::ranges::find(names, peer.name) - names);
        return all;
    }();
#undef BOXWOOD_NAME
#undef BOXWOOD_CALL
    return found;
}

std::vector<ContenderEntry> peers_that_answer(std::string_view task) {
    std::vector<ContenderEntry> all;
    for (const Peer& peer : peers())
        for (const ContenderEntry& contender : peer.contenders)
            if (contender.answers_task(task))
                all.push_back(contender);
    return all;
}

std::span<const std::string_view> absent_peers() {
#define BOXWOOD_NAME(name) #name,
    static const std::vector<std::string_view> absent{BOXWOOD_PEERS_ABSENT(BOXWOOD_NAME)};
#undef BOXWOOD_NAME
    return absent;
}

} // namespace boxwood::bench
