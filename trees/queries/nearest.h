#pragma once

#include "kernels/primitives/triangle.h"
#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/layouts/layouts.h"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace boxwood {

/// An item near a point, and the square of the distance from the point to its box (0 inside).
struct Neighbour {
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    static constexpr double nowhere = std::numeric_limits<double>::infinity();

    std::uint32_t item = none;
    double squared_distance = nowhere;

    constexpr auto operator<=>(const Neighbour&) const = default;
};

/// The point of a mesh that is nearest to a query point; of triangles at the same distance, as it
/// is computed, on the lowest. `triangle` is Neighbour::none if the mesh is empty.
struct SurfacePoint {
    Vec3<float> point{};
    std::uint32_t triangle = Neighbour::none;
    double squared_distance = std::numeric_limits<double>::infinity();
};

/// nearest: the k items nearest to each point, by distance and then by item: out[k i ...] answers
/// points[i], filled up with no item if there are fewer; out.size() == k * points.size().
/// closest_points: the nearest point of the mesh whose triangles' boxes the layout was made of,
/// computed in doubles and rounded; out.size() == points.size().
/// A wrong size throws std::invalid_argument. `work`, if given, is added to, and the executor must
/// be serial().
#define X(name, L)                                                                                 \
    void nearest(const L& layout, std::span<const Vec3<float>> points, std::size_t k,              \
                 const Executor& executor, std::span<Neighbour> out, Work* work = nullptr);        \
    void closest_points(const L& layout, std::span<const Vec3<float>> points,                      \
                        const TriangleMesh& mesh, const Executor& executor,                        \
                        std::span<SurfacePoint> out, Work* work = nullptr);
BOXWOOD_SEARCHED_TREES(X)
#undef X

} // namespace boxwood
