// Compiled with -frounding-math, which CGAL's target sets.
#include "bench/peers/answering.h"
#include "bench/peers/mesh_peers.h"
#include "bench/tasks/detail/mesh_pair_answers.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Surface_mesh.h>

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
using Surface = CGAL::Surface_mesh<MeshKernel::Point_3>;
using RigidPair = CGAL::Rigid_triangle_mesh_collision_detection<Surface>;
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

/// The mesh as CGAL's own kind of surface; a triangle that no manifold has gets corners of its own.
Surface surface_of(const TriangleMesh& mesh) {
    Surface surface;
    surface.reserve(static_cast<Surface::size_type>(mesh.vertices.size()),
                    static_cast<Surface::size_type>(3 * mesh.triangles.size()),
                    static_cast<Surface::size_type>(mesh.triangles.size()));
    const auto vertex = [&](std::uint32_t i) {
        return surface.add_vertex(exact_point(Vec3<double>(mesh.vertices[i])));
    };
    std::vector<Surface::Vertex_index> vertices;
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
        vertices.push_back(vertex(i));
    for (const auto& [a, b, c] : mesh.triangles)
        if (surface.add_face(vertices[a], vertices[b], vertices[c]) == Surface::null_face())
            surface.add_face(vertex(a), vertex(b), vertex(c));
    return surface;
}

/// By the package for rigid meshes: a traversal of two trees under a transformation.
class FirstTouch final : public Contender {
  public:
    explicit FirstTouch(const Job& job) : scene_(*job.scene), mesh_(surface_of(scene_.mesh)) {
        if (scene_.has_other_copy())
            copy_ = surface_of(scene_.copy());
    }
    void build() override {
        pair_.reset();
        const auto options = CGAL::parameters::apply_per_connected_component(false);
        tree_.clear();
        tree_.insert(faces(mesh_).first, faces(mesh_).second, mesh_);
        tree_.build();
        pair_.emplace();
        pair_->add_mesh(tree_, mesh_, options);
        if (scene_.has_other_copy())
            pair_->add_mesh(copy_, options);
        else
            pair_->add_mesh(tree_, mesh_, options);
    }
    void query(Answers& answers) override {
        list_of<std::uint8_t>(answers).clear();
        for (std::size_t i = 0; i < scene_.poses.size(); ++i)
            query_part(answers, i);
    }
    void query_part(Answers& answers, std::size_t part) override {
        const auto& [rotation, t] = scene_.poses[part];
        const auto& [x, y, z] = rotation;
        pair_->set_transformation(1, {x.x, x.y, x.z, t.x, y.x, y.y, y.z, t.y, z.x, z.y, z.z, t.z});
        list_of<std::uint8_t>(answers).push_back(!pair_->get_all_intersections(1).empty());
    }

  private:
    const Scene& scene_;
    Surface mesh_, copy_;
    RigidPair::AABB_tree tree_;
    std::optional<RigidPair> pair_;
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

ContenderEntry mesh_entry(const std::string& name, const std::string& summary,
                          const std::string& notes) {
    ContenderEntry e;
    e.name = "cgal." + name;
    e.library = "cgal";
    e.summary = "CGAL's " + summary;
    e.notes = "exact predicates; " + notes + "; one thread";
    e.precision = "f64";
    e.runs_on = RunsOn::one_thread;
    e.cannot = cannot_take;
    return e;
}

} // namespace

std::vector<ContenderEntry> cgal_meshes() {
    std::vector<ContenderEntry> all;
    all.push_back(mesh_entry("rigid_meshes.first",
                             "Rigid_triangle_mesh_collision_detection of the mesh and its copy",
                             "build = the tree, which two meshes share; query = "
                             "set_transformation and get_all_intersections, which ends at the "
                             "first pair of triangles; inside is apart"));
    all.back().answers = {answering<FirstTouch>("collide")};
    all.push_back(mesh_entry("aabb_tree.all", "AABB_tree of the mesh",
                             "build = insert and build; query = the copy's triangles are moved as "
                             "the pose says, and each by all_intersected_primitives: trees of two "
                             "meshes say yes or no alone"));
    all.back().answers = {answering<AllTouches>("collide_all")};
    return all;
}

} // namespace boxwood::bench
