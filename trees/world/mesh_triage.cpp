#include "trees/world/mesh_triage.h"

#include "kernels/predicates/exact.h"
#include "kernels/primitives/coordinate_limit.h"
#include "trees/detail/places.h"

#include <algorithm>
#include <array>

namespace boxwood {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// Exactly: whether it turns in one of the coordinate planes.
bool has_area(const Triangle<float>& t) {
    const Vec3<double> a(t.a), b(t.b), c(t.c);
    const auto turns = [&](int i, int j) {
        return Exact::orient2d({a[i], a[j]}, {b[i], b[j]}, {c[i], c[j]}) != 0;
    };
    return turns(0, 1) || turns(1, 2) || turns(2, 0);
}

/// An edge between two places, and whether its triangle goes through it from the lower number.
struct Edge {
    std::uint32_t low, high;
    bool is_forwards;
    bool is_same(const Edge& other) const { return low == other.low && high == other.high; }
};

} // namespace

MeshTriage triage(const TriangleMesh& mesh) {
    MeshTriage found;
    found.triangles = mesh.triangles.size();
    found.vertices = mesh.vertices.size();
    // Sorting wants numbers: what is none stands at the origin, and its triangles are set aside.
    std::vector<Vec3<float>> vertices = mesh.vertices;
    for (Vec3<float>& v : vertices)
        if (!is_finite(v))
            v = {};
    const std::vector<std::uint32_t> places = detail::places_of(vertices);
    std::vector<std::uint8_t> is_used(mesh.vertices.size());
    std::vector<std::pair<Corners, std::uint32_t>> good; // corners in order, triangle
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Corners& t = mesh.triangles[i];
        if (std::ranges::any_of(t, [&](std::uint32_t v) { return v >= mesh.vertices.size(); })) {
            found.missing_vertices.push_back(i);
            continue;
        }
        for (const std::uint32_t v : t)
            is_used[v] = 1;
        if (std::ranges::any_of(t, [&](std::uint32_t v) { return !is_finite(mesh.vertices[v]); })) {
            found.not_finite.push_back(i);
            continue;
        }
        if (std::ranges::any_of(t, [&](std::uint32_t v) { return !is_in_range(mesh.vertices[v]); }))
            found.too_large.push_back(i);
        if (!has_area(mesh.triangle(i))) {
            found.without_area.push_back(i);
        } else {
            Corners corners{places[t[0]], places[t[1]], places[t[2]]};
            std::ranges::sort(corners);
            good.emplace_back(corners, i);
        }
    }
    found.unused_vertices = static_cast<std::size_t>(std::ranges::count(is_used, 0));
    std::ranges::sort(good);
    std::vector<Edge> edges;
    for (std::size_t k = 0; k < good.size(); ++k) {
        const auto& [corners, i] = good[k];
        if (k > 0 && corners == good[k - 1].first) {
            found.repeated.push_back(i);
            continue;
        }
        const Corners& t = mesh.triangles[i];
        for (std::size_t side = 0; side < 3; ++side) {
            const std::uint32_t from = places[t[side]], to = places[t[(side + 1) % 3]];
            edges.push_back({std::min(from, to), std::max(from, to), from < to});
        }
    }
    std::ranges::sort(found.repeated);
    std::ranges::sort(edges, {}, [](const Edge& e) { return std::pair(e.low, e.high); });
    for (std::size_t first = 0; first < edges.size();) {
        std::size_t last = first, forwards = 0;
        for (; last < edges.size() && edges[last].is_same(edges[first]); ++last)
            forwards += edges[last].is_forwards;
        const std::size_t count = last - first;
        found.open_edges += count == 1;
        found.non_manifold_edges += count > 2;
        found.turned_edges += count == 2 && forwards != 1;
        first = last;
    }
    return found;
}

std::vector<std::uint32_t> good_triangles(const MeshTriage& triage) {
    std::vector<std::uint8_t> is_bad(triage.triangles);
    for (const auto* list :
         {&triage.missing_vertices, &triage.not_finite, &triage.without_area, &triage.repeated})
        for (const std::uint32_t i : *list)
            is_bad[i] = 1;
    std::vector<std::uint32_t> good;
    for (std::uint32_t i = 0; i < triage.triangles; ++i)
        if (!is_bad[i])
            good.push_back(i);
    return good;
}

TriangleMesh without_bad_triangles(const TriangleMesh& mesh, const MeshTriage& triage) {
    TriangleMesh good{mesh.vertices, {}};
    for (Vec3<float>& vertex : good.vertices)
        if (!is_finite(vertex))
            vertex = {};
    for (const std::uint32_t i : good_triangles(triage))
        good.triangles.push_back(mesh.triangles[i]);
    return good;
}

} // namespace boxwood
