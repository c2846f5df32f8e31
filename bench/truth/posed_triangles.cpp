#include "bench/truth/posed_triangles.h"

#include "bench/truth/column_sweep.h"
#include "kernels/arithmetic/rounding.h"
#include "kernels/oracle/oracle.h"
#include "trees/executor.h"

#include <algorithm>
#include <cmath>

namespace boxwood::bench {

Triangle<double> triangle_at(const TriangleMesh& mesh, std::size_t i,
                             const RigidTransform<double>& pose) {
    const Triangle<float> t = mesh.triangle(i);
    return {pose(Vec3<double>(t.a)), pose(Vec3<double>(t.b)), pose(Vec3<double>(t.c))};
}

PosedTriangles triangles_at(const TriangleMesh& mesh, const RigidTransform<double>& pose) {
    PosedTriangles all;
    all.reserve(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        all.push_back(triangle_at(mesh, i, pose));
    return all;
}

std::vector<Pair> touching_pairs(const PosedTriangles& a, const PosedTriangles& b,
                                 unsigned threads) {
    std::vector<Aabb<float>> boxes;
    for (const PosedTriangles* side : {&a, &b})
        for (const Triangle<double>& t : *side)
            boxes.push_back(round_outward(t.bounds()));
    std::vector<Pair> candidates = ColumnSweep(boxes, threads).pairs();
    std::erase_if(candidates, [&](Pair p) { return p.a >= a.size() || p.b < a.size(); });
    std::vector<std::uint8_t> touch(candidates.size());
    make_executor("tbb", threads)->for_each(candidates.size(), [&](std::size_t i) {
        const Pair p = candidates[i];
        touch[i] = oracle::intersect(a[p.a], b[p.b - a.size()]);
    });
    std::vector<Pair> found;
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (touch[i])
            found.push_back(
                {candidates[i].a, static_cast<std::uint32_t>(candidates[i].b - a.size())});
    return found;
}

std::vector<NearestTriangles::Least> least_distances(const Scene& scene, unsigned threads) {
    const NearestTriangles still(triangles_at(scene.mesh, {}));
    const NearestTriangles copy_at_rest(triangles_at(scene.copy(), {}));
    std::vector<NearestTriangles::Least> least(scene.poses.size());
    make_executor("tbb", threads)->for_each(least.size(), [&](std::size_t i) {
        NearestTriangles copy = copy_at_rest;
        copy.move(triangles_at(scene.copy(), scene.poses[i]));
        least[i] = still.to(copy);
    });
    return least;
}

double size_of(const PosedTriangles& mesh) {
    double size = 0;
    for (const Triangle<double>& t : mesh)
        for (const Vec3<double> p : {t.a, t.b, t.c})
            size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return size;
}

} // namespace boxwood::bench
