#include "trees/mesh_bvh.h"

#include "trees/queries/box_queries.h"
#include "trees/triangle_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood {
namespace {

TriangleMesh checked(TriangleMesh mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t corner : mesh.triangles[i])
            if (corner >= mesh.vertices.size())
                throw std::invalid_argument("triangle " + std::to_string(i) + " has the corner " +
                                            std::to_string(corner) + ", but there are " +
                                            std::to_string(mesh.vertices.size()) + " vertices");
    return mesh;
}

Tree tree_of(const TriangleMesh& mesh, const BuildFunction& builder, const Executor& executor) {
    return builder.build_of_mesh ? builder.build_of_mesh(mesh, executor)
                                 : builder(triangle_boxes(mesh, executor).span(), executor);
}

/// Chunks come in any order, and in each the rays ascend.
class AllHits final : public HitSink {
  public:
    void begin(std::size_t chunks, bool) override { chunks_.resize(chunks); }
    bool take(std::size_t chunk, std::uint32_t ray, std::span<const RayHit> hits) override {
        Chunk& to = chunks_[chunk];
        to.hits.insert(to.hits.end(), hits.begin(), hits.end());
        to.rays.push_back({ray, hits.size()});
        return true;
    }
    void end() override {}

    AnswersOf<RayHit> answers(std::size_t n_rays) const {
        AnswersOf<RayHit> all{std::vector<std::uint64_t>(n_rays + 1), {}};
        for (const Chunk& chunk : chunks_) {
            for (const auto& [ray, n] : chunk.rays)
                all.offsets[ray + 1] = n;
            all.of.insert(all.of.end(), chunk.hits.begin(), chunk.hits.end());
        }
        for (std::size_t i = 0; i < n_rays; ++i)
            all.offsets[i + 1] += all.offsets[i];
        return all;
    }

  private:
    struct Chunk {
        std::vector<RayHit> hits;
        std::vector<std::pair<std::uint32_t, std::size_t>> rays;
    };
    std::vector<Chunk> chunks_;
};

} // namespace

struct MeshBvh::State {
    State(TriangleMesh of, const MeshBvhOptions& options, const Executor& executor)
        : mesh(checked(std::move(of))),
          layout(layout_entry_of(options.layout)
                     .make(tree_of(mesh, options.builder, executor), executor)),
          triangles(layout->triangles(mesh, executor)) {}

    TriangleMesh mesh;
    std::unique_ptr<AnyLayout> layout;
    TriangleBlocks triangles;

    /// What closed meshes are asked, made when it is.
    struct Closed {
        std::size_t open_edges = 0;
        std::unique_ptr<AnyLayout> boxes; ///< where `layout` holds parts of triangles
    };
    const Closed& closed() const {
        std::call_once(closed_made_, [&] {
            closed_.open_edges = boxwood::open_edges(mesh);
            if (!layout->answers(Query::regions)) {
                Tree tree;
                closed_.boxes = make_layout(layout_entry_of(LayoutName::wide8), BinnedSahBuilder{},
                                            triangle_boxes(mesh, serial()).span(), serial(), tree);
            }
        });
        return closed_;
    }

  private:
    mutable std::once_flag closed_made_;
    mutable Closed closed_;
};

MeshBvh::MeshBvh(TriangleMesh mesh, const MeshBvhOptions& options)
    : options_(options), executor_(detail::executor_of(options.executor, options.threads)) {
    if (!options.builder.build)
        throw std::invalid_argument("MeshBvhOptions::builder is empty; give a builder, such as "
                                    "BinnedSahBuilder{}");
    hold(std::make_unique<State>(std::move(mesh), options_, *executor_));
}
MeshBvh::MeshBvh(std::span<const Vec3<float>> vertices, std::span<const Corners> triangles,
                 const MeshBvhOptions& options)
    : MeshBvh(
          TriangleMesh{{vertices.begin(), vertices.end()}, {triangles.begin(), triangles.end()}},
          options) {}

MeshBvh::MeshBvh(MeshBvh&&) noexcept = default;
MeshBvh& MeshBvh::operator=(MeshBvh&& other) noexcept {
    options_ = std::move(other.options_);
    executor_ = std::move(other.executor_);
    state_ = std::move(other.state_);
    rays_.reset();
    if (other.rays_)
        rays_.emplace(std::move(*other.rays_));
    return *this;
}
MeshBvh::~MeshBvh() = default;

void MeshBvh::hold(std::unique_ptr<State> state) {
    rays_.reset();
    state_ = std::move(state);
    rays_.emplace(*state_->layout, to_string(options_.kernel), state_->triangles);
}

const TriangleMesh& MeshBvh::mesh() const { return state_->mesh; }
const AnyLayout& MeshBvh::layout() const { return *state_->layout; }

std::size_t MeshBvh::bytes() const {
    return state_->layout->bytes() + state_->triangles.bytes() +
           mesh().vertices.capacity() * sizeof(Vec3<float>) +
           mesh().triangles.capacity() * sizeof(Corners);
}

void MeshBvh::update(std::span<const Vec3<float>> vertices) {
    if (vertices.size() != mesh().vertices.size())
        throw std::invalid_argument("update: the mesh has " +
                                    std::to_string(mesh().vertices.size()) + " vertices, " +
                                    std::to_string(vertices.size()) + " are given");
    TriangleMesh moved{{vertices.begin(), vertices.end()}, mesh().triangles};
    hold(std::make_unique<State>(std::move(moved), options_, *executor_));
}

std::vector<RayHit> MeshBvh::all_hits(const Ray<float>& ray) const {
    AllHits found;
    all_hits({&ray, 1}, found);
    return found.answers(1).of;
}

void MeshBvh::closest_hits(std::span<const Ray<float>> rays, std::span<RayHit> hits) const {
    layout().rays(rays, RayQuery::closest, to_string(options_.kernel), state_->triangles,
                  *executor_, hits);
}
void MeshBvh::any_hits(std::span<const Ray<float>> rays, std::span<RayHit> hits) const {
    layout().rays(rays, RayQuery::any, to_string(options_.kernel), state_->triangles, *executor_,
                  hits);
}
void MeshBvh::all_hits(std::span<const Ray<float>> rays, HitSink& sink) const {
    layout().rays_all(rays, to_string(options_.kernel), state_->triangles, *executor_, sink);
}

std::vector<RayHit> MeshBvh::closest_hits(std::span<const Ray<float>> rays) const {
    std::vector<RayHit> hits(rays.size());
    closest_hits(rays, hits);
    return hits;
}
std::vector<RayHit> MeshBvh::any_hits(std::span<const Ray<float>> rays) const {
    std::vector<RayHit> hits(rays.size());
    any_hits(rays, hits);
    return hits;
}
AnswersOf<RayHit> MeshBvh::all_hits(std::span<const Ray<float>> rays) const {
    AllHits found;
    all_hits(rays, found);
    return found.answers(rays.size());
}

std::optional<SurfacePoint> MeshBvh::closest_point(Vec3<float> point) const {
    const SurfacePoint found = closest_points({&point, 1}).front();
    return found.triangle == Neighbour::none ? std::nullopt : std::optional(found);
}
std::vector<SurfacePoint> MeshBvh::closest_points(std::span<const Vec3<float>> points) const {
    std::vector<SurfacePoint> found(points.size());
    layout().closest_points(points, mesh(), *executor_, found);
    return found;
}

std::size_t MeshBvh::open_edges() const { return state_->closed().open_edges; }

std::vector<Side> MeshBvh::sides(std::span<const Vec3<float>> points) const {
    const State::Closed& closed = state_->closed();
    if (closed.open_edges > 0)
        throw std::invalid_argument("the mesh is not closed, so that nothing is inside it: " +
                                    std::to_string(closed.open_edges) +
                                    " of its edges have an odd number of triangles");
    std::vector<Side> found(points.size());
    boxwood::sides(closed.boxes ? *closed.boxes : layout(), mesh(), points, *executor_, found);
    return found;
}
Side MeshBvh::side(Vec3<float> point) const { return sides({&point, 1}).front(); }

std::vector<double> MeshBvh::signed_distances(std::span<const Vec3<float>> points) const {
    const std::vector<Side> where = sides(points);
    const std::vector<SurfacePoint> nearest = closest_points(points);
    std::vector<double> distances(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        // What rounds to nothing is something yet.
        const double d = std::max(std::sqrt(nearest[i].squared_distance),
                                  std::numeric_limits<double>::denorm_min());
        distances[i] = where[i] == Side::on_surface ? 0 : where[i] == Side::inside ? -d : d;
    }
    return distances;
}
double MeshBvh::signed_distance(Vec3<float> point) const {
    return signed_distances({&point, 1}).front();
}

} // namespace boxwood
