#include "scenes/effects/read_effect.h"

#include "scenes/effects/effect.h"

#include <string>
#include <tuple>

namespace boxwood {

EffectChoice read_effect(const TomlReader& reader, const toml::node& node) {
    EffectChoice choice;
    std::tie(choice.name, choice.settings) = reader.with_settings(
        node, "an effect",
        [&](const toml::node& name) { return reader.name(name, "effects", names_of(effects())); },
        [](const std::string& name, const Settings& settings) { effect_of(name).make(settings); },
        [&](std::string_view key, const toml::node& value) {
            if (key != "share")
                return false;
            choice.share = reader.number(value, "share", 0, 1);
            return true;
        });
    return choice;
}

} // namespace boxwood
