#pragma once

/// All of Boxwood that a program includes: trees.h says what it makes of boxes and triangles,
/// bvh.h where to begin, kernels.h what decides about a pair of them.
/// The libraries are compiled so that nothing is contracted to fma. Who calls kernels from their
/// headers on a machine that has it (-march=native, arm64) and wants their promises kept compiles
/// with -ffp-contract=off; trees need no flags.

#include "kernels/kernels.h"
#include "trees/trees.h"

#include <boxwood/version.h>
