#include "trees/dynamic/detail/margins.h"
#include "trees/dynamic/detail/policy.h"

#include <array>

namespace boxwood {
using namespace detail;
namespace {

/// Keeps the order along the curve: items whose boxes left their fat boxes are taken out, sorted
/// by themselves, and merged in at their new places. The others are refitted where they are.
struct Merge {
    static constexpr std::string_view name = "merge";
    static constexpr std::string_view summary = "what left its place is sorted along the curve and "
                                                "merged into the order, the rest refitted";

    double margin = .5; ///< of the mean side of a box, on each side

    static std::array<Setting<Merge>, 1> settings() {
        return {{{"margin", "how far a box may go before it gets a new place, in mean sides",
                  &Merge::margin, 0, 1e6}}};
    }

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.order_to_merge(boxes, tree.survey, executor);
        margins_.start(boxes, margin);
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        const auto left = margins_.left(boxes, moved);
        if (left.empty())
            return tree.refit(boxes, moved, executor);
        tree.merge_in(boxes, left, executor);
        margins_.follow(boxes, left);
    }
    std::size_t bytes() const { return margins_.bytes(); }

  private:
    Margins margins_;
};

} // namespace

UpdateEntry merge_update() { return update_entry<Merge>(); }

} // namespace boxwood
