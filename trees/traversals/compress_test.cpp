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

/// The numbers that a mask of 16 lanes leaves, of registers of at most `max_lanes` lanes.
template <std::size_t max_lanes> std::vector<std::uint32_t> left(std::uint32_t mask) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<std::uint32_t, max_lanes> d;
    const std::size_t lanes = hn::Lanes(d);
    alignas(64) std::array<std::uint32_t, 32> to{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < 16; i += lanes) {
        const std::uint32_t part = mask >> i;
        const std::uint8_t bits[8] = {static_cast<std::uint8_t>(part),
                                      static_cast<std::uint8_t>(part >> 8)};
        const auto hits = hn::LoadMaskBits(d, bits);
        const auto numbers = hn::Iota(d, static_cast<std::uint32_t>(1000 + i));
        hn::StoreU(compressed(d, numbers, hits), d, to.data() + n);
        n += hn::CountTrue(d, hits);
    }
    return {to.begin(), to.begin() + static_cast<std::ptrdiff_t>(n)};
}
std::vector<std::uint32_t> left_of_4(std::uint32_t mask) { return left<4>(mask); }
std::vector<std::uint32_t> left_of_8(std::uint32_t mask) { return left<8>(mask); }
std::vector<std::uint32_t> left_of_16(std::uint32_t mask) { return left<16>(mask); }

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
using namespace detail;
HWY_EXPORT(left_of_4);
HWY_EXPORT(left_of_8);
HWY_EXPORT(left_of_16);
namespace {

TEST(Compress, LeavesTheLanesOfEveryMaskInTheirOrderOnEveryInstructionSet) {
    on_every_target([] {
        for (std::uint32_t mask = 0; mask < 1 << 16; ++mask) {
            std::vector<std::uint32_t> expected;
            for (std::uint32_t i = 0; i < 16; ++i)
                if (mask >> i & 1)
                    expected.push_back(1000 + i);
            ASSERT_EQ(HWY_DYNAMIC_DISPATCH(left_of_4)(mask), expected);
            ASSERT_EQ(HWY_DYNAMIC_DISPATCH(left_of_8)(mask), expected);
            ASSERT_EQ(HWY_DYNAMIC_DISPATCH(left_of_16)(mask), expected);
        }
    });
}

} // namespace
} // namespace boxwood
#endif
