// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_PRIM8_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_PRIM8_INL_H
#undef BOXWOOD_PRIM8_INL_H
#else
#define BOXWOOD_PRIM8_INL_H
#endif

#include <hwy/highway.h>

#include "trees/builders/detail/prim8.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

// One register where there are registers of eight floats, else a plain array: the same numbers.
#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
using F8Tag = hwy::HWY_NAMESPACE::FixedTag<float, 8>;
struct F8 {
    hwy::HWY_NAMESPACE::Vec<F8Tag> v;
};
HWY_INLINE F8 load_f8(const float* from) { return {hwy::HWY_NAMESPACE::LoadU(F8Tag(), from)}; }
HWY_INLINE void store_f8(F8 a, float* to) { hwy::HWY_NAMESPACE::StoreU(a.v, F8Tag(), to); }
HWY_INLINE F8 set_f8(float a) { return {hwy::HWY_NAMESPACE::Set(F8Tag(), a)}; }
HWY_INLINE F8 max_f8(F8 a, F8 b) { return {hwy::HWY_NAMESPACE::Max(a.v, b.v)}; }
HWY_INLINE F8 doubled_centre(F8 a) {
    namespace hn = hwy::HWY_NAMESPACE;
    return {hn::Sub(a.v, hn::ConcatLowerUpper(F8Tag(), a.v, a.v))};
}
/// Node (min, max, first, count) of a box.
HWY_INLINE void write_node(F8 box, std::uint32_t first, std::uint32_t count, TreeNode& node) {
    namespace hn = hwy::HWY_NAMESPACE;
    constexpr hn::Rebind<std::int32_t, F8Tag> di;
    alignas(32) static constexpr std::int32_t lanes[8] = {4, 5, 6, 0, 1, 2, 3, 7};
    alignas(32) static constexpr float signs[8] = {-0.f, -0.f, -0.f, 0, 0, 0, 0, 0};
    const auto v = hn::TableLookupLanes(box.v, hn::IndicesFromVec(F8Tag(), hn::Load(di, lanes)));
    hn::StoreU(hn::Xor(v, hn::Load(F8Tag(), signs)), F8Tag(), &node.box.min.x);
    node.first = first;
    node.count = count;
}
#else
struct F8 {
    float v[8];
};
HWY_INLINE F8 load_f8(const float* from) {
    F8 a;
    std::copy_n(from, 8, a.v);
    return a;
}
HWY_INLINE void store_f8(const F8& a, float* to) { std::copy_n(a.v, 8, to); }
HWY_INLINE F8 set_f8(float a) { return {{a, a, a, a, a, a, a, a}}; }
HWY_INLINE F8 max_f8(const F8& a, const F8& b) {
    F8 c;
    for (int i = 0; i < 8; ++i)
        c.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
    return c;
}
HWY_INLINE F8 doubled_centre(const F8& a) {
    F8 c;
    for (int i = 0; i < 8; ++i)
        c.v[i] = a.v[i] - a.v[i ^ 4];
    return c;
}
HWY_INLINE void write_node(const F8& box, std::uint32_t first, std::uint32_t count,
                           TreeNode& node) {
    const float* v = box.v;
    node = {{{-v[4], -v[5], -v[6]}, {v[0], v[1], v[2]}}, first, count};
}
#endif

/// Less than any coordinate of a Prim8, and small enough that areas of it are finite.
inline constexpr float kLowest = -0x1p62f;

/// (max, -min) of the doubled centres.
HWY_INLINE F8 bounds_of_centres(const Prim8* prims, std::size_t n) {
    F8 bounds = set_f8(kLowest);
    for (std::size_t i = 0; i < n; ++i)
        bounds = max_f8(bounds, doubled_centre(load_f8(prims[i].v)));
    return bounds;
}

/// (max, -min) of the boxes.
HWY_INLINE F8 bounds_of_boxes(const Prim8* prims, std::size_t n) {
    F8 bounds = set_f8(kLowest);
    for (std::size_t i = 0; i < n; ++i)
        bounds = max_f8(bounds, load_f8(prims[i].v));
    return bounds;
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
