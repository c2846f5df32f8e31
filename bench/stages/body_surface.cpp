#include "bench/stages/body_surface.h"

#include "bench/stages/playing.h"
#include "trees/builder.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

constexpr std::size_t bodies_in_turn = 64; ///< on one thread

template <class F> void for_rows(std::size_t n, const Executor& executor, const F& f) {
    executor.for_each((n + bodies_in_turn - 1) / bodies_in_turn, [&](std::size_t r) {
        for (std::size_t i = r * bodies_in_turn; i < std::min(n, (r + 1) * bodies_in_turn); ++i)
            f(i);
    });
}

// Nanoseconds of one thread of a machine of 2023, as in OrderDegradation: for each triangle, and
// each ray.
constexpr double per_refit = 15, per_order = 60, per_ray = 700;

} // namespace

std::span<const std::array<std::uint32_t, 3>> own_triangles(const Bodies& bodies,
                                                            std::uint32_t body) {
    if (const std::uint32_t m = bodies.mesh[body]; m != no_mesh)
        return bodies.meshes[m].triangles;
    return box_triangles;
}

BodySurface::BodySurface(const Bodies& bodies, std::vector<std::uint32_t> of, bool moves,
                         const Executor& executor)
    : moves_(moves), of_(std::move(of)) {
    if (moves) {
        place_.assign(bodies.size(), none);
        for (std::uint32_t at = 0; at < of_.size(); ++at)
            place_[of_[at]] = at;
    }
    make(bodies, executor);
}

void BodySurface::write_vertices(const Bodies& bodies, std::size_t at) {
    const std::uint32_t body = of_[at];
    const auto& pose = bodies.pose[body];
    Vec3<float>* out = &mesh_.vertices[first_vertex_[at]];
    const auto write = [&](Vec3<double> own) { *out++ = static_cast<Vec3<float>>(pose(own)); };
    if (const std::uint32_t m = bodies.mesh[body]; m != no_mesh) {
        for (const Vec3<float>& vertex : bodies.meshes[m].vertices)
            write(static_cast<Vec3<double>>(vertex));
        return;
    }
    const auto low = static_cast<Vec3<double>>(bodies.rest[body].min);
    const auto high = static_cast<Vec3<double>>(bodies.rest[body].max);
    for (unsigned corner = 0; corner < 8; ++corner)
        write({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
               corner & 4 ? high.z : low.z});
}

void BodySurface::make(const Bodies& bodies, const Executor& executor) {
    first_vertex_.assign(1, 0);
    first_triangle_.assign(1, 0);
    for (const std::uint32_t body : of_) {
        const bool is_there = bodies.present[body] != 0;
        const std::uint32_t m = bodies.mesh[body];
        const std::size_t vertices = m == no_mesh ? 8 : bodies.meshes[m].vertices.size();
        first_vertex_.push_back(first_vertex_.back() +
                                static_cast<std::uint32_t>(is_there ? vertices : 0));
        first_triangle_.push_back(
            first_triangle_.back() +
            static_cast<std::uint32_t>(is_there ? own_triangles(bodies, body).size() : 0));
    }
    mesh_.vertices.resize(first_vertex_.back());
    mesh_.triangles.resize(first_triangle_.back());
    std::vector<Box> boxes(mesh_.triangles.size());
    for_rows(of_.size(), executor, [&](std::size_t at) {
        if (bodies.present[of_[at]] == 0)
            return;
        write_vertices(bodies, at);
        const std::uint32_t first = first_vertex_[at];
        std::size_t out = first_triangle_[at];
        for (const auto& t : own_triangles(bodies, of_[at])) {
            mesh_.triangles[out] = {first + t[0], first + t[1], first + t[2]};
            boxes[out] = mesh_.triangle(out).bounds();
            ++out;
        }
    });
    Tree tree;
    layout_ = make_layout(find_layout(moves_ ? "packed" : "wide8"),
                          make_builder(moves_ ? "hilbert" : "binned_sah"), boxes, executor, tree);
    blocks_ = layout_->triangles(mesh_, executor);
}

std::size_t BodySurface::follow(const Bodies& bodies, std::span<const std::uint32_t> changed,
                                std::size_t rays, const Executor& executor) {
    const std::size_t all = mesh_.triangles.size();
    const auto is_there = [&](std::uint32_t at) {
        return first_vertex_[at + 1] > first_vertex_[at];
    };
    bool is_rebuild = std::ranges::any_of(changed, [&](std::uint32_t body) {
        return (bodies.present[body] != 0) != is_there(place_[body]);
    });
    // The cost of an order, and what rays lose, for each triangle.
    const double n = static_cast<double>(std::max<std::size_t>(all, 1));
    const double query = per_ray * static_cast<double>(rays) / n;
    if (!is_rebuild && !has_degradation_) {
        refit_.start(blocks_, all);
        fresh_ = refit_.surface(blocks_);
        degradation_.start(per_order - per_refit, query);
        has_degradation_ = true;
    }
    if (!is_rebuild && !degradation_.is_due_next()) {
        std::size_t written = 0;
        for_rows(changed.size(), executor,
                 [&](std::size_t i) { write_vertices(bodies, place_[changed[i]]); });
        for (const std::uint32_t body : changed) {
            const std::uint32_t at = place_[body];
            refit_.note(first_triangle_[at], first_triangle_[at + 1]);
            written += first_triangle_[at + 1] - first_triangle_[at];
        }
        refit_.refit(blocks_, mesh_, executor);
        degradation_.degraded(fresh_ > 0 ? refit_.surface(blocks_) / fresh_ : 1);
        if (!degradation_.is_due())
            return written;
    }
    make(bodies, executor);
    if (has_degradation_) {
        refit_.start(blocks_, mesh_.triangles.size());
        fresh_ = refit_.surface(blocks_);
        degradation_.reordered(per_order - per_refit, query);
    }
    return mesh_.triangles.size();
}

void BodySurface::hits(std::span<const Ray<float>> rays, const Executor& executor,
                       std::span<RayHit> out) const {
    layout_->rays(rays, RayQuery::closest, "watertight", blocks_, executor, out);
}

std::pair<std::uint32_t, std::uint32_t> BodySurface::place_of(std::uint32_t triangle) const {
    const auto after = std::ranges::upper_bound(first_triangle_, triangle);
    const auto at = static_cast<std::size_t>(after - first_triangle_.begin()) - 1;
    return {of_[at], triangle - first_triangle_[at]};
}

std::size_t BodySurface::bytes() const {
    return bytes_of(of_) + bytes_of(place_) + bytes_of(first_vertex_) + bytes_of(first_triangle_) +
           bytes_of(mesh_.vertices) + bytes_of(mesh_.triangles) + layout_->bytes() +
           blocks_.bytes() + refit_.bytes();
}

} // namespace boxwood::bench
