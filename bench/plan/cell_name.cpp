#include "bench/plan/cell_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood::bench {
namespace {

bool is_word(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
}

bool is_dotted_words(std::string_view text) {
    while (true) {
        const std::size_t dot = text.find('.');
        if (!is_word(text.substr(0, dot)))
            return false;
        if (dot == std::string_view::npos)
            return true;
        text.remove_prefix(dot + 1);
    }
}

void require(bool good, std::string_view part, const std::string& text) {
    if (!good)
        throw std::invalid_argument(
            fmt::format("cell name: the {} \"{}\" is not made of words [a-z0-9_]+", part, text));
}

} // namespace

std::string format_cell_name(const CellName& name) {
    require(is_word(name.scene), "scene", name.scene);
    require(is_word(name.task), "task", name.task);
    require(is_dotted_words(name.contender), "contender", name.contender);
    require(is_word(name.precision), "precision", name.precision);
    require(is_word(name.executor), "executor", name.executor);
    if (!name.isa.empty())
        require(is_word(name.isa), "instruction set", name.isa);
    return fmt::format("{}/n{}-s{}/{}/{}/{}/{}-{}{}{}", name.scene, name.n_items, name.seed,
                       name.task, name.contender, name.precision, name.executor, name.threads,
                       name.isa.empty() ? "" : "/", name.isa);
}

} // namespace boxwood::bench
