#include "bench/plan/cell_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
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

/// Digits alone, no leading zero: the one way in which format_cell_name writes a number.
template <class Integer> bool parse_number(std::string_view text, Integer& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() &&
           (text == "0" || text.front() != '0');
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
    return fmt::format("{}/n{}-s{}/{}/{}/{}/{}-{}", name.scene, name.n_items, name.seed, name.task,
                       name.contender, name.precision, name.executor, name.threads);
}

std::optional<CellName> parse_cell_name(std::string_view text) {
    std::array<std::string_view, 6> parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::size_t slash = text.find('/');
        if ((slash == std::string_view::npos) != (i + 1 == parts.size()))
            return std::nullopt;
        parts[i] = text.substr(0, slash);
        text.remove_prefix(std::min(text.size(), parts[i].size() + 1));
    }
    const auto& [scene, size, task, contender, precision, place] = parts;
    const std::size_t seed_at = size.find("-s");
    const std::size_t threads_at = place.find('-');
    if (!size.starts_with('n') || seed_at == std::string_view::npos ||
        threads_at == std::string_view::npos)
        return std::nullopt;

    CellName name;
    const std::string_view executor = place.substr(0, threads_at);
    if (!is_word(scene) || !is_word(task) || !is_dotted_words(contender) || !is_word(precision) ||
        !is_word(executor) || !parse_number(size.substr(1, seed_at - 1), name.n_items) ||
        !parse_number(size.substr(seed_at + 2), name.seed) ||
        !parse_number(place.substr(threads_at + 1), name.threads))
        return std::nullopt;
    name.scene = scene;
    name.task = task;
    name.contender = contender;
    name.precision = precision;
    name.executor = executor;
    return name;
}

} // namespace boxwood::bench
