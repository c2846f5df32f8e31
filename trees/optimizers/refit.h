#pragma once

#include "trees/tree.h"

#include <cstddef>

namespace boxwood {

/// Gives the items of a tree new boxes and makes every bound exact again, in one pass from the last
/// node to the first: children come after their parent, so they are done before it. O(n), the shape
/// stays. Returns how many nodes changed.
/// Throws InvalidBox for a box that is no box, and std::invalid_argument if the number of boxes is
/// not that of the items or an item has no box; the tree is then as it was.
std::size_t refit(Tree& tree, Boxes boxes);

} // namespace boxwood
