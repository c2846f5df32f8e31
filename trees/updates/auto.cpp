#include "trees/updates/margins.h"
#include "trees/updates/policy.h"

#include <array>

namespace boxwood {
namespace {

/// Picks by what moved, never by the clock, so that the answers and their order are the same
/// everywhere. Items that went far in many are merged in at their new places; if they are most of
/// them, all are ordered anew. Else bounds are refitted, and the excess surface of the blocks is
/// added up from frame to frame: once it has cost queries about as much as a new order takes, that
/// is made. So no more than twice the time of the best moment for it is spent.
struct Auto {
    static constexpr std::string_view name = "auto";
    static constexpr std::string_view summary =
        "refit, merge or a new order, by how many moved, how far, and what that came to";

    double margin = 2;    ///< of the mean side: what goes beyond has gone far
    double patience = .4; ///< excess of the blocks' surface, summed over frames, for a new order

    static std::array<Setting<Auto>, 2> settings() {
        return {{{"margin", "how far a box may go before it has gone far, in mean sides",
                  &Auto::margin, 0, 1e6},
                 {"patience", "excess of the blocks' surface, summed over frames, for a new order",
                  &Auto::patience, 0, 1e6}}};
    }

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.order_anew(boxes, executor);
        margins_.start(boxes, margin);
        excess_ = 0;
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        const std::size_t n = tree.size(), many = n / 50;
        if (moved.size() > many && margins_.about_left(boxes, moved) > many / 2) {
            const auto far = margins_.left(boxes, moved);
            if (far.size() > n / 3)
                return order_anew(tree, boxes, executor);
            if (far.size() > many) {
                tree.merge_in(boxes, far, executor);
                margins_.follow(boxes, far);
                return;
            }
        }
        tree.refit(boxes, moved, executor);
        excess_ += tree.looseness() - 1;
        if (excess_ > patience)
            order_anew(tree, boxes, executor);
    }
    std::size_t bytes() const { return margins_.bytes(); }

  private:
    void order_anew(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.order_anew(boxes, executor);
        margins_.start(boxes, margin);
        excess_ = 0;
    }

    Margins margins_;
    double excess_ = 0; ///< since the last new order
};

} // namespace

UpdateEntry auto_update() { return update_entry<Auto>(); }

} // namespace boxwood
