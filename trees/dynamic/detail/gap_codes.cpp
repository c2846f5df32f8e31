// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/dynamic/detail/gap_codes.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/dynamic/detail/gap_codes.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
constexpr std::size_t lanes = hn::MaxLanes(df);

using F = hn::Vec<decltype(df)>;

/// The pairs' boxes lie anywhere: gathered, as many misses as can be are under way at a time.
void gap_codes(const Pair* pairs, std::size_t words, std::size_t n, const Box* boxes,
               GapScale scale, std::uint32_t* HWY_RESTRICT codes) {
    const auto* const items = reinterpret_cast<const std::int32_t*>(pairs);
    const float* const planes = reinterpret_cast<const float*>(boxes);
    const auto apart = hn::Mul(hn::Iota(di, 0), hn::Set(di, static_cast<std::int32_t>(words)));
    const auto begin = hn::Set(df, scale.begin), per_gap = hn::Set(df, scale.per_gap),
               flushed = hn::Set(df, 4 * FLT_MIN), taken_off = hn::Set(df, 0x1p-10f),
               last = hn::Set(df, float{GapScale::last}), zero = hn::Zero(df);
    std::size_t i = 0;
    for (; i + lanes <= n; i += lanes) {
        const auto place = [&](std::size_t side) HWY_ATTR {
            return hn::Mul(hn::GatherIndex(di, items + i * words + side, apart), hn::Set(di, 6));
        };
        const auto a = place(0), b = place(1);
        F gap = zero;
        auto meet = hn::Eq(zero, zero);
        for (int axis = 0; axis < 3; ++axis) {
            const F low = hn::Max(hn::GatherIndex(df, planes + axis, a),
                                  hn::GatherIndex(df, planes + axis, b));
            const F high = hn::Min(hn::GatherIndex(df, planes + 3 + axis, a),
                                   hn::GatherIndex(df, planes + 3 + axis, b));
            meet = hn::And(meet, hn::Le(low, high));
            const F along = hn::Sub(low, high);
            gap = axis == 0 ? along : hn::Max(gap, along);
        }
        const F sure = hn::Max(hn::Sub(hn::Abs(gap), flushed), zero);
        const F at = hn::Min(hn::Sub(hn::Add(begin, hn::Mul(sure, per_gap)), taken_off), last);
        const auto bucket = hn::BitCast(du, hn::ConvertTo(di, hn::Max(at, zero)));
        const auto bit = hn::IfThenElseZero(hn::RebindMask(du, meet),
                                            hn::Set(du, std::uint32_t{GapScale::overlap}));
        hn::StoreU(hn::Or(bucket, bit), du, codes + i);
    }
    for (; i < n; ++i)
        codes[i] = scale.code(boxes[items[i * words]], boxes[items[i * words + 1]]);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(gap_codes);

void gap_codes(const Pair* pairs, std::size_t words, std::size_t n, const Box* boxes,
               GapScale scale, std::uint32_t* codes) {
    HWY_DYNAMIC_DISPATCH(gap_codes)(pairs, words, n, boxes, scale, codes);
}

} // namespace boxwood::detail
#endif
