#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

/// The candidate nearest to a misspelt name by edit distance (insert, delete, replace, swap two
/// neighbours: one each), the first of equals; empty if none is within a third of the name's length
/// (two edits at least).
std::string suggest(std::string_view word, std::span<const std::string_view> candidates);

/// "unknown scene 'unifrom'; did you mean 'uniform'?", or the list of all names, or of 40 of them,
/// if none is near.
std::string unknown_name(std::string_view what, std::string_view word,
                         std::span<const std::string_view> candidates);

/// The names of a registry.
template <class Entries> std::vector<std::string_view> names_of(const Entries& entries) {
    std::vector<std::string_view> names;
    for (const auto& entry : entries)
        names.emplace_back(entry.name);
    return names;
}

/// The entry of that name, which outlives the call. Throws std::invalid_argument with the text of
/// `unknown_name` if there is none.
template <class Entry>
const Entry& entry_named(std::string_view name, std::span<const Entry> entries,
                         std::string_view what) {
    for (const Entry& entry : entries)
        if (entry.name == name)
            return entry;
    throw std::invalid_argument(unknown_name(what, name, names_of(entries)));
}

} // namespace boxwood
