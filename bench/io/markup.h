#pragma once

#include <string>
#include <string_view>

namespace boxwood::bench {

/// A text as it may stand in SVG.
inline std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text)
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return out;
}

} // namespace boxwood::bench
