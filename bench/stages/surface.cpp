#include "bench/stages/surface.h"

#include "trees/builder.h"

#include <algorithm>
#include <optional>

namespace boxwood::bench {
namespace {

void add_vertices(TriangleMesh& mesh, const Bodies& bodies, std::uint32_t body) {
    const auto& pose = bodies.pose[body];
    const auto add = [&](Vec3<double> own) {
        mesh.vertices.push_back(static_cast<Vec3<float>>(pose(own)));
    };
    if (const std::uint32_t m = bodies.mesh[body]; m != no_mesh) {
        for (const Vec3<float>& vertex : bodies.meshes[m].vertices)
            add(static_cast<Vec3<double>>(vertex));
        return;
    }
    const auto low = static_cast<Vec3<double>>(bodies.rest[body].min);
    const auto high = static_cast<Vec3<double>>(bodies.rest[body].max);
    for (unsigned corner = 0; corner < 8; ++corner)
        add({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
             corner & 4 ? high.z : low.z});
}

} // namespace

TriangleMesh surface_mesh(const Bodies& bodies, std::vector<std::uint32_t>& first_triangle) {
    TriangleMesh mesh;
    first_triangle.clear();
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        first_triangle.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
        if (!bodies.present[i])
            continue;
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        add_vertices(mesh, bodies, i);
        const auto add = [&](const std::array<std::uint32_t, 3>& t) {
            mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        };
        if (const std::uint32_t m = bodies.mesh[i]; m != no_mesh)
            std::ranges::for_each(bodies.meshes[m].triangles, add);
        else
            std::ranges::for_each(box_triangles, add);
    }
    first_triangle.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    return mesh;
}

Surface::Surface(const Bodies& bodies, bool moves, const Executor& executor)
    : mesh_(surface_mesh(bodies, first_triangle_)) {
    std::vector<Box> boxes(mesh_.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        boxes[i] = mesh_.triangle(i).bounds();
    Tree tree;
    layout_ = make_layout(*find_layout(moves ? "packed" : "wide8"),
                          make_builder(moves ? "hilbert" : "binned_sah"), boxes, executor, tree);
    blocks_ = layout_->triangles(mesh_, executor);
}

void Surface::hits(std::span<const Ray<float>> rays, const Executor& executor,
                   std::vector<SurfaceHit>& out) const {
    std::vector<RayHit> hits(rays.size());
    layout_->rays(rays, RayQuery::closest, "watertight", blocks_, executor, hits);
    out.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        out[i] = {};
        if (!hits[i].hit())
            continue;
        const auto after = std::ranges::upper_bound(first_triangle_, hits[i].triangle);
        const auto body = static_cast<std::uint32_t>(after - first_triangle_.begin() - 1);
        out[i] = {hits[i].t, body, hits[i].triangle - first_triangle_[body]};
    }
}

std::size_t Surface::bytes() const {
    return bytes_of(first_triangle_) + bytes_of(mesh_.vertices) + bytes_of(mesh_.triangles) +
           layout_->bytes() + blocks_.bytes();
}

namespace {

/// Made anew in a frame in which something has changed.
class MakeSurface final : public SceneStage {
  public:
    std::size_t start(Playing&) override {
        surface_.reset();
        return 0;
    }
    std::size_t run(Playing& playing) override {
        if (surface_ && playing.still_holds(made_in_))
            return 0;
        const bool moves = playing.is_everything() || !playing.scene.effects().empty();
        surface_.reset();
        surface_.emplace(playing.scene.bodies(), moves, playing.executor);
        made_in_ = playing.scene.frame();
        playing.surface = &*surface_;
        return surface_->triangles();
    }
    std::size_t bytes(const Playing&) const override { return surface_ ? surface_->bytes() : 0; }

  private:
    std::optional<Surface> surface_;
    std::uint64_t made_in_ = 0;
};

} // namespace

std::unique_ptr<SceneStage> surface_stage() { return std::make_unique<MakeSurface>(); }

} // namespace boxwood::bench
