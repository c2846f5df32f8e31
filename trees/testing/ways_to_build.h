#pragma once

#include "trees/builder.h"

#include <string>
#include <vector>

namespace boxwood {

/// A builder, alone and with each optimizer after it: names for `make_builder`.
inline std::vector<std::string> ways_to_build(const BuilderEntry& builder) {
    std::vector<std::string> ways{std::string(builder.name)};
    for (const OptimizerEntry& optimizer : optimizers())
        ways.push_back(std::string(builder.name) + "+" + std::string(optimizer.name));
    return ways;
}

/// Those of each builder of the registry.
inline std::vector<std::string> ways_to_build() {
    std::vector<std::string> all;
    for (const BuilderEntry& builder : builders())
        for (std::string& way : ways_to_build(builder))
            all.push_back(std::move(way));
    return all;
}

} // namespace boxwood
