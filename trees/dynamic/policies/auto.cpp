#include "trees/dynamic/detail/cached_pairs.h"
#include "trees/dynamic/detail/far_sample.h"
#include "trees/dynamic/detail/margins.h"
#include "trees/dynamic/detail/policy.h"
#include "trees/dynamic/detail/step_sample.h"
#include "trees/dynamic/order_degradation.h"

#include <algorithm>
#include <array>
#include <utility>

namespace boxwood {
using namespace detail;
namespace {

/// Picks by what moved, never by the clock, so that the answers and their order are the same
/// everywhere. While a forecast from the steps of a sample of the items says that it pays, pairs
/// are cached, as long as what was spent confirms it. Otherwise the tree answers: bounds are
/// refitted until what queries lose by that exceeds what a new order takes (order_degradation.h).
/// Then the items that went far (far_sample.h) are merged in at their new places if they are few,
/// else all get a new order.
struct Auto {
    static constexpr std::string_view name = "auto";
    static constexpr std::string_view summary = "cached pairs, refit, merge or a new order, by how "
                                                "many moved, how far, and what that came to";

    /// What goes beyond has gone far: of the mean side of a box, or of the cube that holds sixteen
    /// where they are thin.
    double margin = 1;
    double patience = 1.5; ///< what queries may lose before a new order, in times of making one

    static std::array<Setting<Auto>, 2> settings() {
        return {
            {{"margin",
              "how far a box may go before it has gone far, in sides of a box or of sixteen "
              "boxes' place",
              &Auto::margin, 0, 1e6},
             {"patience",
              "what queries may lose by grown bounds before a new order, in times of making one",
              &Auto::patience, 0, 1e6}}};
    }

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.reorder(boxes, tree.survey, executor);
        fresh_ = tree.surface();
        far_.start(boxes, margin);
        merges_ = false;
        degradation_.patience = patience;
        degradation_.start(per_order - per_refit, tree.layout(), boxes);
        wait_ = 0;
        pause_ = min_pause;
        constexpr double slow = 3e-3; // until steps have been seen
        begin_caching(tree, boxes, slow, executor);
        sample_.start(boxes);
        is_first_ = true;
        tree.step = {};
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        const bool is_first = std::exchange(is_first_, false);
        if (cached_.holds() && !is_first)
            return follow_cached(tree, boxes, moved, executor);
        if (moved.empty())
            return;
        if (wait_ > 0) {
            if (--wait_ == 0)
                sample_.start(boxes);
            return follow(tree, boxes, moved, executor);
        }
        const auto steps = sample_.follow(boxes, moved);
        const bool would_pay = pays(
            cached_.forecast({steps.begin(), steps.end()}, sample_.items_each(), moved.size()));
        if (cached_.holds())
            return would_pay ? follow_cached(tree, boxes, moved, executor)
                             : do_without(tree, boxes, moved, executor);
        if (would_pay)
            return begin_caching(tree, boxes, cached_.pace() / cached_.side(), executor);
        wait_ = between_looks;
        follow(tree, boxes, moved, executor);
    }
    const CachedPairs& cached_pairs() const { return cached_; }
    std::size_t bytes() const {
        return far_.bytes() + margins_.bytes() + cached_.bytes() + sample_.bytes();
    }

  private:
    /// Without cached pairs. Items that went far are merged in if they alone are the cause.
    void follow(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        if (!degradation_.is_due_next()) {
            tree.refit(boxes, moved, executor);
            degradation_.degraded(area_ratio(tree));
            if (!degradation_.is_due())
                return;
        }
        improve_order(tree, boxes, moved, executor);
    }
    void improve_order(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                       const Executor& executor) {
        const auto n = static_cast<double>(tree.size());
        const FarSample::Found far = far_.look(boxes);
        const double refit = std::min(1., 16 * static_cast<double>(moved.size()) / n) * per_refit,
                     merge = per_merge + per_merged * static_cast<double>(far.items) / n;
        constexpr double nearly_all = .8;
        const bool merges = merge < per_order && far.share > nearly_all;
        if (merges)
            merge_in(tree, boxes, moved, executor);
        else
            reorder(tree, boxes, executor);
        degradation_.reordered((merges ? merge : per_order) - refit, tree.layout(), boxes);
    }
    /// At first an order that can be added to.
    void merge_in(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                  const Executor& executor) {
        if (merges_) {
            const auto far = margins_.left(boxes, moved);
            tree.merge_in(boxes, far, executor);
            margins_.follow(boxes, far);
            far_.start_far(boxes);
            return;
        }
        tree.order_to_merge(boxes, tree.survey, executor);
        fresh_ = tree.surface();
        far_.start(boxes, margin);
        margins_.start_wide(boxes, far_.reach());
        merges_ = true;
    }
    void reorder(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.reorder(boxes, tree.survey, executor);
        fresh_ = tree.surface();
        far_.start(boxes, margin);
        merges_ = false;
    }
    double area_ratio(const MovingTree& tree) const {
        const double now = tree.surface();
        constexpr double all_new = 1e6; // boxes came where there were none
        return fresh_ > 0 ? now / fresh_ : now > 0 ? all_new : 1;
    }

    bool pays(double nanoseconds) const { return nanoseconds < .75 * cached_.search_cost(); }

    void begin_caching(MovingTree& tree, Boxes boxes, double step, const Executor& executor) {
        cached_.drop();
        cached_.start(boxes, step);
        lost_ = 0;
        paid_ = 0;
        if (!cached_.rebuild(tree, boxes, executor))
            stop_caching(tree, boxes, executor);
    }
    void follow_cached(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                       const Executor& executor) {
        bool held = cached_.follow(tree, boxes, moved, executor);
        if (!held && pays(cached_.forecast()))
            held = cached_.rebuild(tree, boxes, executor);
        lost_ = std::max(0., lost_ + cached_.spent() - cached_.search_cost());
        // The next frames are to make good for a rebuild.
        if (!held || lost_ > cached_.rebuild_cost() + 2 * cached_.search_cost() ||
            cached_.churn_cost() > cached_.search_cost())
            stop_caching(tree, boxes, executor);
        else if (lost_ == 0 && ++paid_ == some_frames)
            pause_ = min_pause;
    }
    /// In the first frame the order is that of the start.
    void do_without(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                    const Executor& executor) {
        cached_.drop();
        wait();
        tree.exchange(boxes, executor);
        degradation_.degraded(area_ratio(tree));
        if (degradation_.is_due())
            improve_order(tree, boxes, moved, executor);
    }
    /// It did not pay.
    void stop_caching(MovingTree& tree, Boxes boxes, const Executor& executor) {
        cached_.drop();
        wait();
        reorder(tree, boxes, executor);
        degradation_.reordered(per_order - per_refit, tree.layout(), boxes);
    }
    /// Each time longer until it is tried again.
    void wait() {
        wait_ = pause_;
        pause_ = std::min<std::size_t>(2 * pause_, 1024);
    }

    /// Nanoseconds for each item, as in OrderDegradation; `per_merged` for each that went far.
    static constexpr double per_refit = 8, per_order = 20, per_merge = 11, per_merged = 50;
    static constexpr std::size_t min_pause = 32, some_frames = 64, between_looks = 8;

    FarSample far_;
    Margins margins_; ///< while it merges
    bool merges_ = false;
    OrderDegradation degradation_;
    double fresh_ = 0; ///< surface of the blocks at the last new order
    CachedPairs cached_;
    StepSample sample_;                        ///< followed while no pairs are cached
    bool is_first_ = false;                    ///< no frame has come since the start
    double lost_ = 0;                          ///< by caching pairs, of late
    std::size_t paid_ = 0;                     ///< frames in which caching them paid
    std::size_t wait_ = 0, pause_ = min_pause; ///< frames until caching may be tried again
};

} // namespace

UpdateEntry auto_update() {
    UpdateEntry entry = update_entry<Auto>();
    entry.may_cache_pairs = true;
    return entry;
}

} // namespace boxwood
