#include "scenes/robots/random_values.h"

#include "scenes/sampling/random.h"

#include <algorithm>

namespace boxwood {

void random_values(std::span<const ValueRange> ranges, std::uint64_t seed, std::uint64_t i,
                   std::span<double> values) {
    Draws draws = Random(seed, "robot").item(i);
    for (std::size_t k = 0; k < ranges.size(); ++k) {
        const auto& [lower, upper, wraps] = ranges[k];
        const double part = draws.uniform();
        values[k] = std::clamp((1 - part) * lower + part * upper, lower, upper);
    }
}

} // namespace boxwood
