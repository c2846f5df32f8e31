#pragma once

#include <optional>
#include <string_view>

namespace boxwood {

/// The fraction of two decimal integers of any length, as the double that it is: exactly.
/// Nothing if it isn't one: no integers, a denominator that is no positive power of two, more than
/// 53 bits, or out of range.
std::optional<double> dyadic(std::string_view numerator, std::string_view denominator);

} // namespace boxwood
