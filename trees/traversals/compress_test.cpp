// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/compress_test.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/testing/every_target.h"
#include "trees/traversals/compress-inl.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// The numbers that a mask of 16 lanes leaves, of registers of at most `most` lanes.
template <std::size_t most> std::vector<std::uint32_t> Left(std::uint32_t mask) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<std::uint32_t, most> d;
    const std::size_t lanes = hn::Lanes(d);
    alignas(64) std::array<std::uint32_t, 32> to{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < 16; i += lanes) {
        const std::uint32_t part = mask >> i;
        const std::uint8_t bits[8] = {static_cast<std::uint8_t>(part),
                                      static_cast<std::uint8_t>(part >> 8)};
        const auto hits = hn::LoadMaskBits(d, bits);
        const auto numbers = hn::Iota(d, static_cast<std::uint32_t>(1000 + i));
        hn::StoreU(Compressed(d, numbers, hits), d, to.data() + n);
        n += hn::CountTrue(d, hits);
    }
    return {to.begin(), to.begin() + static_cast<std::ptrdiff_t>(n)};
}
std::vector<std::uint32_t> LeftOf4(std::uint32_t mask) { return Left<4>(mask); }
std::vector<std::uint32_t> LeftOf8(std::uint32_t mask) { return Left<8>(mask); }
std::vector<std::uint32_t> LeftOf16(std::uint32_t mask) { return Left<16>(mask); }

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
using namespace detail;
HWY_EXPORT(LeftOf4);
HWY_EXPORT(LeftOf8);
HWY_EXPORT(LeftOf16);
namespace {

TEST(Compress, LeavesTheLanesOfEveryMaskInTheirOrderOnEveryInstructionSet) {
    on_every_target([] {
        for (std::uint32_t mask = 0; mask < 1 << 16; ++mask) {
            std::vector<std::uint32_t> expected;
            for (std::uint32_t i = 0; i < 16; ++i)
                if (mask >> i & 1)
                    expected.push_back(1000 + i);
            ASSERT_EQ(HWY_DYNAMIC_DISPATCH(LeftOf4)(mask), expected);
            ASSERT_EQ(HWY_DYNAMIC_DISPATCH(LeftOf8)(mask), expected);
            ASSERT_EQ(HWY_DYNAMIC_DISPATCH(LeftOf16)(mask), expected);
        }
    });
}

} // namespace
} // namespace boxwood
#endif
