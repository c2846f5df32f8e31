#pragma once

#include "results/results.h"

#include <string>
#include <vector>

namespace boxwood::bench {

/// The classes that a contender of a job stands in: contenders are compared within a class only.
/// Rays have several: a peer takes single rays or packets, and watertight ones stand by themselves;
/// ours in one call answers for both, and a watertight kernel for the looser class too. All other
/// tasks have one class without a name.
std::vector<std::string> classes_of(const results::Cell& cell, const results::Variant& variant);

/// Sets Cell::classes of every cell.
void set_classes(results::Results& results);

/// The names in Cell::classes.
std::vector<std::string> split_classes(const std::string& classes);

} // namespace boxwood::bench
