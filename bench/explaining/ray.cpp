#include "bench/explaining/drawing.h"
#include "bench/explaining/explain.h"

#include "kernels/ray_box/slabs.h"
#include "kernels/ray_triangle/watertight.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace boxwood::bench {
namespace {

std::string point_text(Vec3<float> p) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

constexpr std::size_t max_reported = 60; ///< steps

} // namespace

Explanation explain_ray(const Tree& tree, const TriangleMesh& mesh, const Ray<float>& ray) {
    Explanation answer;
    answer.text = fmt::format("The ray from {} along {}, t from {:g} to {:g}, at {} triangles.\n\n",
                              point_text(ray.origin), point_text(ray.direction), ray.t_min,
                              ray.t_max, mesh.triangles.size());
    const auto prepared = Watertight::prepare(ray);
    const RaySlabs slabs = tree.empty() ? RaySlabs(ray) : RaySlabs(ray, tree.bounds(0));
    struct Waiting {
        std::size_t node, depth;
        float entry;
    };
    std::vector<Waiting> waiting;
    RayHit nearest;
    std::size_t entered = 0, missed = 0, behind = 0, tested = 0, reported = 0;
    Drawing drawing(fmt::format("a ray at {} triangles", mesh.triangles.size()));
    const auto report = [&](std::size_t depth, const std::string& what) {
        if (++reported <= max_reported)
            answer.text +=
                fmt::format("{:{}}{}\n", "", 2 + 2 * std::min<std::size_t>(depth, 20), what);
        else if (reported == max_reported + 1)
            answer.text += "  ... (more of the same)\n";
    };
    const auto clip = [&](std::size_t node, float& entry) {
        const RaySpan span = boxwood::clip(slabs, tree.bounds(node), ray.t_min, ray.t_max);
        entry = span.entry;
        return span.hit();
    };
    float entry = 0;
    if (!tree.empty() && clip(0, entry))
        waiting.push_back({0, 0, entry});
    else
        answer.text += "  it passes by the box of them all\n";
    while (!waiting.empty()) {
        const Waiting now = waiting.back();
        waiting.pop_back();
        if (nearest.hit() && now.entry > nearest.t) {
            ++behind;
            report(now.depth,
                   fmt::format("node {} is left: it begins at t = {:.6g}, behind the hit "
                               "at {:.6g}",
                               now.node, now.entry, nearest.t));
            continue;
        }
        if (tree.is_leaf(now.node)) {
            const std::uint32_t item = tree.item(now.node);
            RayHit hit;
            ++tested;
            const float limit = nearest.hit() ? nearest.t : ray.t_max;
            if (Watertight::intersect(prepared, ray, mesh.triangle(item), limit, hit)) {
                report(now.depth,
                       fmt::format("triangle {} is hit at t = {:.6g} (u {:.4g}, v {:.4g})", item,
                                   hit.t, hit.u, hit.v));
                if (!nearest.hit() || hit.t < nearest.t ||
                    (hit.t == nearest.t && item < nearest.triangle)) {
                    nearest = hit;
                    nearest.triangle = item;
                }
            } else if (nearest.hit() &&
                       Watertight::intersect(prepared, ray, mesh.triangle(item), ray.t_max, hit)) {
                report(now.depth, fmt::format("triangle {} is hit at t = {:.6g}, behind the hit "
                                              "at {:.6g}",
                                              item, hit.t, nearest.t));
            } else {
                report(now.depth, fmt::format("triangle {} is missed", item));
            }
            continue;
        }
        ++entered;
        drawing.box(tree.bounds(now.node), "node");
        report(now.depth, fmt::format("node {} ({} triangles) is entered at t = {:.6g}", now.node,
                                      tree.nodes[now.node].count, now.entry));
        const std::size_t children[2] = {Tree::left(now.node), tree.right(now.node)};
        std::vector<Waiting> below;
        for (const std::size_t child : children) {
            if (clip(child, entry))
                below.push_back({child, now.depth + 1, entry});
            else {
                ++missed;
                report(now.depth + 1,
                       fmt::format("passes by node {} {}", child, box_text(tree.bounds(child))));
            }
        }
        std::ranges::sort(below,
                          [](const Waiting& a, const Waiting& b) { return a.entry > b.entry; });
        waiting.insert(waiting.end(), below.begin(), below.end());
    }
    if (nearest.hit())
        answer.text += fmt::format("\nThe nearest hit: triangle {} at t = {:.6g}, the point {}.\n",
                                   nearest.triangle, nearest.t,
                                   point_text(ray.origin + nearest.t * ray.direction));
    else
        answer.text += "\nNo triangle is hit.\n";
    answer.text += fmt::format("{} nodes entered, {} passed by, {} left behind a hit; {} of {} "
                               "triangles tested.\n",
                               entered, missed, behind, tested, mesh.triangles.size());
    if (nearest.hit()) {
        drawing.box(mesh.triangle(nearest.triangle).bounds(), "item-b",
                    fmt::format("{}", nearest.triangle));
        drawing.line(ray.origin, ray.origin + nearest.t * ray.direction);
    }
    answer.svg = drawing.svg();
    return answer;
}

} // namespace boxwood::bench
