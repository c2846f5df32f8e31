#include "trees/dynamic/detail/cached_pairs.h"
#include "trees/dynamic/detail/policy.h"

#include <array>

namespace boxwood {
using namespace detail;
namespace {

/// Keeps the overlapping pairs themselves and looks at a pair again only when motion may have
/// changed it. Where there are too many pairs to keep, the tree answers.
struct Keep {
    static constexpr std::string_view name = "keep";
    static constexpr std::string_view summary =
        "the pairs are kept, each looked at again when motion may have changed it";

    double margin = 0; ///< of the median side of a box, on each side; 0: by the steps observed

    static std::array<Setting<Keep>, 1> settings() {
        return {
            {{"margin",
              "how far boxes may go before all pairs are found anew, in median sides; 0: by the "
              "steps observed",
              &Keep::margin, 0, 1e6}}};
    }

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.order_anew(boxes, tree.survey, executor);
        kept_.margin = margin;
        keep_anew(tree, boxes, executor);
        tree.step = {};
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        if (kept_.holds()) {
            if (!kept_.follow(tree, boxes, moved, executor))
                renew(tree, boxes, executor);
            return;
        }
        constexpr std::size_t some_frames = 64;
        constexpr double too_loose = 1.35;
        tree.refit(boxes, moved, executor);
        if (tree.looseness() > too_loose)
            tree.order_anew(boxes, tree.survey, executor);
        if (++frames_ % some_frames == 0)
            keep_anew(tree, boxes, executor);
    }
    const CachedPairs& cached_pairs() const { return kept_; }
    std::size_t bytes() const { return kept_.bytes(); }

  private:
    void keep_anew(MovingTree& tree, Boxes boxes, const Executor& executor) {
        constexpr double slow = 3e-3; // until steps have been seen
        kept_.start(boxes, slow);
        renew(tree, boxes, executor);
    }
    void renew(MovingTree& tree, Boxes boxes, const Executor& executor) {
        if (kept_.renew(tree, boxes, executor))
            return;
        kept_.drop();
        tree.exchange(boxes, executor);
        frames_ = 0;
    }

    CachedPairs kept_;
    std::size_t frames_ = 0; ///< in which the tree answered
};

} // namespace

UpdateEntry keep_update() { return update_entry<Keep>(); }

} // namespace boxwood
