#pragma once

#include "kernels/settings.h"
#include "kernels/suggest.h"

#include <toml++/toml.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boxwood {

/// Reads typed values out of TOML tables. A bad one throws std::invalid_argument with its place:
/// "file:line: what is wrong and what is allowed".
class TomlReader {
  public:
    using Names = std::vector<std::string_view>;

    explicit TomlReader(std::string file) : file_(std::move(file)) {}

    const std::string& file() const { return file_; }
    toml::table parse(std::string_view text) const;
    std::string place(const toml::source_region& source) const;
    [[noreturn]] void fail(const toml::source_region& source, const std::string& message) const;

    void require_known_keys(const toml::table& table, std::string_view where,
                            const Names& known) const;
    double number(const toml::node& node, std::string_view key, double min, double max) const;
    std::uint64_t whole(const toml::node& node, std::string_view key, std::int64_t min,
                        std::int64_t max) const;
    std::string text(const toml::node& node, std::string_view key) const;
    /// A number, true or false, or a name, in its own type.
    SettingValue setting(const toml::node& node, std::string_view key) const;
    /// Refuses a name of the node that is not one of the known ones.
    void require_known(const toml::node& node, std::string_view key, std::string_view name,
                       const Names& known) const;
    /// One of the known names.
    std::string name(const toml::node& node, std::string_view key, const Names& known) const;

    /// "NAME", or {name = "NAME", SETTING = VALUE, ...}. read: the name's node to the name;
    /// try_out(name, settings) throws std::invalid_argument for a bad setting; is_taken(key,
    /// value): whether a key is no setting but something of the caller's.
    template <class Read, class TryOut, class IsTaken>
    std::pair<std::string, Settings> with_settings(const toml::node& node, std::string_view what,
                                                   Read read, TryOut try_out,
                                                   IsTaken is_taken) const {
        if (node.is_string())
            return {read(node), {}};
        const toml::table* table = node.as_table();
        const toml::node* name = table ? table->get("name") : nullptr;
        if (!name)
            fail(node.source(),
                 std::string(what) + " is a name, or {name = \"NAME\", SETTING = VALUE, ...}");
        std::pair<std::string, Settings> made{read(*name), {}};
        for (const auto& [key, value] : *table)
            if (key != "name" && !is_taken(key.str(), value))
                made.second[std::string(key.str())] = setting(value, key.str());
        try {
            try_out(made.first, made.second);
        } catch (const std::invalid_argument& error) {
            fail(node.source(), error.what());
        }
        return made;
    }

    /// Replaces `out` by what `read` makes of the value of `key`, or of each element if it is a
    /// list; leaves it as it is if there is no such key.
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
    void names(const toml::table& table, std::string_view key, std::vector<std::string>& out,
               const Names& known) const;

  private:
    std::string file_;
};

} // namespace boxwood
