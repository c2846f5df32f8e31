#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
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

/// What SceneSpec::rays is of rays that the user has.
inline constexpr std::string_view own_rays = "own";

/// From CSV text with rows of ox,oy,oz,dx,dy,dz[,tmax], rounded to floats, to nearest, but for
/// tmax, which is rounded down: no hit lies beyond what was written. tmax may be inf. Throws
/// BadInput, "source:line: ...", for anything else: a direction that is zero as floats, tmax < 0,
/// or another number that is not below 2^126 in size.
std::vector<Ray<float>> parse_rays(std::string_view text, const std::string& source);

/// What parse_rays calls the columns.
inline constexpr std::string_view ray_columns = "ox,oy,oz,dx,dy,dz[,tmax]";

/// The rays of a CSV file. Throws BadInput as parse_rays does, and for a file that cannot be read
/// or has no row.
std::vector<Ray<float>> read_rays(const std::filesystem::path& file);

/// Pixels in a row of the picture that n rays of a kind are, whose last row may be in part; 0 if
/// they are no picture.
std::size_t picture_width(std::string_view kind, std::size_t n);

} // namespace boxwood
