#pragma once

#include "trees/tree.h"

#include <span>

namespace boxwood::detail {

/// The bounds in doubles of every node of a tree, from its items' double boxes: a tree's shape is
/// decided by float boxes that contain them, its answers by these.
/// Throws InvalidBox for the first bad box, and std::invalid_argument if the counts differ or the
/// tree is split.
Buffer<Aabb<double>> exact_boxes(const Tree& tree, std::span<const Aabb<double>> boxes);

} // namespace boxwood::detail
