#include "trees/dynamic/detail/cached_pairs.h"
#include "trees/dynamic/detail/policy.h"

#include <array>

namespace boxwood {
using namespace detail;
namespace {

/// Caches the overlapping pairs themselves and tests a pair again only when motion may have changed
/// it. Where there are too many pairs to cache, the tree answers.
struct Cached {
    static constexpr std::string_view name = "cached";
    static constexpr std::string_view summary =
        "the pairs are cached, each tested again when motion may have changed it";

    double margin = 0; ///< of the median side of a box, on each side; 0: by the steps observed

    static std::array<Setting<Cached>, 1> settings() {
        return {
            {{"margin",
              "how far boxes may go before all pairs are found again, in median sides; 0: by the "
              "steps observed",
              &Cached::margin, 0, 1e6}}};
    }

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.reorder(boxes, tree.survey, executor);
        cached_.margin = margin;
        start_caching(tree, boxes, executor);
        tree.step = {};
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        if (cached_.holds()) {
            if (!cached_.follow(tree, boxes, moved, executor))
                rebuild(tree, boxes, executor);
            return;
        }
        constexpr std::size_t some_frames = 64;
        constexpr double max_area_ratio = 1.35;
        tree.refit(boxes, moved, executor);
        if (tree.area_ratio() > max_area_ratio)
            tree.reorder(boxes, tree.survey, executor);
        if (++frames_ % some_frames == 0)
            start_caching(tree, boxes, executor);
    }
    const CachedPairs& cached_pairs() const { return cached_; }
    std::size_t bytes() const { return cached_.bytes(); }

  private:
    void start_caching(MovingTree& tree, Boxes boxes, const Executor& executor) {
        constexpr double slow = 3e-3; // until steps have been seen
        cached_.start(boxes, slow);
        rebuild(tree, boxes, executor);
    }
    void rebuild(MovingTree& tree, Boxes boxes, const Executor& executor) {
        if (cached_.rebuild(tree, boxes, executor))
            return;
        cached_.drop();
        tree.exchange(boxes, executor);
        frames_ = 0;
    }

    CachedPairs cached_;
    std::size_t frames_ = 0; ///< in which the tree answered
};

} // namespace

UpdateEntry cached_update() {
    UpdateEntry entry = update_entry<Cached>();
    entry.answers_from_cache = entry.may_cache_pairs = true;
    return entry;
}

} // namespace boxwood
