#pragma once

#include "kernels/primitives/triangle.h"
#include "trees/tree.h"

#include <optional>
#include <string>

namespace boxwood {

/// What the boxes of a tree must be.
enum class Bounds {
    tight,     ///< each inner box the union of its children, each leaf box its item's box, exactly
    containing ///< each inner box holds its children, each leaf box its item (fat margins)
};

/// Nothing if the tree is the canonical tree of these n boxes: 2n - 1 nodes whose counts and slots
/// follow the depth-first arithmetic of `Tree`, each item in exactly one slot, boxes as `bounds`
/// says. Else what is wrong and where, for the first fault found. Safe on any content; O(n).
std::optional<std::string> validate(const Tree& tree, Boxes boxes, Bounds bounds = Bounds::tight);

/// The same of a split tree of m leaves: 2m - 1 nodes, each triangle in one slot or more, each leaf
/// box within the bounds of its triangle, and inner boxes exactly unions. That the leaf boxes of a
/// triangle together cover it is tried at 153 points of it: corners, along edges, inside. O(m).
std::optional<std::string> validate_split(const Tree& tree, const TriangleMesh& mesh);

} // namespace boxwood
