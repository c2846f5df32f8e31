#pragma once

#include "trees/dynamic/detail/cached_pairs.h"
#include "trees/dynamic/detail/moving_tree.h"
#include "trees/queries/self_pairs.h"

#include <concepts>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood::detail {

/// A policy says how a MovingTree follows its boxes. Its settings are documented data members with
/// defaults, listed by `settings()`; it may have a state of its own. It sees good frames only. One
/// that caches pairs shows them by `cached_pairs()`: while they hold, they answer and not the tree.
/// What policies decide by: order_degradation.h (when a new order pays), margins.h and far_sample.h
/// (which items left their places), step_sample.h (how fast all move).
template <class P>
concept UpdatePolicy = std::default_initializable<P> && ListsSettings<P> &&
    requires(P policy, MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
             const Executor& executor) {
    policy.start(tree, boxes, executor);
    policy.update(tree, boxes, moved, executor);
    { policy.bytes() } -> std::convertible_to<std::size_t>;
    { P::name } -> std::convertible_to<std::string_view>;
    { P::summary } -> std::convertible_to<std::string_view>;
};

/// The survey of a frame if nearly all of it moved. Throws std::invalid_argument or InvalidBox as
/// Updater::update does.
std::optional<Survey> survey_frame(Boxes boxes, std::span<const std::uint32_t> moved,
                                   std::size_t size, const Executor& executor);

/// Puts a policy behind Updater: bad frames are refused before it sees them.
template <UpdatePolicy P> class UpdaterOf final : public Updater {
  public:
    explicit UpdaterOf(P policy) : policy_(std::move(policy)) {}

    void start(Boxes boxes, const Executor& executor) override {
        tree_.survey = survey_of(boxes, executor);
        tree_.step = {};
        policy_.start(tree_, boxes, executor);
    }
    void update(Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) override {
        tree_.survey = survey_frame(boxes, moved, tree_.size(), executor);
        tree_.step = {};
        if (caches_pairs || !moved.empty())
            policy_.update(tree_, boxes, moved, executor);
        tree_.step.answers_from_cache = valid_pairs() && !tree_.step.pairs_rebuilt;
    }
    void self_pairs(const Executor& executor, PairSink& sink) const override {
        if (const CachedPairs* cached = valid_pairs())
            cached->self_pairs(sink);
        else
            boxwood::self_pairs(tree_.layout(), executor, sink);
    }
    Work self_pairs_counted(PairSink& sink) const override {
        const CachedPairs* cached = valid_pairs();
        return cached ? cached->self_pairs_counted(tree_, sink)
                      : boxwood::self_pairs_counted(tree_.layout(), sink);
    }
    std::size_t size() const override { return tree_.size(); }
    std::size_t bytes() const override { return tree_.bytes() + policy_.bytes(); }
    UpdateStep last_step() const override { return tree_.step; }
    double sah() const override {
        const PackedLayout& layout = tree_.layout();
        if (layout.bounds().is_empty())
            return 0;
        // Below this no area of a lane, which is a float, becomes infinite.
        constexpr double max_area = std::numeric_limits<float>::max() / 2;
        const double area = layout.bounds().half_area();
        return area > 0 && area < max_area ? PackedLayout::width * (1 + layout.surface())
                                           : std::numeric_limits<double>::quiet_NaN();
    }
    std::string fault() const override {
        std::string found = tree_.fault();
        if constexpr (caches_pairs)
            if (found.empty())
                found = policy_.cached_pairs().fault();
        return found;
    }

  private:
    static constexpr bool caches_pairs = requires(const P& policy) {
        { policy.cached_pairs() } -> std::same_as<const CachedPairs&>;
    };

    const CachedPairs* valid_pairs() const {
        if constexpr (caches_pairs)
            if (policy_.cached_pairs().holds())
                return &policy_.cached_pairs();
        return nullptr;
    }

    MovingTree tree_;
    P policy_;
};

/// The registry row of a policy.
template <UpdatePolicy P> UpdateEntry update_entry() {
    return {P::name, P::summary, setting_infos<P>(),
            [](const Settings& values) -> std::unique_ptr<Updater> {
                return std::make_unique<UpdaterOf<P>>(with_settings<P>(values));
            }};
}

} // namespace boxwood::detail
