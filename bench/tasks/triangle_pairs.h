#pragma once

#include "bench/tasks/contender.h"
#include "trees/builder.h"
#include "trees/layout.h"

namespace boxwood::bench {

/// The whole query "which triangles of this mesh share a point": a tree over the triangles' boxes,
/// its self-pairs, and `kernel`, a word of triangle_kernels(), for each candidate.
std::unique_ptr<Contender> make_triangle_pairs(const Job& job, BuildFunction build,
                                               const LayoutEntry& layout, std::string_view kernel);

} // namespace boxwood::bench
