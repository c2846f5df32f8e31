#pragma once

#include <cstdint>
#include <string_view>

namespace boxwood {

enum class NumberFault : std::uint8_t { none, not_a_number, too_large };

/// Reads all of a text as one number, decimal (1, +2.5, 1e-3, inf, nan) or hex float (0x1.8p-3),
/// rounded to nearest: what is small becomes subnormal or zero, what is beyond all doubles is
/// too_large. `value` is unspecified unless the fault is none.
NumberFault parse_number(std::string_view text, double& value);

} // namespace boxwood
