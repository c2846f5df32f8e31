#pragma once

#include <cstdint>

namespace boxwood::detail {

/// Two numbers in one register, and the same number of bits for what comparisons answer.
template <class Real> struct TwoOf;
template <> struct TwoOf<double> {
    using Bit = std::int64_t;
    using Values [[gnu::vector_size(16)]] = double;
    using Bits [[gnu::vector_size(16)]] = Bit;
    using Unsigned [[gnu::vector_size(16)]] = std::uint64_t;
};
template <> struct TwoOf<float> {
    using Bit = std::int32_t;
    using Values [[gnu::vector_size(8)]] = float;
    using Bits [[gnu::vector_size(8)]] = Bit;
};

} // namespace boxwood::detail
