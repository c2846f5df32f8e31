#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// UTF-8 text as a JSON string, in quotes (RFC 8259, section 7).
inline std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            (out += '\\') += c;
        else if (c == '\n')
            out += "\\n";
        else if (c == '\t')
            out += "\\t";
        else if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out += c;
    }
    return out += '"';
}

/// Each of these texts so.
inline std::vector<std::string> json_strings(const auto& texts) {
    std::vector<std::string> strings;
    for (const std::string& text : texts)
        strings.push_back(json_string(text));
    return strings;
}

/// A number in shortest round-trip form; JSON has no NaN or infinity, they become null.
template <class Real> std::string json_number(Real value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

} // namespace boxwood::bench
