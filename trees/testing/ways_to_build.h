#pragma once

#include "trees/builder.h"

#include <string>
#include <vector>

namespace boxwood {

/// Each builder of the registry, alone and with each stage after it: words of `make_builder`.
inline std::vector<std::string> ways_to_build() {
    std::vector<std::string> ways;
    for (const BuilderEntry& builder : builders()) {
        ways.emplace_back(builder.name);
        for (const OptimizerEntry& stage : stages())
            ways.push_back(std::string(builder.name) + "+" + std::string(stage.name));
    }
    return ways;
}

} // namespace boxwood
