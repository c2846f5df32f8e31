#pragma once

#include "bench/peers/answering.h"
#include "bench/peers/managers.h"

namespace boxwood::bench {

/// Coal's managers of broad phases; trees in Morton order, or split at the median.
enum class CoalManager : std::uint8_t {
    tree,
    tree_median,
    tree_array,
    tree_array_median,
    sap,
    ssap,
    hash,
    interval_tree
};

/// Coal's answers about two triangles.
enum class CoalKernel : std::uint8_t { collide, collide_with_contact, distance };

/// The library behind a door: a module that is opened when a contender is made. In one process with
/// FCL's package two octomaps would meet under the same names, and the program end in a double
/// free.
struct CoalModule {
    std::unique_ptr<Contender> (*manager)(const Job&, Sides, CoalManager, Reported);
    std::unique_ptr<Contender> (*kernel)(const Job&, CoalKernel);
};

/// The module has `extern "C" const CoalModule boxwood_coal`.
inline constexpr const char* coal_module_symbol = "boxwood_coal";

} // namespace boxwood::bench
