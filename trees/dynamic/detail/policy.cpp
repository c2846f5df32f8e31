#include "trees/dynamic/detail/policy.h"
#include "trees/dynamic/detail/box_steps.h"

namespace boxwood::detail {
namespace {

[[noreturn]] void throw_bad_list(std::span<const std::uint32_t> moved, std::size_t size) {
    std::size_t next = 0; // least item that may follow
    for (const std::uint32_t item : moved) {
        if (item < next || item >= size)
            throw std::invalid_argument(
                "update: item " + std::to_string(item) + " of the moved ones is " +
                (item < size ? "out of order; list them ascending, each once"
                             : "none of the " + std::to_string(size) + " items"));
        next = std::size_t{item} + 1;
    }
    throw std::logic_error("a list of moved items is ascending after all");
}

} // namespace

std::optional<Survey> survey_frame(Boxes boxes, std::span<const std::uint32_t> moved,
                                   std::size_t size, const Executor& executor) {
    if (boxes.size() != size)
        throw std::invalid_argument("update: the tree holds " + std::to_string(size) +
                                    " items, but there are " + std::to_string(boxes.size()) +
                                    " boxes; give one per item, or call start again");
    if (!are_ascending(moved) || (!moved.empty() && moved.back() >= size))
        throw_bad_list(moved, size);
    if (is_nearly_all(moved.size(), size))
        return survey_of(boxes, executor);
    for (const std::uint32_t item : moved)
        require_present_or_absent(item, boxes[item]);
    return {};
}

} // namespace boxwood::detail
