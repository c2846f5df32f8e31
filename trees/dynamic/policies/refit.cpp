#include "trees/dynamic/detail/policy.h"

namespace boxwood {
using namespace detail;
namespace {

/// The order of the start stays; bounds follow the boxes. Cheapest while boxes stay near their
/// places, and worse and worse once they leave them.
struct Refit {
    static constexpr std::string_view name = "refit";
    static constexpr std::string_view summary =
        "new bounds in the old order, of all blocks or only above what moved: for boxes that stay "
        "near their places; once most are far away, queries test most boxes";

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.reorder(boxes, tree.survey, executor);
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        tree.refit(boxes, moved, executor);
    }
    std::size_t bytes() const { return 0; }
};

} // namespace

UpdateEntry refit_update() { return update_entry<Refit>(); }

} // namespace boxwood
