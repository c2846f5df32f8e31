#pragma once

#include "kernels/kinematics/kinematic_tree.h"

#include <cstdint>
#include <span>

namespace boxwood {

/// State i of a robot at random: each value uniform in its range. The same bits on every machine;
/// it depends on the ranges, the seed and i alone. values: one per range.
void random_values(std::span<const ValueRange> ranges, std::uint64_t seed, std::uint64_t i,
                   std::span<double> values);

} // namespace boxwood
