#pragma once

#include "kernels/kinematics/robot_description.h"
#include "trees/queries/allowed_collisions.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace boxwood {

/// An allowed collision matrix of named items (links of a robot, bodies of a world), in which each
/// pair has a reason. Symmetric; it starts empty. Lookups take O(1), by name as by index. Without
/// the names it is `matrix()`, which `without_allowed` and traversals filter by.
class AllowedPairs {
  public:
    AllowedPairs() : matrix_(0) {}
    /// Item i has names[i]; an item without a name has its index alone. Throws
    /// std::invalid_argument if two items have one name, or as `allow` does.
    explicit AllowedPairs(std::vector<std::string> names, std::span<const AllowedPair> pairs = {});

    std::size_t items() const { return names_.size(); }
    std::size_t size() const { return entries_.size(); } ///< number of allowed pairs
    const std::string& name(std::uint32_t item) const { return names_[item]; }
    /// Throws std::invalid_argument, with a suggestion, if no item has that name.
    std::uint32_t item(std::string_view name) const;
    /// One more item at the end, whose pairs are not allowed yet. Returns its index.
    std::uint32_t add_item(std::string name = {});

    /// Again for a pair: the reason and note are replaced. Throw std::invalid_argument if a and b
    /// are one item, or for a name or index of none.
    void allow(std::uint32_t a, std::uint32_t b, AllowedReason reason, std::string note = {});
    void allow(std::string_view a, std::string_view b, AllowedReason reason,
               std::string note = {}) {
        allow(item(a), item(b), reason, std::move(note));
    }
    void disallow(std::uint32_t a, std::uint32_t b);
    void disallow(std::string_view a, std::string_view b) { disallow(item(a), item(b)); }

    /// Two different items, in either order.
    bool allows(std::uint32_t a, std::uint32_t b) const { return matrix_.allows(a, b); }
    bool allows(std::string_view a, std::string_view b) const { return allows(item(a), item(b)); }
    /// None if the pair is not allowed.
    std::optional<AllowedReason> reason(std::uint32_t a, std::uint32_t b) const;
    std::optional<AllowedReason> reason(std::string_view a, std::string_view b) const {
        return reason(item(a), item(b));
    }

    /// All of them, sorted by a, then b.
    std::vector<AllowedPair> pairs() const;
    const AllowedCollisions& matrix() const { return matrix_; }

  private:
    struct Entry {
        AllowedReason reason;
        std::string note;
    };
    struct Hash {
        using is_transparent = void;
        std::size_t operator()(std::string_view name) const {
            return std::hash<std::string_view>()(name);
        }
    };
    static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
        return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
    }

    AllowedCollisions matrix_;
    std::vector<std::string> names_;
    std::unordered_map<std::string, std::uint32_t, Hash, std::equal_to<>> items_;
    std::unordered_map<std::uint64_t, Entry> entries_;
};

} // namespace boxwood
