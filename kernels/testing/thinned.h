#pragma once

namespace boxwood::testing {

/// Rationals allocate, which the address sanitizer makes 100 times slower: one case of this many is
/// then tried.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr int thinned = 16;
#else
inline constexpr int thinned = 1;
#endif

} // namespace boxwood::testing
