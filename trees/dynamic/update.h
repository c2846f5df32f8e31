#pragma once

#include "trees/builder.h"
#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace boxwood {

/// What an updater did to take its newest frame.
struct UpdateStep {
    std::size_t placed = 0; ///< items that were given a new place in the order of the tree
    bool rebuilt = false;   ///< whether a new order of all items was made

    // Of cached pairs (detail/cached_pairs.h):
    bool pairs_rebuilt = false; ///< whether all of them were searched for again
    std::size_t examined = 0;   ///< pairs tested again
    std::size_t fast = 0;       ///< items whose pairs are not cached but found in every frame
    /// Whether what is asked of this frame is answered with pairs that an earlier one found.
    bool answers_from_cache = false;
};

/// A tree over boxes that move from frame to frame, by one policy. The memory is used again, the
/// answers are those of the newest frame exactly, and they, their order and the tree are the same
/// on every executor.
/// `refit` and `refine` never make a new order of all items, which is for `rebuild`, `merge` and
/// `auto`: once most items are far from where they began, a query tests most boxes. Their SAH is
/// then 10 and 9 times that of a fresh tree of 2,000 items, 35 and 14 times of 20,000.
/// An item is absent while its box is the empty one, `Box{}`: it overlaps nothing, and may come and
/// go between frames.
class Updater {
  public:
    virtual ~Updater() = default;

    /// Forgets what was and starts from these boxes, present or absent. Throws InvalidBox for any
    /// other and std::length_error as `require_valid`; it then holds what it held before.
    virtual void start(Boxes boxes, const Executor& executor) = 0;

    /// Takes the next frame: as many boxes as at the start, those that differ from the last frame
    /// listed in `moved`, ascending (it may list more; of all others the box must be the last
    /// frame's). Throws InvalidBox for a moved box that is neither valid nor absent, and
    /// std::invalid_argument for a number of boxes that is not that of the items or an item that is
    /// none of them; it then holds the last frame.
    virtual void update(Boxes boxes, std::span<const std::uint32_t> moved,
                        const Executor& executor) = 0;

    /// Every unordered pair of overlapping items of the newest frame once, lower item first.
    virtual void self_pairs(const Executor& executor, PairSink& sink) const = 0;
    virtual Work self_pairs_counted(PairSink& sink) const = 0;

    virtual std::size_t size() const = 0;
    /// Memory held between frames.
    virtual std::size_t bytes() const = 0;
    virtual UpdateStep last_step() const = 0;
    /// How many boxes a random line that meets the bounds tests on average in the tree as it
    /// stands, by the surface area heuristic: the 16 lanes of the root block, and those of each
    /// other block as often as its surface is part of that of the bounds. 0 where no box is
    /// present, NaN where the bounds have no surface or one beyond floats. O(n).
    virtual double sah() const = 0;
    /// What is wrong with the tree, every box of it looked at; empty if nothing. O(n).
    virtual std::string fault() const = 0;
};

/// A registry row. `make` throws std::invalid_argument for an unknown or out-of-range setting.
struct UpdateEntry {
    std::string_view name, summary;
    std::vector<SettingInfo> settings;
    std::function<std::unique_ptr<Updater>(const Settings&)> make;
    bool answers_from_cache = false; ///< with pairs found before, whatever became of the tree
    bool may_cache_pairs = false;    ///< it may answer so in some frames
};

std::span<const UpdateEntry> updates();

/// The policy by its registered name. Throws std::invalid_argument for an unknown one, with a
/// suggestion.
const UpdateEntry& find_update(std::string_view name);

} // namespace boxwood
