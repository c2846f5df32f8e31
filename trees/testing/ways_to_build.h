#pragma once

#include "trees/builder.h"

#include <string>
#include <vector>

namespace boxwood {

/// Each builder of the registry, alone and with each optimizer after it: names for `make_builder`.
inline std::vector<std::string> ways_to_build() {
    std::vector<std::string> ways;
    for (const BuilderEntry& builder : builders()) {
        ways.emplace_back(builder.name);
        for (const OptimizerEntry& optimizer : optimizers())
            ways.push_back(std::string(builder.name) + "+" + std::string(optimizer.name));
    }
    return ways;
}

} // namespace boxwood
