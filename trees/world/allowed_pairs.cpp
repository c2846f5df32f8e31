#include "trees/world/allowed_pairs.h"

#include "kernels/suggest.h"

#include <algorithm>
#include <stdexcept>

namespace boxwood {

AllowedPairs::AllowedPairs(std::vector<std::string> names, std::span<const AllowedPair> pairs)
    : matrix_(0) {
    for (std::string& name : names)
        add_item(std::move(name));
    for (const AllowedPair& pair : pairs)
        allow(pair.a, pair.b, pair.reason, pair.note);
}

std::uint32_t AllowedPairs::item(std::string_view name) const {
    const auto found = items_.find(name);
    if (found != items_.end())
        return found->second;
    std::vector<std::string_view> known;
    for (const std::string& one : names_)
        if (!one.empty())
            known.emplace_back(one);
    throw std::invalid_argument("allowed pairs: " + unknown_name("item", name, known));
}

std::uint32_t AllowedPairs::add_item(std::string name) {
    const auto index = static_cast<std::uint32_t>(names_.size());
    if (!name.empty() && !items_.try_emplace(name, index).second)
        throw std::invalid_argument("allowed pairs: two items have the name '" + name + "'");
    names_.push_back(std::move(name));
    matrix_.add_item();
    return index;
}

void AllowedPairs::allow(std::uint32_t a, std::uint32_t b, AllowedReason reason, std::string note) {
    matrix_.allow(a, b);
    entries_.insert_or_assign(key(a, b), Entry{reason, std::move(note)});
}

void AllowedPairs::disallow(std::uint32_t a, std::uint32_t b) {
    matrix_.disallow(a, b);
    entries_.erase(key(a, b));
}

std::optional<AllowedReason> AllowedPairs::reason(std::uint32_t a, std::uint32_t b) const {
    const auto found = entries_.find(key(a, b));
    return found == entries_.end() ? std::nullopt : std::optional(found->second.reason);
}

std::vector<AllowedPair> AllowedPairs::pairs() const {
    std::vector<AllowedPair> all;
    all.reserve(entries_.size());
    for (const auto& [key, entry] : entries_)
        all.push_back({static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key),
                       entry.reason, entry.note});
    std::ranges::sort(all, {}, [](const AllowedPair& p) { return std::pair(p.a, p.b); });
    return all;
}

} // namespace boxwood
