#include "scenes/hard_cases/dyadic.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace boxwood {
namespace {

/// m 2^exponent, m odd or 0.
struct Binary {
    std::vector<std::uint32_t> m; ///< least word first, no leading zeros
    long exponent = 0;

    long bits() const {
        return m.empty() ? 0 : 32 * static_cast<long>(m.size()) - std::countl_zero(m.back());
    }
};

std::optional<Binary> parsed(std::string_view digits) {
    if (digits.empty())
        return std::nullopt;
    Binary number;
    for (const char c : digits) {
        if (c < '0' || c > '9')
            return std::nullopt;
        std::uint64_t carry = static_cast<std::uint64_t>(c - '0');
        for (std::uint32_t& word : number.m) {
            carry += std::uint64_t{word} * 10;
            word = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        if (carry != 0)
            number.m.push_back(static_cast<std::uint32_t>(carry));
    }
    if (number.m.empty())
        return number;
    std::size_t zero_words = 0;
    while (number.m[zero_words] == 0)
        ++zero_words;
    number.m.erase(number.m.begin(), number.m.begin() + static_cast<std::ptrdiff_t>(zero_words));
    const int zeros = std::countr_zero(number.m[0]);
    for (std::size_t i = 0; i < number.m.size(); ++i) {
        const std::uint64_t above = i + 1 < number.m.size() ? number.m[i + 1] : 0;
        number.m[i] = static_cast<std::uint32_t>((above << 32 | number.m[i]) >> zeros);
    }
    if (number.m.back() == 0)
        number.m.pop_back();
    number.exponent = 32 * static_cast<long>(zero_words) + zeros;
    return number;
}

} // namespace

std::optional<double> dyadic(std::string_view numerator, std::string_view denominator) {
    const bool negative = numerator.starts_with('-');
    if (negative)
        numerator.remove_prefix(1);
    const std::optional<Binary> top = parsed(numerator), bottom = parsed(denominator);
    if (!top || !bottom || bottom->bits() != 1)
        return std::nullopt;
    const long exponent = top->exponent - bottom->exponent;
    if (top->m.empty())
        return 0.0;
    if (top->bits() > 53 || exponent < -1074 || top->bits() + exponent > 1024)
        return std::nullopt;
    const std::uint64_t m = top->m[0] | (top->m.size() > 1 ? std::uint64_t{top->m[1]} << 32 : 0);
    const double size = std::ldexp(static_cast<double>(m), static_cast<int>(exponent));
    return negative ? -size : size;
}

} // namespace boxwood
