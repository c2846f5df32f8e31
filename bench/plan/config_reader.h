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

using Names = TomlReader::Names;

/// What sweep files hold beyond names and numbers.
class ConfigReader : public TomlReader {
  public:
    using TomlReader::TomlReader;

    unsigned threads(const toml::node& node) const {
        if (node.is_string()) {
            name(node, "threads", {"all"});
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
        if (const std::string path = node.value_or(std::string()); path.ends_with(".toml"))
            return path;
        Names known = names_of(built_in_scenes());
        known.push_back(motion_scene);
        for (const SceneEntry& generator : scene_generators())
            if (!generator.reads_file)
                known.push_back(generator.name);
        return name(node, "scene", known);
    }

  private:
    /// "ploc", or with an optimizer after it "ploc+reinsertion".
    std::string builder_name(const toml::node& node) const {
        const std::string names = node.value_or(std::string());
        const std::size_t plus = names.find('+');
        if (!node.is_string() || plus == std::string::npos)
            return name(node, "builders", names_of(builders()));
        require_known(node, "builders", names.substr(0, plus), names_of(builders()));
        require_known(node, "optimizers", names.substr(plus + 1), names_of(optimizers()));
        return names;
    }
};

} // namespace boxwood::bench
