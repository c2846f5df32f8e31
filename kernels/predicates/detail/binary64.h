#pragma once

#include <bit>
#include <cstdint>

namespace boxwood::detail {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

/// A finite double read by its bits, as (-1)^negative * mantissa * 2^(weight - 1074): no
/// floating-point mode changes it. mantissa < 2^53; weight 0 .. 2045, zero has weight 0.
struct Binary64 {
    std::uint64_t mantissa;
    int weight;
    bool negative;

    explicit Binary64(double x) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
        constexpr std::uint64_t hidden = std::uint64_t{1} << 52;
        mantissa = (bits & (hidden - 1)) | (exponent > 0 ? hidden : 0);
        weight = exponent > 0 ? exponent - 1 : 0;
        negative = bits >> 63 != 0;
    }
};

/// By its bits, so that no mode and no optimisation about NaN gets in the way.
inline bool is_finite_bits(double x) {
    constexpr std::uint64_t infinite = std::uint64_t{0x7ff} << 52;
    return (std::bit_cast<std::uint64_t>(x) & infinite) != infinite;
}

/// x == y of numbers that are not NaN, by their bits: flushed denormals would all be equal.
inline bool is_same_number_bits(double x, double y) {
    const auto a = std::bit_cast<std::uint64_t>(x), b = std::bit_cast<std::uint64_t>(y);
    return a == b || (a | b) << 1 == 0;
}

} // namespace boxwood::detail
