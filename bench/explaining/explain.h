#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"
#include "scenes/moving/moving_scene.h"
#include "trees/tree.h"

#include <cstdint>
#include <span>
#include <string>

/// Why a tree answers as it does: for one answer the way through the tree, step by step. Every
/// number is computed as it is written, by the comparisons that a query makes.
namespace boxwood::bench {

struct Explanation {
    std::string text;
    std::string svg;
};

/// Why boxes a and b are a pair, or none: the boxes, the gap or what they share, and the nodes that
/// a search for pairs compares on the way to them. exact: the boxes that `boxes` are rounded from,
/// which decide, as for `query pairs`; none where `boxes` are the items.
Explanation explain_pair(const Tree& tree, Boxes boxes, std::uint32_t a, std::uint32_t b,
                         std::span<const Aabb<double>> exact = {});

/// What a ray meets: the nodes that it enters, nearest first, those it passes by, the triangles
/// that are tested, and which of them it hits.
Explanation explain_ray(const Tree& tree, const TriangleMesh& mesh, const Ray<float>& ray);

/// With whom a body of a scene is a pair as it stands, with whom it would be one but for what the
/// scene expects, and who is nearest of the others.
Explanation explain_body(const MovingScene& scene, std::uint32_t body);

} // namespace boxwood::bench
