#pragma once

#include "trees/tree.h"

#include <span>
#include <string>

namespace boxwood {

/// The tree as text, a line per node, children indented below their parent, with the node's box
/// to four digits: for people and for small trees (the text of n items takes up to n times depth
/// characters). names[i] is the name of item i; without names items are called by their index.
/// Throws std::invalid_argument if there are some names but not one for each item.
std::string draw(const Tree& tree, std::span<const std::string> names = {});

/// What lies below a node: "elbow" for a leaf, "{elbow, wrist}" for up to 8 items, "{20 items}".
std::string describe(const Tree& tree, std::size_t node, std::span<const std::string> names = {});

} // namespace boxwood
