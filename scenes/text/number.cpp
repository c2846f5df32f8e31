#include "scenes/text/number.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

namespace boxwood {

NumberFault parse_number(std::string_view text, double& value) {
    bool negative = false;
    if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
        negative = text.front() == '-';
        text.remove_prefix(1);
    }
    const bool hex = text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    if (hex)
        text.remove_prefix(2);
    if (text.empty() || text.front() == '+' || text.front() == '-') // from_chars would take -
        return NumberFault::not_a_number;

    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(
        text.data(), end, value, hex ? std::chars_format::hex : std::chars_format::general);
    if (error == std::errc::invalid_argument || stop != end)
        return NumberFault::not_a_number;
    if (error == std::errc::result_out_of_range) {
        // from_chars leaves the value alone, be it too large or too small; strtod tells which, and
        // rounds what is small to a subnormal or zero. No locale is ever set.
        value = std::strtod(((hex ? "0x" : "") + std::string(text)).c_str(), nullptr);
        if (std::isinf(value))
            return NumberFault::too_large;
    }
    if (negative)
        value = -value;
    return NumberFault::none;
}

} // namespace boxwood
