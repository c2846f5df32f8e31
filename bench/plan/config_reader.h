#pragma once

#include "bench/plan/block_reader.h"
#include "scenes/effects/read_effect.h"
#include "scenes/moving/toml_reader.h"
#include "scenes/scene.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace boxwood::bench {

using Words = TomlReader::Words;

/// What sweep files hold beyond words and numbers.
class ConfigReader : public TomlReader {
  public:
    using TomlReader::TomlReader;

    unsigned threads(const toml::node& node) const {
        if (node.is_string()) {
            word(node, "threads", {"all"});
            return std::max(1u, std::thread::hardware_concurrency());
        }
        return static_cast<unsigned>(whole(node, "threads", 1, 1024));
    }

    /// A builder: its names, or `{name = "binned_sah", bins = 16}`.
    BuilderChoice builder(const toml::node& node) const {
        return choice(
            node, "a builder", [&](const toml::node& name) { return builder_name(name); },
            [](const std::string& name, const Settings& settings) {
                make_builder(name, settings);
            });
    }

    /// "refit", or `{name = "rebuild", trigger = 1.3}`.
    template <class Read, class TryOut>
    BuilderChoice choice(const toml::node& node, std::string_view what, Read read,
                         TryOut try_out) const {
        auto [name, settings] = with_settings(node, what, read, try_out,
                                              [](std::string_view, const auto&) { return false; });
        return {std::move(name), std::move(settings)};
    }

    /// Effects that are laid together: one, or a list of them.
    std::vector<EffectChoice> effects(const toml::node& node) const {
        if (const toml::array* together = node.as_array()) {
            std::vector<EffectChoice> all;
            for (const toml::node& effect : *together)
                all.push_back(read_effect(*this, effect));
            return all;
        }
        return {read_effect(*this, node)};
    }

    /// A generator, a built-in moving scene, or the path of a scene file.
    std::string moving_scene(const toml::node& node) const {
        const std::string name = node.value_or(std::string());
        if (node.is_string() && name.ends_with(".toml"))
            return name;
        Words known = names_of(built_in_scenes());
        for (const SceneEntry& generator : scene_generators())
            if (!generator.reads_file)
                known.push_back(generator.name);
        return word(node, "scene", known);
    }

  private:
    /// "ploc", or with an optimizer after it "ploc+reinsertion".
    std::string builder_name(const toml::node& node) const {
        const std::string words = node.value_or(std::string());
        const std::size_t plus = words.find('+');
        if (!node.is_string() || plus == std::string::npos)
            return word(node, "builders", names_of(builders()));
        require_known(node, "builders", words.substr(0, plus), names_of(builders()));
        require_known(node, "optimizers", words.substr(plus + 1), names_of(optimizers()));
        return words;
    }
};

} // namespace boxwood::bench
