#pragma once

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace boxwood::bench {

/// A seed, as a result file holds it: without this, -1 would be read as 2^64 - 1.
inline CLI::Range seed_range() {
    return {std::uint64_t{0}, std::uint64_t{std::numeric_limits<std::int64_t>::max()}};
}

/// A number from `lowest` to `highest`: CLI::Range lets NaN pass.
inline CLI::Validator number_range(double lowest, double highest) {
    CLI::Range range(lowest, highest);
    return CLI::Validator(
        [range](std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && std::isnan(value)
                       ? text + " is not a number"
                       : range(text);
        },
        range.get_description());
}

} // namespace boxwood::bench
