#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"
#include "kernels/registry.h"
#include "trees/builder.h"
#include "trees/builders/binned_sah.h"
#include "trees/layout.h"
#include "trees/queries/answers.h"
#include "trees/queries/sides.h"
#include "trees/queries/single_rays.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace boxwood {

/// A builder that sees triangles (SpatialSahBuilder) is given them.
struct MeshBvhOptions {
    BuildFunction builder = BinnedSahBuilder{};
    LayoutName layout = LayoutName::wide8;
    RayKernelName kernel = RayKernelName::watertight;
    unsigned threads = 1;
    std::shared_ptr<const Executor> executor = nullptr; ///< one of your own, instead of threads
};

/// The triangles of a mesh, for rays (trees/queries/rays.h says what they may be) and nearest
/// points. Throws InvalidBox for the first triangle with a coordinate that is not finite,
/// std::invalid_argument for one of 2^126 or more, for a triangle with a vertex that is not there
/// and for options that make no sense, and std::length_error for more than max_items triangles.
///
/// Threads: any number of them may call const members of one MeshBvh at the same time; who calls
/// update() is alone with it meanwhile.
class MeshBvh {
  public:
    using Corners = std::array<std::uint32_t, 3>; ///< the vertices of a triangle

    explicit MeshBvh(TriangleMesh mesh = {}, const MeshBvhOptions& options = {});
    MeshBvh(std::span<const Vec3<float>> vertices, std::span<const Corners> triangles,
            const MeshBvhOptions& options = {});
    MeshBvh(MeshBvh&&) noexcept;
    MeshBvh& operator=(MeshBvh&&) noexcept;
    ~MeshBvh();

    const TriangleMesh& mesh() const;
    std::size_t size() const { return mesh().triangles.size(); } ///< triangles
    const MeshBvhOptions& options() const { return options_; }
    std::size_t bytes() const;

    /// The vertices moved: as many as there were, else std::invalid_argument. The tree is built
    /// again. After an exception it is as before.
    void update(std::span<const Vec3<float>> vertices);

    /// The hit with the least t, ties to the lowest triangle, of one ray at a time at full speed;
    /// whether there is a hit; every hit, by t and then by triangle.
    std::optional<RayHit> closest_hit(const Ray<float>& ray) const {
        const RayHit hit = rays_->closest(ray);
        return hit.hit() ? std::optional(hit) : std::nullopt;
    }
    bool any_hit(const Ray<float>& ray) const { return rays_->any(ray); }
    std::vector<RayHit> all_hits(const Ray<float>& ray) const;

    /// Of many, which take turns on the threads of the options: hits[i] answers rays[i], a miss has
    /// no_triangle. any_hits: some hit.
    std::vector<RayHit> closest_hits(std::span<const Ray<float>> rays) const;
    std::vector<RayHit> any_hits(std::span<const Ray<float>> rays) const;
    AnswersOf<RayHit> all_hits(std::span<const Ray<float>> rays) const;
    /// Into memory of one's own: hits.size() == rays.size(), else std::invalid_argument.
    void closest_hits(std::span<const Ray<float>> rays, std::span<RayHit> hits) const;
    void any_hits(std::span<const Ray<float>> rays, std::span<RayHit> hits) const;
    void all_hits(std::span<const Ray<float>> rays, HitSink& sink) const;

    /// The nearest point of the mesh; of triangles at the same distance, as it is computed, on the
    /// lowest. Nothing of an empty mesh or a point that is not finite.
    std::optional<SurfacePoint> closest_point(Vec3<float> point) const;
    /// Of many: `triangle` is Neighbour::none where there is nothing.
    std::vector<SurfacePoint> closest_points(std::span<const Vec3<float>> points) const;

    /// How many edges have an odd number of triangles, vertices at one place taken for one; found
    /// once. 0 of a closed mesh, which the following want: else they throw std::invalid_argument.
    std::size_t open_edges() const;
    /// Where a point is: exact, also in line with edges and vertices. Inside by the even-odd rule.
    Side side(Vec3<float> point) const;
    std::vector<Side> sides(std::span<const Vec3<float>> points) const;
    /// How far the mesh is, less than 0 inside: the sign is exact, and 0 is on the surface alone;
    /// infinity of an empty mesh or a point that is not finite.
    double signed_distance(Vec3<float> point) const;
    std::vector<double> signed_distances(std::span<const Vec3<float>> points) const;

    /// The part beneath, with all that it answers.
    const AnyLayout& layout() const;

  private:
    struct State; ///< at one place, as SingleRays refers to it
    void hold(std::unique_ptr<State> state);

    MeshBvhOptions options_;
    std::shared_ptr<const Executor> executor_;
    std::unique_ptr<State> state_;
    std::optional<SingleRays> rays_;
};

} // namespace boxwood
