#pragma once

#include <CLI/CLI.hpp>
#include <fmt/format.h>

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
    const std::string range = fmt::format("a number from {} to {}", lowest, highest);
    return CLI::Validator(
        [=](std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && lowest <= value && value <= highest
                       ? std::string()
                       : fmt::format("{} is not {}", text, range);
        },
        range);
}

} // namespace boxwood::bench
