#include "trees/dynamic/detail/margins.h"
#include "trees/dynamic/detail/policy.h"
#include "trees/dynamic/detail/survey.h"
#include "trees/dynamic/dynamic_tree.h"

#include <algorithm>
#include <array>

namespace boxwood {
using namespace detail;
namespace {

/// A dynamic tree of fat boxes gives the order: an item whose box leaves its fat box is removed and
/// inserted at the best place, with rotations on the way up.
struct Reinsert {
    static constexpr std::string_view name = "reinsert";
    static constexpr std::string_view summary =
        "what left its fat box is inserted again into a dynamic tree, the rest refitted";

    double margin = .5; ///< of the mean side of a box, on each side

    static std::array<Setting<Reinsert>, 1> settings() {
        return {{{"margin", "how far a box may go before it is inserted again, in mean sides",
                  &Reinsert::margin, 0, 1e6}}};
    }

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        margins_.start(boxes, margin);
        items_.clear();
        items_.reserve(boxes.size());
        // Along the curve: neighbours in time are neighbours in space, and in the caches.
        for (const std::uint32_t item : present_order(boxes, survey_of(boxes, executor), executor))
            if (!is_absent(boxes[item]))
                items_.insert(item, margins_.fat(item));
        tree.set_order(boxes, order(boxes.size()), executor);
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        const auto left = margins_.left(boxes, moved);
        if (left.empty())
            return tree.refit(boxes, moved, executor);
        margins_.follow(boxes, left);
        for (const std::uint32_t item : left)
            if (items_.contains(item))
                items_.move(item, margins_.fat(item));
            else
                items_.insert(item, margins_.fat(item));
        tree.set_order(boxes, order(boxes.size()), executor);
        tree.step = {left.size(), false};
    }
    std::size_t bytes() const { return margins_.bytes() + items_.bytes(); }

  private:
    /// That of the tree; after it the items that never were present.
    Buffer<std::uint32_t> order(std::size_t n) const {
        Buffer<std::uint32_t> known = items_.order();
        if (known.size() == n)
            return known;
        Buffer<std::uint32_t> all(n);
        std::uint32_t* to = std::ranges::copy(known, all.begin()).out;
        for (std::uint32_t item = 0; item < n; ++item)
            if (!items_.contains(item))
                *to++ = item;
        return all;
    }

    Margins margins_;
    DynamicTree items_;
};

} // namespace

UpdateEntry reinsert_update() { return update_entry<Reinsert>(); }

} // namespace boxwood
