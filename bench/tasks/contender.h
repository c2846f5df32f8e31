#pragma once

#include "kernels/continuous/continuous_kernel.h"
#include "kernels/triangle_distance/distance_kernel.h"
#include "kernels/decision.h"
#include "scenes/scene.h"
#include "trees/layout.h"
#include "trees/queries/pairs.h"
#include "trees/tree.h"
#include "trees/inspect/work.h"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {
struct Frame; // scenes/moving/frames.h
}

namespace boxwood::bench {

/// What is wanted of a scene.
enum class Ask : std::uint8_t {
    pairs,          ///< every unordered overlapping pair of the scene's boxes
    tree_pairs,     ///< every overlapping pair between the first half of the boxes and the rest
    rays_closest,   ///< for each ray the nearest triangle
    rays_any,       ///< for each ray whether it meets a triangle
    triangle_pairs, ///< every unordered pair of the scene's triangles that share a point
    moving_pairs,   ///< frame after frame: take the new boxes, then every overlapping pair
    tree,           ///< a binary tree of the boxes and nothing else: builders alone
    rays_all,       ///< for each ray every triangle
    points,         ///< for each point every box that contains it
    regions,        ///< for each region every box that shares a point with it
    nearest,        ///< for each point the nearest boxes
    closest_points, ///< for each point the nearest point of the mesh
    scene_queries,     ///< frame after frame of a moving scene: all that its file asks for

    // Of the cases of a hard-case family, one answer each: the families of kernels.
    triangle_triangle, ///< do two triangles share a point
    triangle_distance, ///< their least distance
    segment_segment,   ///< the least distance of an edge of each
    point_triangle,    ///< the least distance of a corner of one to the other
    point_segment,     ///< the least distance of a corner of one to an edge of the other
    ray_triangle,      ///< where a ray meets a triangle, or the nearest of a fan
    ray_box,           ///< whether a ray meets a box
    vertex_face,       ///< whether and when a moving vertex touches a moving triangle
    edge_edge,         ///< whether and when two moving edges touch
    obb_obb,           ///< whether two boxes in any pose share a point
    box_fit            ///< the axis-aligned box of a transformed box
};
struct AskEntry {
    Ask task;
    std::string_view name, summary;
};
std::span<const AskEntry> asks();
std::string_view to_string(Ask ask);
std::optional<Ask> ask_of(std::string_view name);
/// Whether it is asked frame after frame of a moving scene.
inline bool is_moving_ask(Ask ask) { return ask == Ask::moving_pairs || ask == Ask::scene_queries; }
/// Whether it is asked of the scene's cases (`Scene::cases`), not of its boxes or mesh.
inline bool is_kernel_ask(Ask ask) { return ask >= Ask::triangle_triangle; }
/// Whether a whole query decides about triangles by a kernel that can be chosen.
inline bool takes_kernel(Ask ask) {
    return ask == Ask::rays_closest || ask == Ask::rays_any || ask == Ask::rays_all ||
           ask == Ask::triangle_pairs;
}
inline bool is_ray_ask(Ask ask) {
    return ask == Ask::rays_closest || ask == Ask::rays_any || ask == Ask::rays_all;
}
/// Whether it is asked of `Scene::points` or `Scene::regions`.
inline bool is_point_ask(Ask ask) {
    return ask == Ask::points || ask == Ask::regions || ask == Ask::nearest ||
           ask == Ask::closest_points;
}

/// The items of `tree_pairs`: boxes [0, n/2) against [n/2, n). In its answers a < n/2 <= b, both
/// indices of the whole scene.
inline std::size_t tree_pairs_split(std::size_t n) { return n / 2; }

/// One piece of work: a scene, a question, and where it runs.
struct Job {
    const Scene* scene = nullptr;
    Ask task = Ask::pairs;
    std::string executor = "serial"; ///< a word of executors()
    unsigned threads = 1;
};

/// The buffers that every contender answers into; the caller reserves them before timing and clears
/// them between queries. Pairs may come in any order, but each pair once and lower item first.
struct Answers {
    std::vector<Pair> pairs;                  ///< of rays_all, points and regions: (query, item)
    std::vector<Neighbour> neighbours;        ///< nearest: Scene::k of each point
    std::vector<SurfacePoint> surface_points; ///< closest_points
    std::vector<RayHit> hits; ///< resized to the number of rays; for rays_any only hit() counts
    // Of the kernel asks, one per case, resized by the contender.
    std::vector<Decision> verdicts;   ///< triangle_triangle, ray_box, obb_obb
    std::vector<Distance> distances; ///< the four distances
    std::vector<Impact> impacts;     ///< vertex_face, edge_edge
    std::vector<Aabb<double>> boxes; ///< box_fit
};

/// What a structure is, for the tree table.
struct StructureInfo {
    std::size_t bytes = 0;
    const Tree* tree =
        nullptr; ///< ours alone: valid until the next build; empty if none was needed
    /// Of moving_pairs, ours alone: Updater::sah.
    double sah = std::numeric_limits<double>::quiet_NaN();
};

/// A work counter beyond those of Work.
struct NamedCount {
    std::string name;
    std::uint64_t value = 0;
};

/// What the bench times, ours or a peer's. The job's scene outlives it. Construction converts the
/// input to the library's own types (untimed); destruction releases devices and threads.
class Contender {
  public:
    virtual ~Contender() = default;
    /// Timed: from boxes or triangles to a structure that can answer; replaces an earlier one.
    virtual void build() = 0;
    /// Timed: answers the job into `answers`, which is cleared. Needs a build before it.
    virtual void query(Answers& answers) = 0;
    /// Timed, of moving asks: takes the next frame; a query then answers for it. The frame lives
    /// until the next update or build; after a build they come from frame 1. Of scene_queries the
    /// contender plays its own scene, and the frame given is empty.
    virtual void update(const Frame& /*frame*/) {}
    /// Untimed: the same query with its work counted, where that can be told.
    virtual std::optional<Work> counted_query(Answers&) { return std::nullopt; }
    /// Further counters of the last counted query.
    virtual std::vector<NamedCount> more_counts() const { return {}; }
    virtual std::optional<StructureInfo> structure() const { return std::nullopt; }
};

/// A registry row: one way to do a job.
struct ContenderEntry {
    std::string name;      ///< "binned_sah.wide8.self_pairs", "fcl.dynamic_aabb_tree", ...
    std::string library;   ///< boxwood, fcl, embree, cgal, bullet, brute_force
    std::string summary;   ///< one line
    std::string notes;     ///< settings, and what differs from the others' work
    std::string precision; ///< f32 | f64: storage and box arithmetic
    std::string builder, layout, traversal, kernel; ///< ours; empty where it does not apply
    bool is_peer = true;
    /// Nothing if it can do the job, else why not (recorded, not hidden).
    std::function<std::optional<std::string>(const Job&)> unsupported;
    std::function<std::unique_ptr<Contender>(const Job&)> make;
    std::string params_json = "{}";
    Promise promise = Promise::none; ///< ours, of kernel asks
};

/// One peer library: a file of bench/peers/, compiled where its package is found.
struct Peer {
    std::string name;    ///< "fcl"
    std::string summary; ///< one line
    std::string version; ///< as the library reports it
    std::string build;   ///< what is known of how it was compiled: SIMD, precision, threads
    std::vector<ContenderEntry> contenders;
};

/// The peers compiled in, and the names of those whose package was not found.
std::span<const Peer> peers();
std::span<const std::string_view> absent_peers();

/// Whether a contender answers an ask on any scene; the contenders of peers that do.
bool answers_at_all(const ContenderEntry& contender, Ask ask);
std::vector<ContenderEntry> peers_that_answer(Ask ask);

} // namespace boxwood::bench
