#pragma once

#include <span>
#include <string>
#include <string_view>

namespace boxwood {

/// The candidate nearest to a misspelt word by edit distance (insert, delete, replace, swap two
/// neighbours: one each), the first of equals; empty if none is within a third of the word's length
/// (two edits at least).
std::string suggest(std::string_view word, std::span<const std::string_view> candidates);

/// "unknown scene 'unifrom'; did you mean 'uniform'?", or the list of all words if none is near.
std::string unknown_word(std::string_view what, std::string_view word,
                         std::span<const std::string_view> candidates);

} // namespace boxwood
