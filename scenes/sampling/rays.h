#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace boxwood {

/// Throws std::invalid_argument, with a suggestion, unless `kind` is a name of `ray_kinds()`.
void check_ray_kind(std::string_view kind);

/// n rays of a kind, aimed at a mesh with at least one triangle; every number finite but t_max,
/// which may be infinite. The same bits on every machine; ray i depends on the mesh, the seed and i
/// (primary: on n as well). Throws std::invalid_argument for an unknown kind or an empty mesh, and
/// std::runtime_error for a mesh so large that a ray would overflow.
std::vector<Ray<float>> make_rays(std::string_view kind, const TriangleMesh& mesh, std::size_t n,
                                  std::uint64_t seed);

} // namespace boxwood
