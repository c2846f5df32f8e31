#pragma once

#include <cstdio>
#include <string_view>

namespace boxwood::bench {

/// Writes to stderr. One that is full or closed loses the text and nothing else: fmt::print would
/// throw.
inline void say(std::string_view text) noexcept {
    std::fwrite(text.data(), 1, text.size(), stderr);
}

} // namespace boxwood::bench
