#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace boxwood {

/// What a yes/no kernel says. `maybe` is the honest answer of a kernel whose error bound does not
/// decide; the caller's policy resolves it (never-miss reads it as yes, never-false as no).
enum class Answer : std::uint8_t { no, yes, maybe };

/// An answer and the tier of the kernel that gave it (0 is the cheapest).
struct Decision {
    Answer answer = Answer::no;
    std::uint8_t tier = 0;

    constexpr bool operator==(const Decision&) const = default;
};

/// The accuracy level of a kernel: what it promises on every finite input.
/// never_leaks: of rays at a closed mesh whose triangles share their vertices bit for bit, one from
/// inside hits one of them; of a triangle on its own nothing. never_miss: a true yes is never
/// answered no. never_false: a true no is never answered yes. certified: both; what it is sure of
/// holds (no, yes, an interval), else it says maybe or widens. exact: certified, and always sure.
/// So that none may answer by saying nothing: of generic input, far from contact, at most one
/// answer in a hundred is maybe, false on the permitted side or wider than 2^-16 of what is
/// measured.
enum class Promise : std::uint8_t { none, never_leaks, never_miss, never_false, certified, exact };

constexpr std::string_view to_string(Promise p) {
    switch (p) {
    case Promise::never_leaks:
        return "never-leaks";
    case Promise::never_miss:
        return "never-miss";
    case Promise::never_false:
        return "never-false";
    case Promise::certified:
        return "certified";
    case Promise::exact:
        return "exact";
    case Promise::none:
        break;
    }
    return "no promise";
}

/// One kernel: what `boxwood list kernels` prints.
struct KernelInfo {
    std::string_view family;  ///< "ray_triangle", "triangle_triangle", ...
    std::string_view name;    ///< registry name within the family
    std::string_view summary; ///< one line: method and source
    Promise promise = Promise::none;
    std::string_view bound = "none"; ///< the error bound and its source, or why there is none
    std::string_view cost = ""; ///< cost class: "about 100 flops", "filter, then integers", ...
    /// Of certified distances: hi - lo is at most this part of hi, plus 2^-1073, an infinite hi
    /// taken as the largest double. 0: not promised.
    double relative_width = 0;
    /// Of never-miss kernels that say maybe: a yes is true.
    bool yes_is_proven = false;
    /// Of distances: whether it says where they are taken.
    bool has_witnesses = true;
};

/// What every kernel says of itself at compile time: its name, and its promise with the rest.
template <class K>
concept DescribedKernel = requires {
    { K::name } -> std::convertible_to<std::string_view>;
    { K::info } -> std::convertible_to<KernelInfo>;
    typename std::integral_constant<Promise, K::info.promise>;
};

} // namespace boxwood
