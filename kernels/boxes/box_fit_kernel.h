#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/aabb.h"
#include "kernels/primitives/rigid_transform.h"

#include <concepts>

namespace boxwood {

/// An axis-aligned box around the image of one, under the matrix as it stands (which need not be a
/// rotation). K::Real (float or double) is what it reads and gives. The empty box stays empty.
template <class K>
concept BoxFitKernel = DescribedKernel<K> &&
    requires(const RigidTransform<typename K::Real>& transform, const Aabb<typename K::Real>& box) {
    { K::fit(transform, box) } -> std::same_as<Aabb<typename K::Real>>;
};

} // namespace boxwood
