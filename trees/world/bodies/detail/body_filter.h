#pragma once

#include "trees/dynamic/detail/lane_groups.h"
#include "trees/world/allowed_pairs.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boxwood::detail {

/// Which bodies may meet: groups of each, and an allowed collision matrix of those that are in some
/// allowed pair, so that memory goes with the square of these alone. Bodies are numbered.
class BodyFilter {
  public:
    void add(std::uint32_t body, const Groups& groups);
    void remove(std::uint32_t body); ///< and its pairs
    void clear() { *this = BodyFilter(); }
    void set_groups(std::uint32_t body, const Groups& groups);

    /// As those of AllowedPairs.
    void allow(std::uint32_t a, std::uint32_t b, AllowedReason reason, std::string note);
    void disallow(std::uint32_t a, std::uint32_t b);
    std::optional<AllowedReason> reason(std::uint32_t a, std::uint32_t b) const;
    std::vector<AllowedPair> pairs() const; ///< of bodies, in their order

    bool may_meet(std::uint32_t a, std::uint32_t b) const {
        if (!detail::may_meet(groups_[a], groups_[b]))
            return false;
        const std::uint32_t item_a = item_of_[a], item_b = item_of_[b];
        return item_a == none || item_b == none || !allowed_.allows(item_a, item_b);
    }
    std::span<const Groups> groups() const { return groups_; } ///< by body; {0, 0} of none
    /// Whether there is a body whose groups and mask are not the default ones.
    bool has_groups() const { return grouped_ > 0; }
    std::size_t allowed() const { return allowed_.size(); } ///< number of pairs
    std::size_t bytes() const {
        return (groups_.capacity() * sizeof(Groups)) + item_of_.capacity() * sizeof(std::uint32_t) +
               allowed_.items() * allowed_.items() / 16;
    }

  private:
    static constexpr std::uint32_t none = ~0u;
    std::uint32_t item(std::uint32_t body);

    std::vector<Groups> groups_;
    std::vector<std::uint32_t> item_of_; ///< by body, or none
    std::vector<std::uint32_t> body_of_; ///< by item, or none
    std::vector<std::uint32_t> free_;    ///< items
    AllowedPairs allowed_;               ///< of items
    std::size_t grouped_ = 0;
};

} // namespace boxwood::detail
