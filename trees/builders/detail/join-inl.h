// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_JOIN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_JOIN_INL_H
#undef BOXWOOD_JOIN_INL_H
#else
#define BOXWOOD_JOIN_INL_H
#endif

#include <hwy/highway.h>

#include "trees/builders/detail/prim8-inl.h"
#include "trees/tree.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// Where a subtree goes: its first node and its first slot.
struct Place {
    std::uint32_t node, first;
};

/// Clusters of items, each in one of sixteen lanes: max x, y, z and -min x, y, z. A lane that holds
/// none is far from all others.
struct alignas(64) Clusters {
    float plane[6][16];
};
inline constexpr float kFar = 0x1p62f;

/// For each lane below `alive`: how far the nearest other cluster is, with the exclusive or of the
/// two lanes in the last four bits. Two clusters are as far apart as the half area of their union.
HWY_INLINE void find_nearest(const Clusters& clusters, std::uint32_t alive, std::uint32_t* key) {
    namespace hn = hwy::HWY_NAMESPACE;
    constexpr hn::CappedTag<float, 16> df;
    constexpr hn::CappedTag<std::uint32_t, 16> du;
    const auto& plane = clusters.plane;
    const auto none = hn::Set(du, ~std::uint32_t{0}), low_bits = hn::Set(du, 15);
    for (std::size_t from = 0; from < alive; from += hn::Lanes(df)) {
        const auto lane = hn::Iota(du, static_cast<std::uint32_t>(from));
        const auto x = hn::Load(df, plane[0] + from), y = hn::Load(df, plane[1] + from),
                   z = hn::Load(df, plane[2] + from), u = hn::Load(df, plane[3] + from),
                   v = hn::Load(df, plane[4] + from), w = hn::Load(df, plane[5] + from);
        auto best = none;
        const auto compare = [&](std::uint32_t i) HWY_ATTR {
            const auto ex =
                hn::Add(hn::Max(x, hn::Set(df, plane[0][i])), hn::Max(u, hn::Set(df, plane[3][i])));
            const auto ey =
                hn::Add(hn::Max(y, hn::Set(df, plane[1][i])), hn::Max(v, hn::Set(df, plane[4][i])));
            const auto ez =
                hn::Add(hn::Max(z, hn::Set(df, plane[2][i])), hn::Max(w, hn::Set(df, plane[5][i])));
            const auto area = hn::Add(hn::Mul(ex, ey), hn::Mul(ez, hn::Add(ex, ey)));
            // Areas are not negative, so their bits have their order; the last four give way.
            const auto which = hn::Xor(lane, hn::Set(du, i));
            const auto far = hn::Or(hn::AndNot(low_bits, hn::BitCast(du, area)), which);
            best = hn::Min(best, hn::IfThenElse(hn::Eq(which, hn::Zero(du)), none, far));
        };
        // Four at a time: a loop of less regular length ends in a misprediction.
        for (std::uint32_t i = 0; i < alive; i += 4) {
            compare(i);
            compare(i + 1);
            compare(i + 2);
            compare(i + 3);
        }
        hn::Store(best, du, key + from);
    }
}

/// Lane k becomes the union of lanes a[k] and b[k], for k < n; the others are emptied.
HWY_INLINE void unite(Clusters& clusters, const std::uint32_t* a, const std::uint32_t* b,
                      std::uint32_t n) {
    namespace hn = hwy::HWY_NAMESPACE;
#if HWY_MAX_BYTES >= 64 && !HWY_HAVE_SCALABLE
    constexpr hn::FixedTag<float, 16> d;
    constexpr hn::FixedTag<std::uint32_t, 16> du;
    const auto ia = hn::IndicesFromVec(d, hn::Load(du, a)),
               ib = hn::IndicesFromVec(d, hn::Load(du, b));
    const auto used = hn::FirstN(d, n);
    for (auto& plane : clusters.plane) {
        const auto v = hn::Load(d, plane);
        const auto united = hn::Max(hn::TableLookupLanes(v, ia), hn::TableLookupLanes(v, ib));
        hn::Store(hn::IfThenElse(used, united, hn::Set(d, kFar)), d, plane);
    }
#else
    for (auto& plane : clusters.plane) {
        float united[16];
        for (std::uint32_t k = 0; k < 16; ++k)
            united[k] = k >= n ? kFar : std::max(plane[a[k]], plane[b[k]]);
        std::copy_n(united, 16, plane);
    }
#endif
}

/// Builds the subtree of 1 to 16 items bottom-up: in each round all pairs that are each other's
/// nearest become one, which gives the same tree as always joining the nearest pair of all. Edges
/// are lengthened by `edge` so that points on a line have an area too. Ties go by the exclusive or
/// of the lanes, which pairs equal boxes evenly and makes at least one pair per round.
HWY_INLINE void join(const Prim8* prims, std::uint32_t n, float edge, Place place, Tree& tree) {
    Clusters clusters;
    alignas(32) float box[31][8]; // of the items 0 .. n - 1, and of what is agglomerated in order
    alignas(64) std::uint32_t key[16], a[16] = {}, b[16] = {};
    std::uint32_t id[16], left[32], right[32], count[32];
    for (std::uint32_t i = 0; i < 16; ++i) {
        const bool used = i < n;
        const Prim8& p = prims[used ? i : 0];
        for (int axis = 0; axis < 3; ++axis) {
            clusters.plane[axis][i] = used ? p.v[axis] : kFar;
            clusters.plane[3 + axis][i] = used ? p.v[4 + axis] + edge : kFar;
        }
        store_f8(load_f8(p.v), box[i]);
        id[i] = i;
        count[i] = 1;
    }
    std::uint32_t next = n, alive = n;
    while (alive > 2) {
        find_nearest(clusters, alive, key);
        std::uint32_t kept = 0;
        for (std::uint32_t c = 0; c < alive; ++c) {
            const std::uint32_t other = c ^ (key[c] & 15);
            const std::uint32_t own = id[c];
            // Without branches: they would be mispredicted. All ones or none.
            const std::uint32_t mutual = 0u - (key[c] == key[other]),
                                joins = mutual & (0u - (other > c));
            left[next] = own;
            right[next] = id[other];
            a[kept] = c;
            b[kept] = c ^ (key[c] & 15 & joins);
            id[kept] = own ^ ((own ^ next) & joins);
            next -= joins;
            kept += 1 + (mutual & ~joins);
        }
        alive = kept;
        unite(clusters, a, b, alive);
    }
    if (n > 1) {
        left[next] = id[0];
        right[next] = id[1];
    }
    for (std::uint32_t i = n; i < 2 * n - 1; ++i) {
        count[i] = count[left[i]] + count[right[i]];
        store_f8(max_f8(load_f8(box[left[i]]), load_f8(box[right[i]])), box[i]);
    }

    // Parents have higher numbers than their children.
    Place at[31];
    at[2 * n - 2] = place;
    for (std::uint32_t i = 2 * n - 1; i-- > n;) {
        const std::uint32_t n_left = count[left[i]];
        at[left[i]] = {at[i].node + 1, at[i].first};
        at[right[i]] = {at[i].node + 2 * n_left, at[i].first + n_left};
        write_node(load_f8(box[i]), at[i].first, count[i], tree.nodes[at[i].node]);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        write_node(load_f8(box[i]), at[i].first, 1, tree.nodes[at[i].node]);
        tree.order[at[i].first] = prims[i].item();
    }
}

/// The nodes of a subtree of n items that are halved again and again, in the order of the tree.
struct Halving {
    std::uint8_t first[31], count[31];

    constexpr explicit Halving(unsigned n) : first{}, count{} {
        count[0] = static_cast<std::uint8_t>(n);
        for (unsigned i = 0; i + 1 < 2 * n; ++i) {
            if (count[i] < 2)
                continue;
            const unsigned left = count[i] / 2u, right = i + 2 * left;
            count[i + 1] = static_cast<std::uint8_t>(left);
            count[right] = static_cast<std::uint8_t>(count[i] - left);
            first[i + 1] = first[i];
            first[right] = static_cast<std::uint8_t>(first[i] + left);
        }
    }
};

/// Builds the subtree of 1 to 16 items without a look at where they are.
HWY_INLINE void halve_as_they_lie(const Prim8* prims, std::uint32_t n, Place place, Tree& tree) {
    static constexpr Halving halvings[] = {
        Halving(1),  Halving(1),  Halving(2),  Halving(3),  Halving(4),  Halving(5),
        Halving(6),  Halving(7),  Halving(8),  Halving(9),  Halving(10), Halving(11),
        Halving(12), Halving(13), Halving(14), Halving(15), Halving(16)};
    const Halving& halving = halvings[n];
    alignas(32) float box[31][8];
    for (std::uint32_t i = 2 * n - 1; i-- > 0;) {
        const std::uint32_t first = halving.first[i], count = halving.count[i];
        F8 whole;
        if (count == 1) {
            whole = load_f8(prims[first].v);
            tree.order[place.first + first] = prims[first].item();
        } else {
            whole = max_f8(load_f8(box[i + 1]), load_f8(box[i + count / 2 * 2]));
        }
        store_f8(whole, box[i]);
        write_node(whole, place.first + first, count, tree.nodes[place.node + i]);
    }
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
