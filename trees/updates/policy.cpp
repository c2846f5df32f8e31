#include "trees/updates/policy.h"

namespace boxwood {

void require_frame(Boxes boxes, std::span<const std::uint32_t> moved, std::size_t size) {
    if (boxes.size() != size)
        throw std::invalid_argument("update: the tree holds " + std::to_string(size) +
                                    " items, but there are " + std::to_string(boxes.size()) +
                                    " boxes; give one per item, or start anew");
    if (moved.size() == size) { // in one pass, if they are all of them
        bool all = true;
        for (std::size_t i = 0; i < size; ++i)
            all &= moved[i] == i;
        if (all)
            return require_valid(boxes);
    }
    std::size_t next = 0; // least item that may follow
    for (const std::uint32_t item : moved) {
        if (item < next || item >= size)
            throw std::invalid_argument(
                "update: item " + std::to_string(item) + " of the moved ones is " +
                (item < size ? "out of order; list them ascending, each once"
                             : "none of the " + std::to_string(size) + " items"));
        next = std::size_t{item} + 1;
        if (!boxes[item].is_valid())
            throw InvalidBox(item, "a NaN, an infinity or min > max; give finite corners, min <= "
                                   "max");
    }
}

} // namespace boxwood
