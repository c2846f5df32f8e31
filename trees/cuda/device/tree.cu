#include "trees/cuda/builds/built_tree.cuh"
#include "trees/cuda/device/counted.cuh"
#include "trees/cuda/device/many_worlds.cuh"
#include "trees/cuda/device/mesh.cuh"
#include "trees/cuda/device/pair_parts.cuh"
#include "trees/cuda/queries/nearest.cuh"
#include "trees/cuda/queries/packed_queries.cuh"
#include "trees/detail/device_tree.h"

namespace boxwood::detail {
namespace {

using namespace cuda;

constexpr std::uint64_t max_part = std::uint64_t{1} << 26; ///< pairs: half a gigabyte

/// By leaves of sixteen boxes; few queries are cut into parts.
struct Packed {
    static constexpr Form form = Form::packed;
    using View = cuda::PackedView;
    static View of(const BuiltTree& tree, const Box*) { return tree.packed(); }
    static std::size_t leaves(const View& view) { return view.leaves(); }

    template <bool is_self, Pass pass>
    static void find(const View& a, const View& b, const PairsTo& to, Stream stream) {
        find_packed_pairs<is_self, pass>(a, b, to, stream);
    }
    static std::uint32_t parts(const View& view, std::uint32_t n_queries) {
        return view.size(level_of_parts(view, n_queries));
    }
    template <Pass pass, class Region>
    static void find_regions(const View& view, const Region* regions, std::uint32_t n,
                             const AnswersTo<std::uint32_t>& to, Stream stream) {
        find_in_regions<pass>(view, level_of_parts(view, n), regions, n, to, stream);
    }
};

/// By leaves of one box, a thread for each query.
template <class View_> struct Binary {
    using View = View_;
    static std::uint32_t parts(const View&, std::uint32_t) { return 1; }
    template <Pass pass, class Region>
    static void find_regions(const View& view, const Region* regions, std::uint32_t n,
                             const AnswersTo<std::uint32_t>& to, Stream stream) {
        find_in_regions<pass>(view, regions, n, to, stream);
    }
};
struct Radix : Binary<RadixTreeView> {
    static constexpr Form form = Form::radix;
    static View of(const BuiltTree& tree, const Box*) { return tree.radix(); }
    static std::size_t leaves(const View& view) { return view.n; }
    template <bool is_self, Pass pass>
    static void find(const View& a, const View& b, const PairsTo& to, Stream stream) {
        find_radix_pairs<is_self, pass, Traversal::stack>(a, b, to, stream);
    }
};
struct Hploc : Binary<BinaryTree> {
    static constexpr Form form = Form::hploc;
    static View of(const BuiltTree& tree, const Box* boxes) {
        return {tree.hploc(), boxes, tree.parents()};
    }
    static std::size_t leaves(const View& view) { return view.view.n; }
    template <bool is_self, Pass pass>
    static void find(const View& a, const View& b, const PairsTo& to, Stream stream) {
        find_binary_pairs<is_self, pass>(a, b, to, stream);
    }
};

/// A thread per query: where its answers begin, of those of its parts.
__global__ void first_of_parts(const std::uint64_t* at, std::uint32_t parts, std::uint32_t n,
                               std::uint64_t* to) {
    const std::uint64_t i = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i <= n)
        to[i] = at[i * parts];
}

template <class Layout> class TreeOf final : public DeviceTree {
  public:
    explicit TreeOf(const DevicePlace& place) : in_(place) {}

    std::size_t size() const override { return tree_.size(); }

    void build(DeviceSpan<const Box> boxes) override {
        make(boxes, [&] { tree_.build(boxes.data, boxes.size, in_.stream); });
    }
    void enqueue_build(DeviceSpan<const Box> boxes) override {
        make(boxes, [&] { tree_.enqueue(boxes.data, boxes.size, in_.stream); });
    }

    void refit(DeviceSpan<const Box> boxes) override {
        const Chosen chosen(in_.place.index);
        boxes_ = boxes.data;
        tree_.look(boxes_, in_.stream);
        check();
        tree_.refit(boxes_, in_.stream);
    }
    void enqueue_refit(DeviceSpan<const Box> boxes) override {
        const Chosen chosen(in_.place.index);
        boxes_ = boxes.data;
        tree_.look(boxes_, in_.stream);
        tree_.refit(boxes_, in_.stream);
    }
    bool check() override {
        const Chosen chosen(in_.place.index);
        try {
            return tree_.check(boxes_, in_.stream);
        } catch (...) {
            clear();
            throw;
        }
    }

    std::uint64_t count_pairs(const DeviceTree& other) override {
        const Chosen chosen(in_.place.index);
        return counted_pairs(other).n;
    }

    DeviceArray<Pair> pairs(const DeviceTree& other) override {
        const Chosen chosen(in_.place.index);
        Counted count = counted_pairs(other);
        DeviceArray<Pair> found(count.n, in_.place);
        if (count.n > 0)
            find<Pass::fill>(other, {count.at.span().data, found.span().data, 0});
        return found;
    }

    void pairs(const DeviceTree& other, PairSink& sink) override {
        const Chosen chosen(in_.place.index);
        Counted count = counted_pairs(other);
        const std::vector<PairPart> parts = parts_of(count);
        std::uint64_t most = 0;
        for (const PairPart& part : parts)
            most = std::max(most, part.end_pair - part.first_pair);
        require_memory("a part of the pairs", most * sizeof(Pair));
        DeviceArray<Pair> on_device(most, in_.place);
        std::vector<Pair> on_host;
        sink.begin(parts.size(), true);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            fill(other, parts[i], count.at.span().data, on_device.span().data);
            on_host.resize(parts[i].end_pair - parts[i].first_pair);
            download(static_cast<const Pair*>(on_device.span().data), std::span(on_host),
                     in_.stream);
            wait(in_.stream);
            if (!sink.take(i, on_host))
                break;
            sink.finish(i);
        }
        sink.end();
    }

    void enqueue_self_pairs(DeviceSpan<Pair> room, std::uint64_t* count) override {
        const Chosen chosen(in_.place.index);
        fill_bytes(count, 0, sizeof(*count), in_.stream);
        if (size() > 0)
            find<Pass::capped>(*this, {count, room.data, room.size});
    }

    DeviceAnswersOf<std::uint32_t> regions(DeviceSpan<const Box> of) override {
        return in_regions(of);
    }
    DeviceAnswersOf<std::uint32_t> regions(DeviceSpan<const Vec3<float>> of) override {
        return in_regions(of);
    }

    DeviceAnswersOf<std::uint32_t> regions(DeviceSpan<const Sphere<float>> of) override {
        return in_regions(of);
    }

    DeviceArray<Neighbour> nearest(DeviceSpan<const Vec3<float>> points, std::size_t k) override {
        if constexpr (std::is_same_v<Layout, Packed>) {
            throw std::invalid_argument(
                "nearest, on a device: the builder is hilbert; lbvh and hploc answer it");
        } else {
            const Chosen chosen(in_.place.index);
            const std::uint32_t n = number_of_queries(points.size);
            if (n > 0 && k > std::min<std::uint64_t>(max_items, (std::uint64_t{1} << 58) / n))
                throw std::length_error("nearest, on a device: " + std::to_string(k) +
                                        " items for each point are too many");
            DeviceArray<Neighbour> found(n * k, in_.place);
            find_nearest(view(*this), points.data, n, static_cast<std::uint32_t>(k),
                         found.span().data, in_.stream);
            return found;
        }
    }

  private:
    using View = typename Layout::View;

    /// With finer codes beside the coarse ones, which a crowd of boxes may need.
    static std::size_t bytes(std::size_t n) {
        return BuiltTree::bytes({.form = Layout::form}, n) + n * 2 * sizeof(std::uint64_t);
    }

    template <class Build> void make(DeviceSpan<const Box> boxes, const Build& build) {
        if (boxes.size == 0 && size() == 0)
            return;
        const Chosen chosen(in_.place.index);
        try {
            if (boxes.size > room_)
                require_memory("a tree", bytes(boxes.size) - bytes(room_));
            boxes_ = boxes.data;
            build();
            room_ = std::max(room_, boxes.size);
        } catch (...) {
            clear();
            throw;
        }
    }
    void clear() {
        if (size() > 0)
            tree_.build(nullptr, 0, in_.stream);
    }

    Counted counted_pairs(const DeviceTree& other) {
        if (size() == 0 || other.size() == 0)
            return {};
        return counted(Layout::leaves(view(*this)), in_, [&](std::uint64_t* at) {
            find<Pass::count>(other, {at, nullptr, 0});
        });
    }

    std::vector<PairPart> parts_of(const Counted& count) {
        if (count.n == 0)
            return {};
        const std::uint64_t free = free_memory(max_part * sizeof(Pair) * 2);
        const std::uint64_t room = std::min(max_part, (free - free / 8) / sizeof(Pair));
        if (count.n <= room)
            return {{0, static_cast<std::uint32_t>(count.at.size() - 1), 0, count.n}};
        return cut_into_parts(count.at.to_host(), room);
    }

    View view(const DeviceTree& tree) const {
        const auto& of = static_cast<const TreeOf&>(tree);
        return Layout::of(of.tree_, of.boxes_);
    }
    template <Pass pass> void find(const DeviceTree& other, const PairsTo& to) {
        if (&other == this)
            Layout::template find<true, pass>(view(*this), view(*this), to, in_.stream);
        else
            Layout::template find<false, pass>(view(*this), view(other), to, in_.stream);
    }
    void fill(const DeviceTree& other, const PairPart& part, std::uint64_t* at, Pair* pairs) {
        if (&other == this)
            fill_part<true>(view(*this), view(*this), part, at, pairs, in_.stream);
        else
            fill_part<false>(view(*this), view(other), part, at, pairs, in_.stream);
    }

    template <class Region> DeviceAnswersOf<std::uint32_t> in_regions(DeviceSpan<const Region> of) {
        const Chosen chosen(in_.place.index);
        const std::uint32_t n = number_of_queries(of.size);
        if (size() == 0) {
            DeviceArray<std::uint64_t> none(std::size_t{n} + 1, in_.place);
            fill_bytes(none.span().data, 0, none.size() * sizeof(std::uint64_t), in_.stream);
            return {std::move(none), {}};
        }
        const View tree = view(*this);
        const std::uint32_t parts = Layout::parts(tree, n);
        auto found = count_and_fill<std::uint32_t>(
            std::size_t{n} * parts, in_, [&]<Pass pass>(const AnswersTo<std::uint32_t>& to) {
                Layout::template find_regions<pass>(tree, of.data, n, to, in_.stream);
            });
        sort_answers(found.offsets.span().data, n, found.of.span().data, in_.stream, parts);
        if (parts > 1) {
            DeviceArray<std::uint64_t> offsets(std::size_t{n} + 1, in_.place);
            launch(in_.stream, blocks_for(offsets.size(), radix_threads), radix_threads,
                   first_of_parts, found.offsets.span().data, parts, n, offsets.span().data);
            found.offsets = std::move(offsets);
        }
        return found;
    }

    Workplace in_;
    BuiltTree tree_{{.form = Layout::form}};
    const Box* boxes_ = nullptr; ///< that it was last made of, or fitted to
    std::size_t room_ = 0;       ///< boxes that the tree has memory for
};

} // namespace

std::unique_ptr<DeviceTree> make_device_tree(const DeviceBvhOptions& options) {
    const Chosen chosen(options.place.index); // says if there is none
    switch (options.builder) {
    case DeviceBuilder::hilbert:
        return std::make_unique<TreeOf<Packed>>(options.place);
    case DeviceBuilder::lbvh:
        return std::make_unique<TreeOf<Radix>>(options.place);
    case DeviceBuilder::hploc:
        return std::make_unique<TreeOf<Hploc>>(options.place);
    }
    throw std::invalid_argument("no such DeviceBuilder");
}

} // namespace boxwood::detail
