#include "bench/stages/world_meshes.h"

#include "trees/builders/hilbert.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

std::vector<Box> triangle_boxes(std::span<const Vec3<float>> vertices,
                                std::span<const std::array<std::uint32_t, 3>> triangles) {
    std::vector<Box> boxes(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (const std::uint32_t v : triangles[i])
            boxes[i].extend(vertices[v]);
    return boxes;
}

} // namespace

WorldMeshes::WorldMeshes(const Bodies& bodies)
    : index_(bodies.size(), none), orders_(bodies.meshes.size()) {
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (bodies.mesh[i] != no_mesh) {
            index_[i] = static_cast<std::uint32_t>(meshes_.size());
            meshes_.emplace_back().body = i;
        }
    changed_in_.assign(meshes_.size(), 0);
    is_wanted_.assign(meshes_.size(), 0);
}

void WorldMeshes::note(std::span<const std::uint32_t> changed, std::uint64_t frame) {
    for (const std::uint32_t body : changed)
        if (has(body))
            changed_in_[index_[body]] = frame;
}

std::span<const std::uint32_t> WorldMeshes::want(std::span<const Pair> pairs, bool full) {
    for (const std::uint32_t i : wanted_)
        is_wanted_[i] = 0;
    wanted_.clear();
    const auto add = [&](std::uint32_t i) {
        if (is_wanted_[i] == 0) {
            is_wanted_[i] = 1;
            wanted_.push_back(i);
        }
    };
    if (full)
        for (std::uint32_t i = 0; i < meshes_.size(); ++i)
            add(i);
    else
        for (const Pair p : pairs)
            if (has(p.a) && has(p.b)) {
                add(index_[p.a]);
                add(index_[p.b]);
            }
    return wanted_;
}

std::size_t WorldMeshes::transform(const Bodies& bodies, bool full, const Executor& executor) {
    stale_.clear();
    std::size_t moved = 0;
    for (const std::uint32_t i : wanted_)
        if (full || meshes_[i].vertices_of != changed_in_[i]) {
            stale_.push_back(i);
            moved += bodies.meshes[bodies.mesh[meshes_[i].body]].vertices.size();
        }
    executor.for_each(stale_.size(), [&](std::size_t s) {
        WorldMesh& world = meshes_[stale_[s]];
        const auto& pose = bodies.pose[world.body];
        const auto& vertices = bodies.meshes[bodies.mesh[world.body]].vertices;
        world.vertices.resize(vertices.size());
        std::ranges::transform(vertices, world.vertices.begin(), [&](Vec3<float> v) {
            return static_cast<Vec3<float>>(pose(static_cast<Vec3<double>>(v)));
        });
        world.vertices_of = changed_in_[stale_[s]];
    });
    return moved;
}

std::size_t WorldMeshes::update_trees(const Bodies& bodies, bool full, const Executor& executor) {
    stale_.clear();
    std::size_t moved = 0;
    for (const std::uint32_t i : wanted_)
        if (full || meshes_[i].tree_of != meshes_[i].vertices_of) {
            stale_.push_back(i);
            const std::uint32_t mesh = bodies.mesh[meshes_[i].body];
            const auto& triangles = bodies.meshes[mesh].triangles;
            moved += triangles.size();
            if (orders_[mesh].empty() && !triangles.empty())
                orders_[mesh] = HilbertBuilder{}.order(
                    triangle_boxes(bodies.meshes[mesh].vertices, triangles), executor);
        }
    executor.for_each(stale_.size(), [&](std::size_t s) {
        WorldMesh& world = meshes_[stale_[s]];
        const std::uint32_t mesh = bodies.mesh[world.body];
        const std::vector<Box> boxes =
            triangle_boxes(world.vertices, bodies.meshes[mesh].triangles);
        if (world.tree_of == WorldMesh::never)
            world.tree.take(boxes, orders_[mesh].span(), serial());
        else
            world.tree.refit(boxes, serial());
        world.tree_of = world.vertices_of;
    });
    return moved;
}

std::size_t WorldMeshes::vertex_bytes() const {
    std::size_t bytes = bytes_of(index_) + bytes_of(meshes_) + bytes_of(changed_in_) +
                        bytes_of(is_wanted_) + bytes_of(wanted_) + bytes_of(stale_);
    for (const WorldMesh& world : meshes_)
        bytes += bytes_of(world.vertices);
    return bytes;
}

std::size_t WorldMeshes::tree_bytes() const {
    std::size_t bytes = bytes_of(orders_);
    for (const auto& order : orders_)
        bytes += order.bytes();
    for (const WorldMesh& world : meshes_)
        bytes += world.tree.bytes();
    return bytes;
}

} // namespace boxwood::bench
