#pragma once

#include "bench/replay/replay.h"
#include "bench/tasks/answers.h"
#include "kernels/decision.h"
#include "results/words.h"
#include "scenes/scene.h"
#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/tree.h"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {
class Ledger; // trees/world/bodies/ledger.h
struct Frame; // scenes/moving/frames.h
} // namespace boxwood

namespace boxwood::bench {

class Task;

/// Where a contender may run beside executors(): on a device, from host memory to host memory, or
/// with input and answers that stay there, launched kernel by kernel or as one CUDA graph.
using results::device_executor, results::graph_executor, results::resident_executor;
inline bool is_device(std::string_view executor) { return results::is_of_device(executor); }

/// One piece of work: a scene, what is wanted of it, and where it runs.
struct Job {
    const Scene* scene = nullptr;
    const Task* task = nullptr;
    std::string executor{default_executor(1)}; ///< a name of executors(), or of a device's places
    unsigned threads = 1;
    std::string isa{}; ///< of instruction_sets(), which it is held to; empty: to none
};

/// A part of build and query by the clock of a device.
struct DeviceTime {
    results::Phase phase;
    double ns = 0;
};

/// What a structure is, for the tree table.
struct StructureInfo {
    std::size_t bytes = 0;
    const Tree* tree = nullptr; ///< valid until the next build; empty if none was needed
    /// Of a policy that follows moving boxes: Updater::sah.
    double sah = std::numeric_limits<double>::quiet_NaN();
};

/// A work counter beyond those of Work.
struct NamedCount {
    std::string name;
    std::uint64_t value = 0;
};

/// What the bench times, ours or a peer's. The job's scene outlives it. Construction converts the
/// input to the library's own types (untimed); destruction releases devices and threads.
class Contender {
  public:
    virtual ~Contender() = default;
    /// Timed: from boxes or triangles to a structure that can answer; replaces an earlier one.
    virtual void build() = 0;
    /// Timed: answers the job into answers of its task, which are cleared. Needs a build before it.
    virtual void query(Answers& answers) = 0;
    /// Timed, of tasks that take cold_caches: appends the answer to one of Task::n_queries, as
    /// query does for all of them.
    virtual void query_part(Answers& /*answers*/, std::size_t /*part*/) {
        throw std::logic_error("it does not answer one query alone");
    }
    /// Untimed: brings the answers of the last query to the host if they stayed on a device.
    virtual void fetch(Answers& /*answers*/) {}
    /// Untimed, of one that runs on a device from host to host: one build and query by its parts.
    virtual std::vector<DeviceTime> device_times(Answers& /*answers*/) { return {}; }
    /// Timed, of tasks of frames: takes the next frame; a query then answers for it. The frame
    /// lives until the next update or build; after a build they come from frame 1.
    virtual void update(const Frame& /*frame*/) {}
    /// Untimed: the same query with its work counted, if the contender can count.
    virtual std::optional<Work> counted_query(Answers&) { return std::nullopt; }
    /// Further counters, of the last counted query or of all frames since the build.
    virtual std::vector<NamedCount> more_counts() const { return {}; }
    /// Of an entry whose classes depend on what it did: they, by the frames since the build.
    virtual std::optional<std::vector<std::string>> classes() const { return std::nullopt; }
    virtual std::optional<StructureInfo> structure() const { return std::nullopt; }
    /// What each stage cost since the last build; null if it has no stages.
    virtual const Ledger* ledger() { return nullptr; }
};

/// One task that a contender answers, and what makes it for that task.
struct Answering {
    using Make = std::function<std::unique_ptr<Contender>(const Job&)>;
    std::string task;
    Make make;
    Make make_on_device{}; ///< for the places of a device; null if it has no such form
    Make make_by_graph{};  ///< of them for graph_executor
};

/// Where a contender can run.
enum class RunsOn : std::uint8_t {
    any_executor,
    one_thread,
    tbb,   ///< or one thread
    device ///< alone
};

/// A registry row: one way to do a job.
struct ContenderEntry {
    std::string name;      ///< "binned_sah.wide8.self_pairs", "fcl.dynamic_aabb_tree", ...
    std::string library;   ///< boxwood, fcl, embree, cgal, bullet, brute_force
    std::string summary;   ///< one line
    std::string notes;     ///< settings, and what differs from the others' work
    std::string precision; ///< f32 | f64: storage and box arithmetic
    std::string builder, layout, traversal, kernel; ///< ours; empty where it does not apply
    bool is_peer = true;
    bool is_reference = false; ///< ours are held against the builder, which has no settings here
    std::size_t place = 0;     ///< ours: of the builder, policy or way to play in its registry
    bool is_plain = true;      ///< ours: by default settings, with no optimizer
    bool answers_from_cache = false; ///< its query tells nothing of its structure
    bool misses_touching = false;    ///< pairs may be missing that do no more than touch
    std::vector<Answering> answers;
    /// Contenders of one job are compared within a class, those of several classes in each. Most
    /// tasks have one, and need not name it; tasks/detail/ray_task.h has those of rays.
    std::vector<std::string> classes{};
    bool keeps_structure = true; ///< false: its build only copies the input
    /// Of ways to play a scene, which are no rivals: "required", "all", or the effect left out.
    std::string stages{};
    RunsOn runs_on = RunsOn::any_executor;
    /// Why it cannot do a job of such a task on such a scene, if so; may be empty.
    std::function<std::optional<std::string>(const Job&)> cannot;
    std::string params_json = "{}";
    Promise promise = Promise::none; ///< ours, of a kernel
    double relative_width = 0;       ///< KernelInfo::relative_width; of meshes, what is allowed
    bool yes_is_proven = false;      ///< KernelInfo::yes_is_proven
    bool has_witnesses = true;       ///< KernelInfo::has_witnesses

    const Answering* answering(std::string_view task) const;
    bool answers_task(std::string_view task) const { return answering(task) != nullptr; }
    /// Nothing if it can do the job, else why not (recorded, not hidden). Of no scene (null) it
    /// says what holds for any.
    std::optional<std::string> unsupported(const Job& job) const;
    /// Throws std::logic_error for a task that it does not answer.
    std::unique_ptr<Contender> make(const Job& job) const;
};

/// One peer library: a file of bench/peers/, compiled where its package is found.
struct Peer {
    std::string name;      ///< "fcl"
    std::string title;     ///< for readers: "FCL"
    std::size_t place = 0; ///< among all peers, found or not
    std::string summary;   ///< one line
    std::string version;   ///< as the library reports it
    std::string build;     ///< what is known of how it was compiled: SIMD, precision, threads
    std::vector<ContenderEntry> contenders;
    std::vector<ReplayEntry> replays{}; ///< what recorded programs can be run with
};

/// The peers compiled in, and the names of those whose package was not found.
std::span<const Peer> peers();
std::span<const std::string_view> absent_peers();

/// The contenders of peers that answer a task.
std::vector<ContenderEntry> peers_that_answer(std::string_view task);

} // namespace boxwood::bench
