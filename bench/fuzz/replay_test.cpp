#include "bench/fuzz/fuzz.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace boxwood::fuzz {
namespace {

struct Target {
    std::string_view name;
    void (*run)(Bytes);
};
#define BOXWOOD_FUZZ_TARGET(name) {#name, name},
const Target targets[]{BOXWOOD_FUZZ_TARGETS(BOXWOOD_FUZZ_TARGET)};
#undef BOXWOOD_FUZZ_TARGET

class Fuzz : public testing::TestWithParam<Target> {};

/// The inputs of scripts/fuzz: what it started from, and what it once found.
TEST_P(Fuzz, FindsNothingInItsCorpus) {
    std::size_t n = 0;
    const std::filesystem::path folder =
        std::filesystem::path("bench/fuzz/corpus") / GetParam().name;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream in(entry.path(), std::ios::binary);
        const std::vector<char> bytes(std::istreambuf_iterator<char>(in), {});
        SCOPED_TRACE(entry.path());
        EXPECT_NO_THROW(
            GetParam().run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
        ++n;
    }
    EXPECT_GT(n, 5u);
}

INSTANTIATE_TEST_SUITE_P(Target, Fuzz, testing::ValuesIn(targets),
                         [](const auto& target) { return std::string(target.param.name); });

} // namespace
} // namespace boxwood::fuzz
