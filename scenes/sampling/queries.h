#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/sphere.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace boxwood {

using SceneBoxes = std::span<const Aabb<float>>;

/// A kind of regions laid into a scene.
struct RegionKindEntry {
    std::string_view name, summary;
};
std::span<const RegionKindEntry> region_kinds();

/// Throws std::invalid_argument, with a suggestion, unless `kind` is a name of `region_kinds()`.
void check_region_kind(std::string_view kind);

/// n finite points: those of even number in or beside an item (uniform in its box, grown by half
/// its size on every side), the others uniform in the bounds of all, grown by a tenth. The same
/// bits on every machine; point i depends on the boxes, the seed and i.
/// All three throw std::invalid_argument if there are no boxes and n > 0.
std::vector<Vec3<float>> make_points(SceneBoxes boxes, std::size_t n, std::uint64_t seed);

/// n closed boxes around such points. A cube that meets ten items in the mean over 32 of them sets
/// the size; each side of each box is half to one and a half of it.
std::vector<Aabb<float>> make_box_regions(SceneBoxes boxes, std::size_t n, std::uint64_t seed);

/// n balls around such points, of half to one and a half the radius that meets ten items in the
/// mean.
std::vector<Sphere<float>> make_sphere_regions(SceneBoxes boxes, std::size_t n, std::uint64_t seed);

} // namespace boxwood
