#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/triangle.h"

#include <gtest/gtest.h>

#include <tuple>
#include <type_traits>
#include <utility>

namespace boxwood {

/// Calls f.operator()<K>() for each kernel K of the tuples.
template <class... Tuples, class F> void for_each_kernel(F f) {
    using All = decltype(std::tuple_cat(std::declval<Tuples>()...));
    [&]<class... K>(std::type_identity<std::tuple<K...>>) {
        (f.template operator()<K>(), ...);
    }(std::type_identity<All>{});
}

/// Whether the answer keeps the promise where the truth is known.
inline bool is_kept(Promise promise, Answer answer, bool truth) {
    const bool is_miss = truth && answer == Answer::no, is_false = !truth && answer == Answer::yes;
    switch (promise) {
    case Promise::exact:
        return answer == (truth ? Answer::yes : Answer::no);
    case Promise::certified:
        return !is_miss && !is_false;
    case Promise::never_miss:
        return !is_miss;
    case Promise::never_false:
        return !is_false;
    case Promise::never_leaks: // of meshes, not of one primitive
    case Promise::none:
        break;
    }
    return true;
}

/// The triangle as numbers of another precision, rounded.
template <class To, class From> Triangle<To> as(const Triangle<From>& t) {
    return {Vec3<To>(t.a), Vec3<To>(t.b), Vec3<To>(t.c)};
}

} // namespace boxwood
