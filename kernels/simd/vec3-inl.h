// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_VEC3_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_VEC3_INL_H
#undef BOXWOOD_VEC3_INL_H
#else
#define BOXWOOD_VEC3_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

/// Three components, a register each: `Vec3` (kernels/primitives/vec3.h) in every lane. V: a vector
/// of Highway, or a type that wraps one. The operations round as those of Vec3 do, in their order.
template <class V> struct LaneVec3 { V x, y, z; };

template <class V> HWY_INLINE LaneVec3<V> operator+(const LaneVec3<V>& a, const LaneVec3<V>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V> HWY_INLINE LaneVec3<V> operator-(const LaneVec3<V>& a, const LaneVec3<V>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V> HWY_INLINE LaneVec3<V> operator-(const LaneVec3<V>& a) {
    return {-a.x, -a.y, -a.z};
}
template <class V> HWY_INLINE LaneVec3<V> operator*(const V& s, const LaneVec3<V>& a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class V> HWY_INLINE V dot(const LaneVec3<V>& a, const LaneVec3<V>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V> HWY_INLINE LaneVec3<V> cross(const LaneVec3<V>& a, const LaneVec3<V>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// `dot` and `cross` by fused multiply-add where the instruction set has it: for bounds alone, as
/// the bits differ between instruction sets.
template <class V> HWY_INLINE V fused_dot(const LaneVec3<V>& a, const LaneVec3<V>& b) {
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
template <class V> HWY_INLINE LaneVec3<V> fused_cross(const LaneVec3<V>& a, const LaneVec3<V>& b) {
    namespace hn = hwy::HWY_NAMESPACE;
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

/// Lanes [i, i + Lanes(d)) of three rows; i is a multiple of Lanes(d), the rows are aligned.
template <class D, class Real, std::size_t lanes>
HWY_INLINE LaneVec3<hwy::HWY_NAMESPACE::Vec<D>> load3(D d, const Real (&rows)[3][lanes],
                                                      std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    return {hn::Load(d, rows[0] + i), hn::Load(d, rows[1] + i), hn::Load(d, rows[2] + i)};
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
