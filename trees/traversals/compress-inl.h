// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_COMPRESS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_COMPRESS_INL_H
#undef BOXWOOD_COMPRESS_INL_H
#else
#define BOXWOOD_COMPRESS_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// of[m]: which bits of m are set, one in each byte from the lowest on.
struct SetBits {
    std::uint64_t of[256];

    constexpr SetBits() : of{} {
        for (std::uint32_t m = 0; m < 256; ++m)
            for (std::uint32_t bit = 0, n = 0; bit < 8; ++bit)
                if (m >> bit & 1)
                    of[m] |= std::uint64_t{bit} << 8 * n++;
    }
};
inline constexpr SetBits set_bits;

/// The 32-bit lanes of a mask moved to the front in their order, then whatever. hwy::Compress where
/// an instruction does it; below AVX-512 that one has g++ copy its table, a local constexpr array
/// of 1 KiB, to the stack each time.
template <class D, class V, class M> HWY_INLINE V compressed([[maybe_unused]] D d, V v, M mask) {
    namespace hn = hwy::HWY_NAMESPACE;
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET > HWY_AVX3
    if constexpr (hn::MaxLanes(D()) >= 4) {
        const hn::Rebind<std::uint8_t, D> bytes;
        std::uint8_t bits[8];
        hn::StoreMaskBits(d, mask, bits);
        const auto* from = reinterpret_cast<const std::uint8_t*>(&set_bits.of[bits[0]]);
        const auto lanes = hn::PromoteTo(d, hn::LoadU(bytes, from));
        return hn::TableLookupLanes(v, hn::IndicesFromVec(d, lanes));
    }
#endif
    return hn::Compress(v, mask);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
