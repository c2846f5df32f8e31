#pragma once

#include "bench/commands/command.h"
#include "bench/config.h"
#include "scenes/suggest.h"
#include "trees/update.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace boxwood::bench {

using Words = std::vector<std::string_view>;

template <class Entries> Words names_of(const Entries& entries) {
    Words words;
    for (const auto& entry : entries)
        words.emplace_back(entry.name);
    return words;
}

/// Reads typed values out of a table and says where a bad one stands.
class ConfigReader {
  public:
    explicit ConfigReader(std::string file) : file_(std::move(file)) {}

    std::string place(const toml::source_region& source) const {
        return fmt::format("{}:{}", file_, source.begin.line);
    }

    [[noreturn]] void fail(const toml::source_region& source, const std::string& message) const {
        throw BadInput(place(source) + ": " + message);
    }

    void require_known_keys(const toml::table& table, std::string_view where,
                            const Words& known) const {
        for (const auto& [key, value] : table)
            if (std::ranges::find(known, key.str()) == known.end())
                fail(key.source(), unknown_word(fmt::format("key of {}", where), key.str(), known));
    }

    double number(const toml::node& node, std::string_view key, double least, double most) const {
        const auto value = node.value<double>();
        if (!value || !node.is_number())
            fail(node.source(), fmt::format("{} must be a number", key));
        if (!(*value >= least && *value <= most))
            fail(node.source(),
                 fmt::format("{} = {} is out of range: it must lie between {} and {}", key, *value,
                             least, most));
        return *value;
    }

    std::uint64_t whole(const toml::node& node, std::string_view key, std::int64_t least,
                        std::int64_t most) const {
        if (!node.is_integer())
            fail(node.source(), fmt::format("{} must be a whole number", key));
        const std::int64_t value = *node.value<std::int64_t>();
        if (value < least || value > most)
            fail(node.source(),
                 fmt::format("{} = {} is out of range: it must lie between {} and {}", key, value,
                             least, most));
        return static_cast<std::uint64_t>(value);
    }

    std::string word(const toml::node& node, std::string_view key, const Words& known) const {
        const auto value = node.value<std::string>();
        if (!value)
            fail(node.source(), fmt::format("{} must be a word in quotes", key));
        if (std::ranges::find(known, *value) == known.end())
            fail(node.source(), fmt::format("{}: {}", key, unknown_word("word", *value, known)));
        return *value;
    }

    unsigned threads(const toml::node& node) const {
        if (node.is_string()) {
            word(node, "threads", {"all"});
            return std::max(1u, std::thread::hardware_concurrency());
        }
        return static_cast<unsigned>(whole(node, "threads", 1, 1024));
    }

    /// "ploc", or with a stage after it "ploc+reinsertion".
    std::string builder_words(const toml::node& node) const {
        const std::string words = node.value_or(std::string());
        const std::size_t plus = words.find('+');
        if (!node.is_string() || plus == std::string::npos)
            return word(node, "builders", names_of(builders()));
        word(toml::value<std::string>(words.substr(0, plus)), "builders", names_of(builders()));
        word(toml::value<std::string>(words.substr(plus + 1)), "stages", names_of(stages()));
        return words;
    }

    /// A builder: its words, or `{name = "binned_sah", bins = 16}`.
    BuilderChoice builder(const toml::node& node) const {
        return with_settings(
            node, "a builder", [&](const toml::node& name) { return builder_words(name); },
            [](const BuilderChoice& choice) { make_builder(choice.name, choice.settings); });
    }

    /// "refit", or `{name = "rebuild", trigger = 1.3}`.
    BuilderChoice update(const toml::node& node) const {
        return with_settings(
            node, "an update",
            [&](const toml::node& name) {
                return word(name, "updates", names_of(boxwood::updates()));
            },
            [](const BuilderChoice& choice) { find_update(choice.name)->make(choice.settings); });
    }

    /// read: the name's node to the name; try_out throws std::invalid_argument for a bad setting.
    template <class Read, class TryOut>
    BuilderChoice with_settings(const toml::node& node, std::string_view what, Read read,
                                TryOut try_out) const {
        if (node.is_string())
            return {read(node), {}};
        const toml::table* table = node.as_table();
        const toml::node* name = table ? table->get("name") : nullptr;
        if (!name)
            fail(node.source(),
                 fmt::format("{} is a word, or {{name = \"WORD\", SETTING = NUMBER, ...}}", what));
        BuilderChoice choice{read(*name), {}};
        for (const auto& [key, value] : *table)
            if (key != "name")
                choice.settings[std::string(key.str())] = number(value, key.str(), -1e300, 1e300);
        try {
            try_out(choice);
        } catch (const std::invalid_argument& error) {
            fail(node.source(), error.what());
        }
        return choice;
    }

    /// Replaces `out` by what `read` makes of the value of `key`, or of each element if it is a
    /// list.
    template <class T, class Read>
    void list(const toml::table& table, std::string_view key, std::vector<T>& out,
              Read read) const {
        const toml::node* node = table.get(key);
        if (!node)
            return;
        out.clear();
        if (const toml::array* array = node->as_array())
            for (const toml::node& element : *array)
                out.push_back(read(element));
        else
            out.push_back(read(*node));
    }

    void words(const toml::table& table, std::string_view key, std::vector<std::string>& out,
               const Words& known) const {
        list(table, key, out, [&](const toml::node& node) { return word(node, key, known); });
    }

  private:
    std::string file_;
};

} // namespace boxwood::bench
