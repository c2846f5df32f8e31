#pragma once

#include "bench/replay/recorded_program.h"
#include "trees/queries/sinks.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What one call came to when a program was run again.
struct ReplayedCall {
    double ns = 0;
    std::uint64_t shown = 0, keys = 0; ///< pairs whose bounds overlap, and the sum of their keys
    double min_distance = std::numeric_limits<double>::infinity(); ///< of bounds, or of shapes
    std::vector<Pair> touching{}; ///< with shapes: the pairs that touch, the lesser object first
};

/// With shapes: two objects touch.
inline void note_touching(ReplayedCall& to, std::uint32_t a, std::uint32_t b) {
    ++to.shown;
    to.keys = recording::sum(to.keys, recording::key(a, b));
    to.touching.push_back({std::min(a, b), std::max(a, b)});
}

/// A manager that a recorded program can be run with.
class Replay {
  public:
    virtual ~Replay() = default;
    /// From an empty manager: the calls in their order, but for those for which `includes` is
    /// false. By bounds: the objects are moved outside the clock; a callback takes note of what
    /// overlaps, and ends a query where the program's did. With shapes: moving them is timed, too;
    /// what is noted are the pairs that touch and the least distance, and a query that the program
    /// ended is ended at the first pair; queries with another manager are left out.
    virtual void run(const std::function<bool(std::size_t call)>& includes,
                     std::vector<ReplayedCall>& calls) = 0;
};

/// One manager in one setting. Ours are of the library boxwood.
struct ReplayEntry {
    std::string name, library, summary;
    std::function<std::unique_ptr<Replay>(const RecordedProgram&)> make;
    bool is_truth = false;   ///< it tests all pairs, and is what the others are held against
    bool has_shapes = false; ///< it also does the narrow phase; `make` gives null where it cannot
    bool in_floats = false;  ///< with shapes: to which poses are rounded
};

/// What a manager did in some rounds.
struct ReplayOutcome {
    std::string name, summary;
    bool is_ours = false, has_shapes = false, in_floats = false;
    std::vector<double> total_ns;            ///< by round
    std::vector<std::vector<double>> per_ns; ///< by call of recording::Call, by round
    std::size_t wrong = 0, first_wrong = 0;  ///< of the queries that were checked
    std::string witness;                     ///< with shapes: of the first wrong one, in words
    /// Of the queries that were not: that are not as those of the report's first of such.
    std::size_t differ = 0, first_differs = 0;
};

struct ReplayReport {
    std::vector<ReplayOutcome> outcomes; ///< those by bounds, then with shapes; of each ours first
    std::size_t n_queries = 0, n_checked = 0, n_too_dear = 0; ///< for max_tests
    std::size_t n_of_chance = 0; ///< distances that the program ended: the order of pairs decides
    std::size_t n_shapes_checked = 0, n_shapes_too_dear = 0; ///< for max_tests
    std::vector<std::string> left_out; ///< which its library cannot run this program with
    /// Queries in which the program's own manager showed fewer pairs than overlap.
    std::size_t n_missed = 0, first_missed = 0;
};

/// Runs a program with every manager of the entries, `rounds` times in turns, in another order
/// each round. Answers are held against the entry that is the truth, query by query, until it has
/// tested `max_tests` pairs; with shapes against a ShapeTruth; beyond, against those of the first
/// by bounds, or with shapes. `goes_on` gets what is done next;
/// where it says false the complete rounds are reported.
ReplayReport replay(const RecordedProgram& program, const std::vector<ReplayEntry>& entries,
                    unsigned rounds, double max_tests,
                    const std::function<bool(const std::string&)>& goes_on);

/// A World of ours, with its own narrow phase.
ReplayEntry world_replay();

/// That one and those of all peers that were found.
std::vector<ReplayEntry> replay_entries();

} // namespace boxwood::bench
