#include "trees/dynamic/detail/policy.h"

#include <algorithm>
#include <array>

namespace boxwood {
using namespace detail;
namespace {

/// Refits, and in each frame sorts one part of the order again, in turn. Parts overlap by half,
/// so that an item may wander on from part to part.
/// Source of the idea: the Bepu physics engine, version 2, which refines a twentieth a frame.
struct Refine {
    static constexpr std::string_view name = "refine";
    static constexpr std::string_view summary =
        "refit, and one rotating part of the order sorted again in each frame: for boxes that "
        "stay near their places, as teleports are not brought home";

    double share = .05; ///< of the order, sorted again in a frame

    static std::array<Setting<Refine>, 1> settings() {
        return {{{"share", "of the order that is sorted again in a frame", &Refine::share, 0, 1}}};
    }

    void start(MovingTree& tree, Boxes boxes, const Executor& executor) {
        tree.reorder(boxes, tree.survey, executor);
        next_ = 0;
    }
    void update(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t>,
                const Executor& executor) {
        const std::size_t n = tree.size();
        const auto part = std::min(n, static_cast<std::size_t>(share * static_cast<double>(n)) + 1);
        const std::size_t end = std::min(n, next_ + part);
        tree.sort_part(boxes, next_, end, executor);
        next_ = end == n ? 0 : next_ + (part + 1) / 2;
    }
    std::size_t bytes() const { return 0; }

  private:
    std::size_t next_ = 0; ///< slot at which the next part begins
};

} // namespace

UpdateEntry refine_update() { return update_entry<Refine>(); }

} // namespace boxwood
