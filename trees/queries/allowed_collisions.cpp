#include "trees/queries/allowed_collisions.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace boxwood {

AllowedCollisions::AllowedCollisions(std::size_t items)
    : items_(items), bits_(items < 2 ? 0 : items * (items - 1) / 2) {}

std::size_t AllowedCollisions::size() const {
    return static_cast<std::size_t>(std::count(bits_.begin(), bits_.end(), true));
}

void AllowedCollisions::add_item() {
    bits_.resize(bits_.size() + items_);
    ++items_;
}

std::size_t AllowedCollisions::checked_slot(std::uint32_t a, std::uint32_t b) const {
    if (a == b)
        throw std::invalid_argument("allowed collisions: item " + std::to_string(a) +
                                    " against itself is not a pair");
    if (a >= items_ || b >= items_)
        throw std::invalid_argument("allowed collisions: pair (" + std::to_string(a) + ", " +
                                    std::to_string(b) + ") of " + std::to_string(items_) +
                                    " items, which are numbered from 0");
    return slot(a, b);
}

AllowedCollisions allow_neighbours(std::size_t items) {
    AllowedCollisions allowed(items);
    for (std::size_t i = 1; i < items; ++i)
        allowed.allow(static_cast<std::uint32_t>(i - 1), static_cast<std::uint32_t>(i));
    return allowed;
}

} // namespace boxwood
