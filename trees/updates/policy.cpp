#include "trees/updates/policy.h"
#include "trees/updates/box_steps.h"

namespace boxwood {

void require_frame(Boxes boxes, std::span<const std::uint32_t> moved, std::size_t size) {
    if (boxes.size() != size)
        throw std::invalid_argument("update: the tree holds " + std::to_string(size) +
                                    " items, but there are " + std::to_string(boxes.size()) +
                                    " boxes; give one per item, or start anew");
    if (moved.size() == size && are_all(moved))
        return require_present_or_absent(boxes);
    std::size_t next = 0; // least item that may follow
    for (const std::uint32_t item : moved) {
        if (item < next || item >= size)
            throw std::invalid_argument(
                "update: item " + std::to_string(item) + " of the moved ones is " +
                (item < size ? "out of order; list them ascending, each once"
                             : "none of the " + std::to_string(size) + " items"));
        next = std::size_t{item} + 1;
        require_present_or_absent(item, boxes[item]);
    }
}

} // namespace boxwood
