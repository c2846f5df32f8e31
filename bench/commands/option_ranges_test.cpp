#include "bench/commands/option_ranges.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace boxwood::bench {
namespace {

/// Of an option that the check stands before.
template <class T> bool is_taken(const CLI::Validator& check, const std::string& text) {
    CLI::App app;
    T value{};
    app.add_option("--value", value)->check(check);
    try {
        app.parse("--value=" + text);
    } catch (const CLI::ParseError&) {
        return false;
    }
    return true;
}

TEST(OptionRanges, ASeedIsNeitherNegativeNorBeyondWhatAFileHolds) {
    for (const char* const seed : {"0", "1", "9223372036854775807"})
        EXPECT_TRUE(is_taken<std::uint64_t>(seed_range(), seed)) << seed;
    for (const char* const seed : {"-1", "9223372036854775808", "18446744073709551615", "one", ""})
        EXPECT_FALSE(is_taken<std::uint64_t>(seed_range(), seed)) << seed;
}

TEST(OptionRanges, ANumberLiesInItsRange) {
    for (const char* const number : {"0", "1", "0.5", "1e-300"})
        EXPECT_TRUE(is_taken<double>(number_range(0, 1), number)) << number;
    for (const char* const number : {"-1e-300", "1.5", "inf", "-inf", "nan", "-nan", "half"})
        EXPECT_FALSE(is_taken<double>(number_range(0, 1), number)) << number;
}

} // namespace
} // namespace boxwood::bench
