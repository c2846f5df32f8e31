#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/obb.h"

#include <concepts>

namespace boxwood {

/// Whether two closed boxes in any pose share a point, with the accuracy that K::info states.
/// K::Real is what it reads. Boxes may be flat. The answer is `maybe` where the kernel cannot
/// decide, and for NaN or infinity.
template <class K>
concept ObbKernel = DescribedKernel<K> &&
    requires(const Obb<typename K::Real>& a, const Obb<typename K::Real>& b) {
    { K::overlap(a, b) } -> std::same_as<Decision>;
};

} // namespace boxwood
