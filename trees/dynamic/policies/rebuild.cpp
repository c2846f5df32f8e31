#include "trees/dynamic/detail/policy.h"

#include <array>

namespace boxwood {
using namespace detail;
namespace {

/// Refits until the surface of the blocks has grown too far, then makes a new order.
struct Rebuild {
    static constexpr std::string_view name = "rebuild";
    static constexpr std::string_view summary =
        "refit until the blocks have grown past a trigger, then a new order";

    double trigger = 1.35; ///< surface of the blocks against that of the last new order; 0: always

    static std::array<Setting<Rebuild>, 1> settings() {
        return {{{"trigger", "area ratio of the blocks above which all is ordered again; 0: always",
                  &Rebuild::trigger, 0, 1e6}}};
    }

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.reorder(boxes, tree.survey, executor);
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor) {
        if (trigger > 0)
            tree.refit(boxes, moved, executor);
        if (!(trigger > 0 && tree.area_ratio() <= trigger))
            tree.reorder(boxes, tree.survey, executor);
    }
    std::size_t bytes() const { return 0; }
};

} // namespace

UpdateEntry rebuild_update() { return update_entry<Rebuild>(); }

} // namespace boxwood
