// Compiled with -frounding-math, which CGAL's target sets.
#include "bench/peers/answering.h"
#include "bench/peers/mesh_peers.h"
#include "bench/tasks/detail/mesh_pair_answers.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

using MeshKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Corners = std::vector<MeshKernel::Triangle_3>;
using MeshPrimitive = CGAL::AABB_triangle_primitive<MeshKernel, Corners::const_iterator>;
using ExactTree = CGAL::AABB_tree<CGAL::AABB_traits<MeshKernel, MeshPrimitive>>;

MeshKernel::Point_3 exact_point(Vec3<double> p) { return {p.x, p.y, p.z}; }

/// The mesh's triangles as a pose puts them.
Corners corners_at(const TriangleMesh& mesh, const RigidTransform<double>& pose) {
    std::vector<MeshKernel::Point_3> vertices;
    vertices.reserve(mesh.vertices.size());
    for (const Vec3<float>& v : mesh.vertices)
        vertices.push_back(exact_point(pose(Vec3<double>(v))));
    Corners corners;
    corners.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles)
        corners.emplace_back(vertices[a], vertices[b], vertices[c]);
    return corners;
}

class TriangleTree : public Contender {
  public:
    explicit TriangleTree(const Job& job)
        : scene_(*job.scene), corners_(corners_at(scene_.mesh, RigidTransform<double>{})) {}
    void build() override {
        tree_.clear();
        tree_.insert(corners_.cbegin(), corners_.cend());
        tree_.build();
    }

  protected:
    const Scene& scene_;
    Corners corners_;
    ExactTree tree_;
};

class FirstTouch final : public TriangleTree {
  public:
    using TriangleTree::TriangleTree;
    void query(Answers& answers) override {
        std::vector<std::uint8_t>& touches = list_of<std::uint8_t>(answers);
        touches.clear();
        for (std::size_t i = 0; i < scene_.poses.size(); ++i)
            query_part(answers, i);
    }
    void query_part(Answers& answers, std::size_t part) override {
        const Corners copy = corners_at(scene_.copy(), scene_.poses[part]);
        list_of<std::uint8_t>(answers).push_back(std::ranges::any_of(
            copy, [&](const MeshKernel::Triangle_3& t) { return tree_.do_intersect(t); }));
    }
};

class AllTouches final : public TriangleTree {
  public:
    using TriangleTree::TriangleTree;
    void query(Answers& answers) override {
        std::vector<PosedPair>& touching = list_of<PosedPair>(answers);
        touching.clear();
        for (std::uint32_t i = 0; i < scene_.poses.size(); ++i) {
            const Corners copy = corners_at(scene_.copy(), scene_.poses[i]);
            for (std::uint32_t b = 0; b < copy.size(); ++b) {
                found_.clear();
                tree_.all_intersected_primitives(copy[b], std::back_inserter(found_));
                for (const Corners::const_iterator a : found_)
                    touching.push_back({i, static_cast<std::uint32_t>(a - corners_.cbegin()), b});
            }
        }
    }

  private:
    std::vector<MeshPrimitive::Id> found_;
};

std::optional<std::string> cannot_take(const Job& job) {
    if (job.scene &&
        std::ranges::any_of(corners_at(job.scene->mesh, RigidTransform<double>{}),
                            [](const MeshKernel::Triangle_3& t) { return t.is_degenerate(); }))
        return "CGAL requires triangles that are not degenerate";
    return std::nullopt;
}

ContenderEntry mesh_entry(const std::string& name, const std::string& how) {
    ContenderEntry e;
    e.name = "cgal.aabb_tree." + name;
    e.library = "cgal";
    e.summary = "CGAL's AABB_tree of the mesh, " + how;
    e.notes = "exact predicates; build = insert and build; query = the copy's triangles are moved "
              "as the pose says, " +
              how + ": it has no query of two trees; one thread";
    e.precision = "f64";
    e.runs_on = RunsOn::one_thread;
    e.cannot = cannot_take;
    return e;
}

} // namespace

std::vector<ContenderEntry> cgal_meshes() {
    std::vector<ContenderEntry> all;
    all.push_back(mesh_entry("first", "and each asks it by do_intersect until one touches"));
    all.back().answers = {answering<FirstTouch>("collide")};
    all.push_back(mesh_entry("all", "and each asks it by all_intersected_primitives"));
    all.back().answers = {answering<AllTouches>("collide_all")};
    return all;
}

} // namespace boxwood::bench
