/// Every triangle-triangle kernel against rationals, held to its promise.

#include "bench/fuzz/fuzz.h"
#include "kernels/oracle/oracle.h"
#include "kernels/registry.h"

namespace boxwood::fuzz {
namespace {

template <class Real> Triangle<Real> rounded(const Triangle<double>& t) {
    return {Vec3<Real>(t.a), Vec3<Real>(t.b), Vec3<Real>(t.c)};
}

template <class Real> bool finite(const Triangle<Real>& t) {
    return is_finite(t.a) && is_finite(t.b) && is_finite(t.c);
}

template <class K> void judge(const Triangle<double>& a, const Triangle<double>& b) {
    constexpr Promise promise = K::info.promise;
    if constexpr (promise != Promise::none) {
        using Real = typename K::Real;
        const Triangle<Real> own_a = rounded<Real>(a), own_b = rounded<Real>(b);
        if (!finite(own_a) || !finite(own_b))
            return;
        const bool truth = oracle::intersect(
            rounded<double>(Triangle<double>{Vec3<double>(own_a.a), Vec3<double>(own_a.b),
                                             Vec3<double>(own_a.c)}),
            rounded<double>(Triangle<double>{Vec3<double>(own_b.a), Vec3<double>(own_b.b),
                                             Vec3<double>(own_b.c)}));
        for (const Decision d : {K::intersect(own_a, own_b), K::intersect(own_b, own_a)}) {
            const std::string name(K::name);
            require(promise == Promise::never_false || d.answer != Answer::no || !truth,
                    name + " misses");
            require(promise == Promise::never_miss || d.answer != Answer::yes || truth,
                    name + " answers a false yes");
            require(promise != Promise::exact || d.answer != Answer::maybe, name + " is not sure");
        }
    }
}

} // namespace

void triangle_triangle(Bytes bytes) {
    Coordinates in(bytes);
    Triangle<double> t[2];
    for (Triangle<double>& of : t)
        for (Vec3<double>* corner : {&of.a, &of.b, &of.c})
            for (int axis = 0; axis < 3; ++axis)
                (*corner)[axis] = in.next<double>();
    [&]<class... K>(std::type_identity<std::tuple<K...>>) {
        (judge<K>(t[0], t[1]), ...);
    }(std::type_identity<TriangleKernels>{});
}

} // namespace boxwood::fuzz
