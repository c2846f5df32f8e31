#pragma once

#include "trees/layout.h"
#include "trees/queries/sinks.h"

#include <compare>
#include <cstdint>
#include <limits>
#include <vector>

namespace boxwood::bench {

/// Triangles of two bodies that share a point; body_a < body_b.
struct TouchingTriangles {
    std::uint32_t body_a, body_b, triangle_a, triangle_b;
    constexpr auto operator<=>(const TouchingTriangles&) const = default;
};

/// Where a ray first meets a body: at t, on a triangle of its mesh, or of the twelve of its box.
struct SurfaceHit {
    float t = std::numeric_limits<float>::infinity();
    std::uint32_t body = none, triangle = none;

    static constexpr std::uint32_t none = ~std::uint32_t{0};
    constexpr auto operator<=>(const SurfaceHit&) const = default;
};

/// The answers to the queries of a scene in one frame; those it does not have stay empty.
struct FrameAnswers {
    std::vector<Pair> pairs;                       ///< a < b, in the order in which they were found
    std::vector<TouchingTriangles> triangle_pairs; ///< in the order of the pairs
    std::vector<SurfaceHit> rays;                  ///< of each ray
    std::vector<Pair> points, regions;             ///< (query, body), by query
    std::vector<Neighbour> nearest;                ///< k of each point
};

/// The same for the same answers in another order.
std::uint64_t answers_hash(const FrameAnswers& answers);

} // namespace boxwood::bench
