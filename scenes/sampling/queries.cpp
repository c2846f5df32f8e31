#include "scenes/sampling/queries.h"

#include "kernels/suggest.h"
#include "scenes/sampling/random.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

constexpr std::size_t wanted_items = 10; ///< met by a region in the mean

Aabb<double> bounds_of(SceneBoxes boxes) {
    Aabb<double> bounds;
    for (const Aabb<float>& box : boxes) {
        bounds.extend(static_cast<Vec>(box.min));
        bounds.extend(static_cast<Vec>(box.max));
    }
    return bounds;
}

/// Uniform in the box, grown on every side by `share` of its size.
Vec in_grown(const Aabb<double>& box, double share, Draws& draws) {
    const Vec size = box.max - box.min;
    const Vec u = draws.in_cube();
    Vec p = box.min;
    for (int axis = 0; axis < 3; ++axis)
        p[axis] += (u[axis] * (1 + 2 * share) - share) * size[axis];
    return p;
}

/// Rounded to float, held to the finite ones.
Vec3<float> to_float(Vec p) {
    constexpr double max_float = static_cast<double>(std::numeric_limits<float>::max());
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = std::clamp(p[axis], -max_float, max_float);
    return static_cast<Vec3<float>>(p);
}

/// How far a cube (half its side) or a ball (its radius, squared) around p must reach to meet the
/// box.
double reach_of_cube(Vec p, const Aabb<float>& box) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach = std::max({reach, static_cast<double>(box.min[axis]) - p[axis],
                          p[axis] - static_cast<double>(box.max[axis])});
    return reach;
}
double reach_of_ball(Vec p, const Aabb<float>& box) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = std::max({0.0, static_cast<double>(box.min[axis]) - p[axis],
                                   p[axis] - static_cast<double>(box.max[axis])});
        sum += d * d;
    }
    return sum;
}

/// The reach at which the first points meet `wanted_items` items each in the mean: of all reaches
/// from a point to an item the one of that rank.
template <class Reach>
double usual_reach(SceneBoxes boxes, std::span<const Vec3<float>> points, const Reach& reach_of) {
    const std::size_t samples = std::min<std::size_t>(32, points.size());
    const std::size_t wanted = wanted_items * samples;
    std::vector<double> nearest, reaches(boxes.size());
    for (std::size_t i = 0; i < samples; ++i) {
        const Vec p(points[i]);
        std::ranges::transform(boxes, reaches.begin(),
                               [&](const Aabb<float>& box) { return reach_of(p, box); });
        const std::size_t kept = std::min(wanted, reaches.size());
        std::ranges::nth_element(reaches, reaches.begin() + static_cast<std::ptrdiff_t>(kept - 1));
        nearest.insert(nearest.end(), reaches.begin(),
                       reaches.begin() + static_cast<std::ptrdiff_t>(kept));
    }
    if (nearest.empty())
        return 0;
    const std::size_t rank = std::min(wanted, nearest.size()) - 1;
    std::ranges::nth_element(nearest, nearest.begin() + static_cast<std::ptrdiff_t>(rank));
    return nearest[rank];
}

void require_boxes(SceneBoxes boxes, std::size_t n) {
    if (boxes.empty() && n > 0)
        throw std::invalid_argument("points: the scene has no boxes to lay them around");
}

} // namespace

std::span<const RegionKindEntry> region_kinds() {
    static constexpr RegionKindEntry entries[] = {
        {"boxes", "boxes around points in and near items, that meet about 10 items"},
        {"spheres", "balls around points in and near items, that meet about 10 items"}};
    return entries;
}

void check_region_kind(std::string_view kind) {
    entry_named(kind, region_kinds(), "kind of regions");
}

std::vector<Vec3<float>> make_points(SceneBoxes boxes, std::size_t n, std::uint64_t seed) {
    require_boxes(boxes, n);
    const Random numbers(seed, "points");
    const Aabb<double> bounds = bounds_of(boxes);
    std::vector<Vec3<float>> points;
    points.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
        Draws draws = numbers.item(i);
        const double pick = draws.uniform() * static_cast<double>(boxes.size());
        const Aabb<float>& item = boxes[std::min(static_cast<std::size_t>(pick), boxes.size() - 1)];
        points.push_back(to_float(i % 2 == 0 ? in_grown({Vec(item.min), Vec(item.max)}, 0.5, draws)
                                             : in_grown(bounds, 0.1, draws)));
    }
    return points;
}

std::vector<Aabb<float>> make_box_regions(SceneBoxes boxes, std::size_t n, std::uint64_t seed) {
    const std::vector<Vec3<float>> centres = make_points(boxes, n, seed);
    const double reach = usual_reach(boxes, centres, reach_of_cube);
    const Random numbers(seed, "regions.boxes");
    std::vector<Aabb<float>> regions;
    regions.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
        Draws draws = numbers.item(i);
        const Vec half = reach * (draws.in_cube() + Vec{0.5, 0.5, 0.5});
        const Vec centre(centres[i]);
        regions.push_back({to_float(centre - half), to_float(centre + half)});
    }
    return regions;
}

std::vector<Sphere<float>> make_sphere_regions(SceneBoxes boxes, std::size_t n,
                                               std::uint64_t seed) {
    const std::vector<Vec3<float>> centres = make_points(boxes, n, seed);
    const double radius = std::sqrt(usual_reach(boxes, centres, reach_of_ball));
    const Random numbers(seed, "regions.spheres");
    std::vector<Sphere<float>> regions;
    regions.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
        Draws draws = numbers.item(i);
        const double max_float = static_cast<double>(std::numeric_limits<float>::max());
        regions.push_back({centres[i], static_cast<float>(
                                           std::min(max_float, radius * (0.5 + draws.uniform())))});
    }
    return regions;
}

} // namespace boxwood
