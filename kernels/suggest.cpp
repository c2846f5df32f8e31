#include "kernels/suggest.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace boxwood {
namespace {

/// Optimal string alignment distance, three rows at a time.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::swap(before, last);
        std::swap(last, row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row.back();
}

} // namespace

std::string suggest(std::string_view word, std::span<const std::string_view> candidates) {
    std::string_view best;
    std::size_t nearest = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string_view candidate : candidates)
        if (const std::size_t distance = edit_distance(word, candidate); distance < nearest) {
            nearest = distance;
            best = candidate;
        }
    return std::string(best);
}

std::string unknown_name(std::string_view what, std::string_view word,
                         std::span<const std::string_view> candidates) {
    std::string text = "unknown " + std::string(what) + " '" + std::string(word) + "'; ";
    if (const std::string near = suggest(word, candidates); !near.empty())
        return text + "did you mean '" + near + "'?";
    text += "known are: ";
    constexpr std::size_t most = 40;
    const std::size_t shown = candidates.size() > most + 1 ? most : candidates.size();
    for (std::size_t i = 0; i < shown; ++i)
        text += (i == 0 ? "" : ", ") + std::string(candidates[i]);
    if (shown < candidates.size())
        text += " and " + std::to_string(candidates.size() - shown) + " more";
    return text;
}

} // namespace boxwood
