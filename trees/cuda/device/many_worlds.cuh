#pragma once

// DeviceWorlds, a part of tree.cu.

#include "trees/cuda/device/counted.cuh"
#include "trees/cuda/queries/worlds.cuh"
#include "trees/detail/device_tree.h"

#include <algorithm>

namespace boxwood::cuda {

__global__ void begin_centres(Centres* centres) { *centres = no_centres(); }

/// A thread per world, and one more: where its pairs begin, of those of each slot.
__global__ void begin_of_worlds(const std::uint64_t* at, const std::uint32_t* first,
                                std::uint32_t n_worlds, std::uint64_t* to) {
    const std::uint64_t world = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (world <= n_worlds)
        to[world] = at[first[world]];
}

class WorldsThere final : public detail::DeviceWorldsTree {
  public:
    WorldsThere(std::span<const std::uint32_t> first, const DevicePlace& place)
        : in_(place), n_worlds_(number_of_queries(first.size() - 1)), first_(first, place) {}

    std::size_t size() const override { return n_; }

    void build(DeviceSpan<const Box> boxes) override {
        const Chosen chosen(in_.place.index);
        n_ = 0;
        require_at_most_max_items(boxes.size);
        if (boxes.size == 0)
            return;
        reserve(boxes.size);
        require_valid_there(boxes);
        const auto n = static_cast<std::uint32_t>(boxes.size);
        worlds_ = {n_worlds_, first_.span().data, boxes.data, codes_.data(), items_.data()};
        tree_ = {n, leaves_.data(), items_.data(), nodes_.data(), root_.data()};
        order_worlds(worlds_, n, in_.stream);
        make_radix_tree(tree_, codes_.data(), boxes.data, met_.data(), in_.stream);
        n_ = n;
    }

    DeviceAnswersOf<Pair> pairs() override {
        const Chosen chosen(in_.place.index);
        DeviceAnswersOf<Pair> found{
            DeviceArray<std::uint64_t>(std::size_t{n_worlds_} + 1, in_.place), {}};
        std::uint64_t* const begin = found.offsets.span().data;
        if (n_ == 0) {
            fill_bytes(begin, 0, found.offsets.size_bytes(), in_.stream);
            return found;
        }
        Counted count = counted(n_, in_, [&](std::uint64_t* at) {
            find_world_pairs<Pass::count>(worlds_, tree_, {at, nullptr, 0}, in_.stream);
        });
        std::uint64_t* const at = count.at.span().data;
        launch(in_.stream, blocks_for(found.offsets.size(), radix_threads), radix_threads,
               begin_of_worlds, at, first_.span().data, n_worlds_, begin);
        found.of = DeviceArray<Pair>(count.n, in_.place);
        if (count.n > 0)
            find_world_pairs<Pass::fill>(worlds_, tree_, {at, found.of.span().data, 0}, in_.stream);
        return found;
    }

  private:
    void reserve(std::size_t n) {
        if (nodes_.size() >= n)
            return;
        const std::size_t bytes_a_box = sizeof(*codes_.data()) + sizeof(*items_.data()) +
                                        sizeof(*met_.data()) + sizeof(Box) + sizeof(RadixNode);
        require_memory("a tree of worlds",
                       n * bytes_a_box + sizeof(Centres) + sizeof(*root_.data()));
        make_room(codes_, n, in_.stream);
        make_room(items_, n, in_.stream);
        make_room(met_, n, in_.stream);
        make_room(leaves_, n, in_.stream);
        make_room(root_, 1, in_.stream);
        make_room(centres_, 1, in_.stream);
        make_room(nodes_, n, in_.stream); // the last, by which one knows of all
    }
    void require_valid_there(DeviceSpan<const Box> boxes) {
        launch(in_.stream, 1, 1, begin_centres, centres_.data());
        launch(in_.stream,
               std::min<std::size_t>(blocks_for(boxes.size, code_threads), max_measure_blocks),
               code_threads, measure_centres, boxes.data, static_cast<std::uint32_t>(boxes.size),
               centres_.data());
        const std::uint32_t bad =
            number_at(static_cast<const Centres*>(centres_.data()), in_.stream).first_bad;
        if (bad != none_bad)
            require_valid(number_at(boxes.data + bad, in_.stream), bad);
    }

    Workplace in_;
    std::uint32_t n_worlds_, n_ = 0;
    DeviceArray<std::uint32_t> first_;
    Array<std::uint64_t> codes_;
    Array<std::uint32_t> items_, met_, root_;
    Array<Box> leaves_;
    Array<Centres> centres_;
    Array<RadixNode> nodes_;
    WorldsView worlds_;
    RadixTreeView tree_;
};

} // namespace boxwood::cuda

namespace boxwood::detail {

std::unique_ptr<DeviceWorldsTree> make_device_worlds(std::span<const std::uint32_t> first,
                                                     const DevicePlace& place) {
    const cuda::Chosen chosen(place.index); // says if there is none
    return std::make_unique<cuda::WorldsThere>(first, place);
}

} // namespace boxwood::detail
