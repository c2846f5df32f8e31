#pragma once

#include "kernels/triangle.h"
#include "kernels/verdict.h"

#include <concepts>
#include <string_view>

namespace boxwood {

/// Whether two closed triangles share a point, at the rung that K::info states. Triangles may be
/// degenerate. The answer is `maybe` where the rung cannot decide, and for NaN.
template <class K>
concept TriangleKernel = requires(const Triangle<double>& a, const Triangle<double>& b) {
    { K::name } -> std::convertible_to<std::string_view>;
    { K::info } -> std::convertible_to<KernelInfo>;
    { K::intersect(a, b) } -> std::same_as<Verdict>;
};

} // namespace boxwood
