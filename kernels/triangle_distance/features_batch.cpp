// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/triangle_distance/features_batch.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/simd/vec3-inl.h"
#include "kernels/triangle_distance/detail/nearest_pair.h"
#include "kernels/triangle_distance/features_batch.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, TrianglePairBlock<double>::lanes> df;
using Mask = hn::Mask<decltype(df)>;

struct Lanes {
    hn::Vec<decltype(df)> v;

    Lanes() = default;
    HWY_INLINE Lanes(hn::Vec<decltype(df)> values) : v(values) {}

    friend HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return {hn::Add(a.v, b.v)}; }
    friend HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return {hn::Sub(a.v, b.v)}; }
    friend HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return {hn::Mul(a.v, b.v)}; }
    friend HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return {hn::Div(a.v, b.v)}; }
    friend HWY_INLINE Lanes operator-(Lanes a) { return {hn::Neg(a.v)}; }
    friend HWY_INLINE Mask operator<(Lanes a, Lanes b) { return hn::Lt(a.v, b.v); }
    friend HWY_INLINE Mask operator<=(Lanes a, Lanes b) { return hn::Le(a.v, b.v); }
};

template <class V> struct Limits : detail::one_lane::Limits<double> {};
template <class V> HWY_INLINE V constant(double x) { return {hn::Set(df, x)}; }
HWY_INLINE Lanes select(Mask m, Lanes a, Lanes b) { return {hn::IfThenElse(m, a.v, b.v)}; }
HWY_INLINE Lanes min(Lanes a, Lanes b) { return {hn::Min(a.v, b.v)}; }
HWY_INLINE Lanes max(Lanes a, Lanes b) { return {hn::Max(a.v, b.v)}; }
HWY_INLINE Lanes abs(Lanes a) { return {hn::Abs(a.v)}; }
HWY_INLINE Mask both(Mask a, Mask b) { return hn::And(a, b); }
HWY_INLINE Mask either(Mask a, Mask b) { return hn::Or(a, b); }
HWY_INLINE Mask same(Mask a, Mask b) { return hn::Not(hn::Xor(a, b)); }
HWY_INLINE Mask negation(Mask a) { return hn::Not(a); }
HWY_INLINE bool any(Mask a) { return !hn::AllFalse(df, a); }
HWY_INLINE bool all(Mask a) { return hn::AllTrue(df, a); }

HWY_INLINE void reciprocals(Lanes (&x)[3]) {
    const Lanes p = x[0] * x[1], inverse = constant<Lanes>(1) / (p * x[2]), q = inverse * x[2];
    x[2] = inverse * p;
    const Lanes x0 = x[0];
    x[0] = q * x[1];
    x[1] = q * x0;
}

#define BOXWOOD_LANE HWY_INLINE
#include "kernels/triangle_distance/detail/nearest_features-inl.h"
#undef BOXWOOD_LANE

constexpr std::size_t width = TrianglePairBlock<double>::lanes;
constexpr std::size_t lanes = hn::MaxLanes(df);

/// Rows of coordinates, by side, corner and axis, `stride` lanes long.
template <std::size_t stride> using Rows = double[2][3][3][stride];

template <std::size_t stride>
HWY_INLINE LaneVec3<Lanes> load_corner(const double (&corner)[3][stride], std::size_t lane) {
    return {hn::LoadU(df, corner[0] + lane), hn::LoadU(df, corner[1] + lane),
            hn::LoadU(df, corner[2] + lane)};
}
template <std::size_t stride>
HWY_INLINE Shape<Lanes> load_shape(const double (&side)[3][3][stride], std::size_t lane) {
    return {load_corner(side[0], lane), load_corner(side[1], lane), load_corner(side[2], lane)};
}
HWY_INLINE std::uint32_t mask_bits(Mask m) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(df, m, bytes);
    return bytes[0];
}

/// The corners of a triangle from the one that is least along a way on, counted round.
struct Turned {
    LaneVec3<Lanes> c0, c1, c2;
    HWY_INLINE Turned(const Shape<Lanes>& t, const LaneVec3<Lanes>& way) : c0(), c1(), c2() {
        const Lanes zero = constant<Lanes>(0), x = dot(way, t.edge[0]), y = dot(way, t.edge[1]);
        const Mask third = y < min(x, zero), second = hn::AndNot(third, x < zero);
        const LaneVec3<Lanes>(&c)[3] = t.corner;
        c0 = select(third, c[2], select(second, c[1], c[0]));
        c1 = select(third, c[0], select(second, c[2], c[1]));
        c2 = select(third, c[1], select(second, c[0], c[2]));
    }
};

/// The pairs [lane, lane + lanes) of the rows by one guess, as NearestPairSearch makes it; true
/// where it was right.
template <std::size_t stride>
HWY_INLINE Mask guess(const Rows<stride>& rows, std::size_t lane, PointPair<Lanes>& pair) {
    const Shape<Lanes> a = load_shape(rows[0], lane), b = load_shape(rows[1], lane);
    const LaneVec3<Lanes> way =
        way_between(b.corner[0] - a.corner[0], a.edge[0], a.edge[1], b.edge[0], b.edge[1]);
    const Turned ta(a, way), tb(b, -way);
    return facing_edges<false>(ta.c0, ta.c1, ta.c2, tb.c0, tb.c1, tb.c2, pair);
}
/// ... by all features; true where they are in range.
template <std::size_t stride>
HWY_INLINE Mask compare(const Rows<stride>& rows, std::size_t lane, PointPair<Lanes>& pair) {
    const Shape<Lanes> a = load_shape(rows[0], lane), b = load_shape(rows[1], lane);
    const Facing<Lanes> facing(a, b);
    Best<Lanes> best;
    const Mask done = offer_crossing(facing, best);
    if (!all(done))
        offer_features<false>(facing, done, best);
    pair = best_pair(facing, best);
    return facing.in_range();
}

/// Answers of some lanes, to be handed out one by one. The rows are parts of Distance as it lies in
/// memory, so that one takes few stores.
class Answers {
  public:
    HWY_INLINE explicit Answers(const PointPair<Lanes>& pair) {
        const auto d = hn::Sqrt(pair.squared.v);
        hn::StoreInterleaved4(d, d, d, pair.a.x.v, df, head_[0]);
        hn::StoreInterleaved4(pair.a.y.v, pair.a.z.v, pair.b.x.v, pair.b.y.v, df, middle_[0]);
        hn::Store(pair.b.z.v, df, last_);
    }
    HWY_INLINE void hand_out(std::size_t i, Distance& to) const {
        static_assert(offsetof(Distance, hi) == 16 && offsetof(Distance, point_a) == 24 &&
                      offsetof(Distance, point_b) == 48 && std::is_trivially_copyable_v<Distance>);
        auto* const bytes = reinterpret_cast<unsigned char*>(&to);
        std::memcpy(bytes, head_[i], sizeof head_[i]);
        std::memcpy(bytes + sizeof head_[i], middle_[i], sizeof middle_[i]);
        to.point_b.z = last_[i];
        to.tier = 0;
    }

  private:
    HWY_ALIGN double head_[lanes][4];   // distance, lo, hi, point_a.x
    HWY_ALIGN double middle_[lanes][4]; // point_a.y, point_a.z, point_b.x, point_b.y
    HWY_ALIGN double last_[lanes];      // point_b.z
};

/// Pairs of which the guess was wrong, gathered so that they fill vectors.
class Pending {
  public:
    static constexpr std::size_t max_added =
        128; ///< pairs to be added between calls of answer_full

    explicit Pending(std::span<Distance> distances) : distances_(distances) {}

    /// Pairs first + i for each bit i, from lanes lane + i of the block.
    HWY_INLINE void add(const Rows<width>& block, std::size_t lane, std::uint32_t bits,
                        std::size_t first) {
        HWY_ALIGN std::int64_t order[lanes + 1]{}; // without a branch, which would be a toss-up
        std::size_t count = 0;
        for (std::size_t i = 0; i < lanes; ++i) {
            order[count] = static_cast<std::int64_t>(i);
            index_[count_ + count] = first + i;
            count += bits >> i & 1;
        }
        const auto indices = hn::SetTableIndices(df, order);
        for_each_row([&](std::size_t side, std::size_t corner, std::size_t axis) {
            const auto row = hn::Load(df, block[side][corner][axis] + lane);
            hn::StoreU(hn::TableLookupLanes(row, indices), df, rows_[side][corner][axis] + count_);
        });
        count_ += count;
    }
    /// Answers all but fewer than a vector, which stay.
    HWY_INLINE void answer_full() {
        std::size_t begin = 0;
        for (; begin + lanes <= count_; begin += lanes)
            answer(begin, lanes);
        for_each_row([&](std::size_t side, std::size_t corner, std::size_t axis) {
            double* const row = rows_[side][corner][axis];
            hn::StoreU(hn::LoadU(df, row + begin), df, row);
        });
        std::copy(index_ + begin, index_ + count_, index_);
        count_ -= begin;
    }
    void finish() {
        if (count_ > 0)
            answer(0, count_);
    }

  private:
    template <class F> static HWY_INLINE void for_each_row(F f) {
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t corner = 0; corner < 3; ++corner)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    f(side, corner, axis);
    }
    HWY_INLINE void answer(std::size_t begin, std::size_t count) {
        PointPair<Lanes> pair;
        const std::uint32_t in_range = mask_bits(compare(rows_, begin, pair));
        const Answers answers(pair);
        for (std::size_t i = 0; i < count; ++i) {
            Distance& to = distances_[index_[begin + i]];
            answers.hand_out(i, to);
            if ((in_range >> i & 1) == 0) [[unlikely]]
                to = alone(begin + i);
        }
    }
    Distance alone(std::size_t i) const {
        const auto corner = [&](std::size_t side, std::size_t k) {
            const auto& c = rows_[side][k];
            return Vec3<double>{c[0][i], c[1][i], c[2][i]};
        };
        return FeaturesF64Batch::distance({corner(0, 0), corner(0, 1), corner(0, 2)},
                                          {corner(1, 0), corner(1, 1), corner(1, 2)});
    }

    std::span<Distance> distances_;
    Rows<max_added + 2 * lanes>
        rows_{}; // what stays, `max_added`, and the rest of the last vector stored
    std::size_t index_[max_added + 2 * lanes]{};
    std::size_t count_ = 0;
};

/// A single block, without what many need to gather.
void distances_of_one(const TrianglePairBlock<double>& block, std::span<Distance> distances) {
    for (std::size_t lane = 0; lane < distances.size(); lane += lanes) {
        const std::size_t count = std::min(lanes, distances.size() - lane);
        const std::uint32_t used = (1u << count) - 1;
        PointPair<Lanes> pair;
        std::uint32_t wrong = ~mask_bits(guess(block.corner, lane, pair)) & used;
        const Answers answers(pair);
        for (std::size_t i = 0; i < count; ++i)
            answers.hand_out(i, distances[lane + i]);
        if (wrong == 0)
            continue;
        const std::uint32_t in_range = mask_bits(compare(block.corner, lane, pair));
        const Answers compared(pair);
        for (; wrong != 0; wrong &= wrong - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(wrong));
            if ((in_range >> i & 1) != 0) [[likely]]
                compared.hand_out(i, distances[lane + i]);
            else
                distances[lane + i] = FeaturesF64Batch::distance(block.triangle(0, lane + i),
                                                                 block.triangle(1, lane + i));
        }
    }
}

void distances_of(std::span<const TrianglePairBlock<double>> blocks,
                  std::span<Distance> distances) {
    if (distances.size() <= width) {
        if (!distances.empty())
            distances_of_one(blocks.front(), distances);
        return;
    }
    Pending pending(distances);
    std::uint32_t wrong[Pending::max_added / lanes];
    for (std::size_t begin = 0; begin < distances.size(); begin += Pending::max_added) {
        const std::size_t end = std::min(begin + Pending::max_added, distances.size());
        for (std::size_t first = begin; first < end; first += lanes) {
            const std::size_t count = std::min(lanes, end - first);
            PointPair<Lanes> pair;
            const Mask right = guess(blocks[first / width].corner, first % width, pair);
            wrong[(first - begin) / lanes] = ~mask_bits(right) & ((1u << count) - 1);
            const Answers answers(pair);
            for (std::size_t i = 0; i < count; ++i)
                answers.hand_out(i, distances[first + i]);
        }
        for (std::size_t first = begin; first < end; first += lanes)
            if (const std::uint32_t bits = wrong[(first - begin) / lanes])
                pending.add(blocks[first / width].corner, first % width, bits, first);
        pending.answer_full();
    }
    pending.finish();
}

} // namespace
} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(distances_of);

Distance FeaturesF64Batch::distance(const Triangle<double>& a, const Triangle<double>& b) {
    return detail::measured<&detail::NearestPairSearch<double, false>::find_by_one_guess>(a, b);
}

void FeaturesF64Batch::distance(std::span<const TrianglePairBlock<double>> blocks,
                                std::span<Distance> distances) {
    HWY_DYNAMIC_DISPATCH(distances_of)(blocks, distances);
}

} // namespace boxwood
#endif
