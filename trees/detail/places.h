#pragma once

#include "kernels/primitives/vec3.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boxwood::detail {

/// By vertex: one of those at its place, the same for all of them; itself if it has a NaN.
std::vector<std::uint32_t> places_of(std::span<const Vec3<float>> vertices);

} // namespace boxwood::detail
