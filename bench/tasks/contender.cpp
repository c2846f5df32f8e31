#include "bench/tasks/contender.h"

#include "peers_found.h"

#include <algorithm>
#include <array>

namespace boxwood::bench {

#define BOXWOOD_DECLARE(name) Peer name##_peer();
BOXWOOD_PEERS_FOUND(BOXWOOD_DECLARE)
#undef BOXWOOD_DECLARE

namespace {

constexpr std::array ask_entries{
    AskEntry{Ask::pairs, "pairs", "every unordered overlapping pair of the scene's boxes"},
    AskEntry{Ask::tree_pairs, "tree_pairs",
             "every overlapping pair between the first half of the boxes and the rest"},
    AskEntry{Ask::rays_closest, "rays_closest", "for each ray the nearest triangle"},
    AskEntry{Ask::rays_any, "rays_any", "for each ray whether it meets a triangle"},
    AskEntry{Ask::triangle_pairs, "triangle_pairs",
             "every unordered pair of the scene's triangles that share a point"},
    AskEntry{Ask::moving_pairs, "moving_pairs",
             "frame after frame: the new boxes taken, then every overlapping pair"},
    AskEntry{Ask::tree, "tree", "a binary tree of the boxes and nothing else: builders alone"},
    AskEntry{Ask::rays_all, "rays_all", "for each ray every triangle that it meets"},
    AskEntry{Ask::points, "points", "for each point every box that contains it"},
    AskEntry{Ask::regions, "regions", "for each box or sphere every box that it meets"},
    AskEntry{Ask::nearest, "nearest", "for each point the nearest boxes"},
    AskEntry{Ask::closest_points, "closest_points", "for each point the nearest point of the mesh"},
    AskEntry{Ask::scene_queries, "scene_queries",
             "frame after frame of a moving scene: all that its file asks for"},
    AskEntry{Ask::triangle_triangle, "triangle_triangle",
             "of each case: do two triangles share a point"},
    AskEntry{Ask::triangle_distance, "triangle_distance",
             "of each case: the least distance of two triangles"},
    AskEntry{Ask::segment_segment, "segment_segment",
             "of each case: the least distance of two edges"},
    AskEntry{Ask::point_triangle, "point_triangle",
             "of each case: the least distance of a point and a triangle"},
    AskEntry{Ask::point_segment, "point_segment",
             "of each case: the least distance of a point and an edge"},
    AskEntry{Ask::ray_triangle, "ray_triangle",
             "of each case: where a ray meets a triangle or a fan"},
    AskEntry{Ask::ray_box, "ray_box", "of each case: whether a ray meets a box"},
    AskEntry{Ask::vertex_face, "vertex_face",
             "of each case: whether and when a moving vertex touches a moving triangle"},
    AskEntry{Ask::edge_edge, "edge_edge", "of each case: whether and when two moving edges touch"},
    AskEntry{Ask::obb_obb, "obb_obb", "of each case: whether two boxes in any pose share a point"},
    AskEntry{Ask::box_fit, "box_fit", "of each case: the axis-aligned box of a transformed box"},
};

} // namespace

std::span<const AskEntry> asks() { return ask_entries; }

std::string_view to_string(Ask ask) {
    return std::ranges::find(ask_entries, ask, &AskEntry::task)->name;
}

std::optional<Ask> ask_of(std::string_view name) {
    const auto found = std::ranges::find(ask_entries, name, &AskEntry::name);
    return found == ask_entries.end() ? std::nullopt : std::optional(found->task);
}

std::span<const Peer> peers() {
#define BOXWOOD_CALL(name) name##_peer(),
    static const std::vector<Peer> found{BOXWOOD_PEERS_FOUND(BOXWOOD_CALL)};
#undef BOXWOOD_CALL
    return found;
}

bool answers_at_all(const ContenderEntry& contender, Ask ask) {
    static const Scene smallest = [] {
        Scene scene;
        scene.boxes.assign(2, {{0, 0, 0}, {1, 1, 1}});
        scene.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}}};
        scene.rays.push_back({{0, 0, 1}, {0, 0, -1}});
        scene.points.push_back({0, 0, 1});
        scene.spheres.push_back({{0, 0, 1}, 1});
        return scene;
    }();
    return !contender.unsupported || !contender.unsupported(Job{&smallest, ask, "serial", 1});
}

std::vector<ContenderEntry> peers_that_answer(Ask ask) {
    std::vector<ContenderEntry> all;
    for (const Peer& peer : peers())
        for (const ContenderEntry& contender : peer.contenders)
            if (answers_at_all(contender, ask))
                all.push_back(contender);
    return all;
}

std::span<const std::string_view> absent_peers() {
#define BOXWOOD_NAME(name) #name,
    static const std::vector<std::string_view> absent{BOXWOOD_PEERS_ABSENT(BOXWOOD_NAME)};
#undef BOXWOOD_NAME
    return absent;
}

} // namespace boxwood::bench
