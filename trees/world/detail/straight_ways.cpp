#include "trees/world/detail/straight_ways.h"

#include "kernels/continuous/tight_inclusion.h"
#include "trees/world/detail/aabb_gap.h"
#include "trees/world/mesh_pairs.h"

#include <array>
#include <vector>

namespace boxwood::detail {
namespace {

using Point = Vec3<double>;

struct MovingTriangle {
    std::array<Point, 3> start, end;

    MovingTriangle(const MeshTree& tree, std::uint32_t i, const Pose& from, const Pose& to)
        : start(corners(tree.triangle(i, from))), end(corners(tree.triangle(i, to))) {}

    Aabb<double> box() const {
        Aabb<double> around;
        for (const auto* side : {&start, &end})
            for (const Point& corner : *side)
                around.extend(corner);
        return around;
    }

  private:
    static std::array<Point, 3> corners(const Triangle<double>& t) { return {t.a, t.b, t.c}; }
};

LinearMotion vertex_face(const MovingTriangle& of_vertex, std::size_t i,
                         const MovingTriangle& face) {
    return {{of_vertex.start[i], face.start[0], face.start[1], face.start[2]},
            {of_vertex.end[i], face.end[0], face.end[1], face.end[2]}};
}

LinearMotion edge_edge(const MovingTriangle& a, std::size_t i, const MovingTriangle& b,
                       std::size_t j) {
    const std::size_t next_i = (i + 1) % 3, next_j = (j + 1) % 3;
    return {{a.start[i], a.start[next_i], b.start[j], b.start[next_j]},
            {a.end[i], a.end[next_i], b.end[j], b.end[next_j]}};
}

/// With more triangles in a stretch a step of the distance costs less.
constexpr std::size_t most_near = 256;

} // namespace

std::optional<FreeStretch> free_stretch(const MovingMeshes& meshes, const Stretch& stretch,
                                        Work* work) {
    const auto& [mesh_a, motion_a, mesh_b, motion_b, margin] = meshes;
    const Pose from_a = motion_a.at(stretch.from), to_a = motion_a.at(stretch.to),
               from_b = motion_b.at(stretch.from), to_b = motion_b.at(stretch.to);
    const double extra = margin * (1 + 0x1p-46);
    const std::vector<Pair> near = near_triangles(mesh_a, mesh_b, relative_pose(from_a, from_b),
                                                  stretch.reach + extra, most_near + 1, work);
    if (near.size() > most_near)
        return std::nullopt;
    const TightInclusion kernel{.tolerance = stretch.tolerance,
                                .separation = stretch.separation + extra,
                                .max_checks = 1000};
    double t_free = 1; // of the stretch
    FreeStretch free{stretch.to};
    for (const Pair pair : near) {
        const MovingTriangle a(mesh_a, pair.a, from_a, to_a), b(mesh_b, pair.b, from_b, to_b);
        if (gap_below(a.box(), b.box()) > kernel.separation)
            continue;
        const auto note = [&](const Impact& impact) {
            if (impact.answer != Answer::no && impact.t_free < t_free) {
                t_free = impact.t_free;
                free.near = pair;
            }
        };
        for (std::size_t i = 0; i < 3; ++i) {
            note(kernel.vertex_face(vertex_face(a, i, b)));
            note(kernel.vertex_face(vertex_face(b, i, a)));
            for (std::size_t j = 0; j < 3; ++j)
                note(kernel.edge_edge(edge_edge(a, i, b, j)));
        }
    }
    if (t_free < 1)
        free.until = stretch.from + t_free * (stretch.to - stretch.from) * (1 - 0x1p-40);
    return free;
}

} // namespace boxwood::detail
