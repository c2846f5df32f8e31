#include "scenes/atom.h"

#include <array>
#include <charconv>
#include <cmath>

namespace boxwood {

std::string atom(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const bool upper = c >= 'A' && c <= 'Z';
        if (upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
            result += upper ? static_cast<char>(c - 'A' + 'a') : c;
        else if (!result.empty() && result.back() != '_')
            result += '_';
    }
    if (!result.empty() && result.back() == '_')
        result.pop_back();
    return result.empty() ? "file" : result;
}

std::string atom(double x) {
    std::array<char, 400> digits; // a double has at most 309 before and 324 + 17 behind the point
    const auto end =
        std::to_chars(digits.begin(), digits.end(), std::abs(x), std::chars_format::fixed).ptr;
    return (x < 0 ? "m" : "") + atom(std::string_view(digits.begin(), end));
}

} // namespace boxwood
