#include "bench/stages/surface.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace boxwood::bench {
namespace {

/// Whether any effect is laid on each body; of the extent all_stages, all may move.
std::vector<std::uint8_t> may_move(const Playing& playing) {
    std::vector<std::uint8_t> moves(playing.scene.bodies().size(), playing.is_full());
    for (const MovingScene::Laid& laid : playing.scene.effects())
        for (const std::uint32_t body : laid.chosen)
            moves[body] = 1;
    return moves;
}

/// Whether a tree made with care of the bodies at rest, beside that of the others, is worth its
/// time. Measured, of 120,000 triangles: it takes 470 ns more per triangle, and saves 590 ns a ray
/// where all rest, 240 ns where a ray has to go through two trees.
bool is_worth_care(const Playing& playing, std::span<const std::uint8_t> moves) {
    constexpr double rays_per_triangle = 1.5;
    if (playing.is_full())
        return false;
    const Bodies& bodies = playing.scene.bodies();
    std::size_t triangles = 0;
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (moves[i] == 0 && bodies.present[i] != 0)
            triangles += own_triangles(bodies, i).size();
    const SceneFile& file = playing.scene.file();
    const std::size_t rays = query_named(file, "rays")->n * (file.frames + 1);
    return triangles > 0 &&
           static_cast<double>(rays) >= rays_per_triangle * static_cast<double>(triangles);
}

} // namespace

Surface::Surface(const Playing& playing) {
    std::vector<std::uint8_t> moves = may_move(playing);
    if (!is_worth_care(playing, moves))
        std::ranges::fill(moves, 1);
    for (const bool moving : {true, false}) {
        std::vector<std::uint32_t> of;
        for (std::uint32_t i = 0; i < moves.size(); ++i)
            if ((moves[i] != 0) == moving)
                of.push_back(i);
        if (!of.empty())
            parts_.emplace_back(playing.scene.bodies(), std::move(of), moving, playing.executor);
    }
}

std::size_t Surface::follow(const Playing& playing, std::span<const std::uint32_t> changed) {
    const std::size_t rays = query_named(playing.scene.file(), "rays")->n;
    return parts_.front().follow(playing.scene.bodies(), changed, rays, playing.executor);
}

void Surface::hits(std::span<const Ray<float>> rays, const Executor& executor,
                   std::vector<SurfaceHit>& out) const {
    out.assign(rays.size(), {});
    std::vector<RayHit> hits(rays.size());
    std::vector<Ray<float>> shorter;
    for (const BodySurface& part : parts_) {
        const bool is_last = &part == &parts_.back();
        part.hits(rays, executor, hits);
        if (!is_last)
            shorter.assign(rays.begin(), rays.end());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!hits[i].hit())
                continue;
            const auto [body, triangle] = part.place_of(hits[i].triangle);
            out[i] = std::min(out[i], {hits[i].t, body, triangle});
            if (!is_last) // closed: a hit as near may be of a lower body
                shorter[i].t_max = hits[i].t;
        }
        rays = shorter;
    }
}

std::size_t Surface::triangles() const {
    return std::transform_reduce(
        parts_.begin(), parts_.end(), std::size_t{0}, std::plus{},
        [](const BodySurface& part) { return part.mesh().triangles.size(); });
}

std::size_t Surface::bytes() const {
    return std::transform_reduce(parts_.begin(), parts_.end(), std::size_t{0}, std::plus{},
                                 [](const BodySurface& part) { return part.bytes(); });
}

namespace {

/// Follows the bodies that have changed; of the extent all_stages, it is rebuilt in every frame.
class MakeSurface final : public SceneStage {
  public:
    std::size_t start(Playing& playing) override {
        surface_.reset();
        changed_ = Changed(playing.scene.bodies().size());
        return 0;
    }
    void note_changes(const Playing& playing) override {
        if (surface_ && !playing.is_full())
            for (const std::uint32_t body : playing.changed)
                changed_.add(body);
    }
    std::size_t run(Playing& playing) override {
        if (!surface_ || playing.is_full()) {
            surface_.reset();
            surface_.emplace(playing);
            playing.surface = &*surface_;
            return surface_->triangles();
        }
        if (changed_.bodies().empty())
            return 0;
        const std::size_t written = surface_->follow(playing, changed_.bodies());
        changed_.clear();
        return written;
    }
    std::size_t bytes(const Playing&) const override { return surface_ ? surface_->bytes() : 0; }

  private:
    std::optional<Surface> surface_;
    Changed changed_{0}; ///< since the surface was made or last followed
};

} // namespace

std::unique_ptr<SceneStage> surface_stage() { return std::make_unique<MakeSurface>(); }

} // namespace boxwood::bench
