#include "results/schema.h"

#include <algorithm>
#include <iterator>

namespace boxwood::results {

std::string_view Column::text(const std::byte* row) const {
    return words.empty() ? value<std::string>(row) : words[value<std::uint8_t>(row)];
}

bool Column::set_text(std::byte* row, std::string_view text) const {
    if (words.empty()) {
        value<std::string>(row) = text;
        return true;
    }
    const auto word = std::ranges::find(words, text);
    if (word == words.end())
        return false;
    value<std::uint8_t>(row) = static_cast<std::uint8_t>(word - words.begin());
    return true;
}

const std::vector<Table>& tables() {
    static const std::vector<Table> all = [] {
        std::vector<Table> both = main_tables();
        std::ranges::move(figure_tables(), std::back_inserter(both));
        return both;
    }();
    return all;
}

} // namespace boxwood::results
