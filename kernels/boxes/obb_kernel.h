#pragma once

#include "kernels/primitives/obb.h"
#include "kernels/verdict.h"

#include <concepts>
#include <string_view>

namespace boxwood {

/// Whether two closed boxes in any pose share a point, at the rung that K::info states. K::Real is
/// what it reads. Boxes may be flat. The answer is `maybe` where the rung cannot decide, and for
/// NaN or infinity.
template <class K>
concept ObbKernel = requires(const Obb<typename K::Real>& a, const Obb<typename K::Real>& b) {
    { K::name } -> std::convertible_to<std::string_view>;
    { K::info } -> std::convertible_to<KernelInfo>;
    { K::overlap(a, b) } -> std::same_as<Verdict>;
};

} // namespace boxwood
