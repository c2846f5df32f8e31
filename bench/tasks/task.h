#pragma once

#include "bench/tasks/answers.h"
#include "bench/tasks/contender.h"
#include "trees/builder.h"
#include "trees/function_ref.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

class BlockReader;
class Truth;

/// What the `scene` key of a sweep file names for a task.
enum class SceneKind : std::uint8_t {
    still,  ///< generators
    moving, ///< built-in moving scenes, scene files, or generators with effects
    cases   ///< families of hard cases
};

/// What is timed of a cell.
enum class Phases : std::uint8_t {
    build_and_query,
    build, ///< the answers tell what was built
    query, ///< there is nothing to build
    frames ///< a build, then update and query for frame after frame
};

/// One way of ours to do a job by builder and layout, by registry names.
struct Choice {
    std::string builder = "binned_sah"; ///< or with an optimizer: "ploc+reinsertion"
    Settings settings;                  ///< of the builder and the optimizer
    std::string layout = "wide8";
    std::string kernel = "watertight"; ///< where the task takes one
    std::string ray_order = "given";   ///< of one hit, and points: ray_orders()
    bool warm_start = false;           ///< of distance: at the triangles of the answer before
    double relative_error = 0;         ///< of distance: DistanceOptions::relative
    bool is_plain = false;             ///< of distance: plain_distance, without a certificate
    bool by_front_door = false;        ///< Bvh or MeshBvh (trees/bvh.h) around the same parts
};

/// Takes the cells that a task wants of a block.
using AddCell = FunctionRef<void(const SceneSpec& scene, const ContenderEntry& contender,
                                 const std::string& executor, unsigned threads)>;

/// One thing that the bench wants of a scene. A task is one file of bench/tasks/ and one name in
/// registry.cpp: the file owns all that is said of it here; the code that plans, times
/// and judges branches on no task.
class Task {
  public:
    virtual ~Task() = default;
    virtual std::string_view name() const = 0;
    virtual std::string_view summary() const = 0;
    /// In two or three words that a newcomer knows, for findings: "nearest hit". The name, if it
    /// says no other.
    virtual std::string title() const;

    /// The keys of a [[cells]] block that it takes, beyond task and rounds.
    virtual std::vector<std::string_view> keys() const = 0;
    virtual SceneKind scenes() const = 0;
    /// Reads its keys and adds its cells.
    virtual void expand(const BlockReader& block, AddCell add) const = 0;

    /// Ours, by builder and layout. Throws std::invalid_argument, with a suggestion, for an unknown
    /// name, and if no builder and layout answer the task.
    virtual ContenderEntry contender(const Choice& choice) const;
    /// The kernels of ours whose family this task is; what makes one into a contender.
    virtual std::span<const KernelInfo> kernels() const { return {}; }
    virtual ContenderEntry kernel_contender(std::string_view kernel) const;

    /// Whether `boxwood check` judges it on such cases, and the contenders of ours that it judges.
    virtual bool fits(const Cases& /*cases*/) const { return false; }
    virtual std::vector<ContenderEntry> contenders_on_cases() const { return {}; }

    /// What it needs and the scene does not have, in words.
    virtual std::optional<std::string> missing(const Scene& /*scene*/) const {
        return std::nullopt;
    }
    /// How many rays, points or cases one query is of; 0 if it is one question about all items.
    virtual std::uint64_t n_queries(const Scene& /*scene*/) const { return 0; }

    virtual Phases phases() const { return Phases::build_and_query; }
    /// Of tasks of frames: whether contenders make the frames themselves (those given are empty).
    virtual bool plays_own_frames() const { return false; }

    virtual std::unique_ptr<Answers> make_answers() const = 0;
    /// Equal for equal answers, whatever the order of pairs.
    virtual std::uint64_t hash(const Answers& answers) const = 0;
    /// `threads` may be used to compute it. The scene must outlive the truth.
    virtual std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const = 0;
    /// What is counted of the answers, and of the work if the contender can count it.
    virtual std::vector<NamedCount> counters(const Answers& /*answers*/,
                                             const Work* /*work*/) const {
        return {};
    }
    /// What a result file shall say of a scene as text, by name.
    virtual std::map<std::string, std::string> texts(const Scene& /*scene*/) const { return {}; }

  protected:
    /// node_visits, box_tests, stack_max; and triangle_tests if there are some.
    static void append_work(std::vector<NamedCount>& counts, const Work* work,
                            bool with_triangles = false);
};

/// Every task, in the order of registry.cpp.
std::span<const Task* const> tasks();
/// The task of this name, or nullptr.
const Task* find_task(std::string_view name);
/// Adds a task that this program brings itself, which must outlive its use.
void add_task(const Task& task);

} // namespace boxwood::bench
