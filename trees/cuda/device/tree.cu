#include "trees/detail/device_tree.h"

#include "trees/cuda/builds/built_tree.cuh"
#include "trees/cuda/device/machine.h"
#include "trees/cuda/device/pair_parts.cuh"
#include "trees/cuda/queries/radix_pairs.cuh"

namespace boxwood::detail {
namespace {

using namespace cuda;

/// Of n numbers and their sum, and more than CUB asks for beside them.
constexpr std::uint64_t bytes_to_sum(std::uint64_t n) {
    return (n + 1) * sizeof(std::uint64_t) + n + (1 << 16);
}
/// By leaves of sixteen boxes.
struct Packed {
    static constexpr Form form = Form::packed;
    static constexpr std::uint64_t max_part = std::uint64_t{1} << 26; ///< pairs: half a gigabyte
    using View = cuda::PackedView;
    static const View& of(const BuiltTree& tree) { return tree.packed(); }
    static std::size_t leaves(const View& view) { return view.leaves(); }

    template <bool is_self, Pass pass>
    static void find(const View& a, const View& b, const PairsTo& to, Stream stream) {
        find_packed_pairs<is_self, pass>(a, b, to, stream);
    }
    template <bool is_self>
    static void fill(const View& a, const View& b, const PairPart& part, std::uint64_t* at,
                     Pair* pairs, Stream stream) {
        fill_part<is_self>(a, b, part, at, pairs, stream);
    }
};

/// By leaves of one box.
struct Radix {
    static constexpr Form form = Form::radix;
    static constexpr std::uint64_t max_part = std::uint64_t{1} << 40; ///< there is but one
    using View = RadixTreeView;
    static const View& of(const BuiltTree& tree) { return tree.radix(); }
    static std::size_t leaves(const View& view) { return view.n; }

    template <bool is_self, Pass pass>
    static void find(const View& a, const View& b, const PairsTo& to, Stream stream) {
        find_radix_pairs<is_self, pass, Walk::stack>(a, b, to, stream);
    }
    template <bool is_self>
    static void fill(const View& a, const View& b, const PairPart& part, std::uint64_t* at,
                     Pair* pairs, Stream stream) {
        if (part.end_leaf - part.first_leaf < a.n)
            throw DeviceOutOfMemory(
                "the pairs of an lbvh, which come in one part (those of hilbert "
                "come in several),",
                (part.end_pair + 1) * sizeof(Pair), free_memory());
        find<is_self, Pass::fill>(a, b, {at, pairs, 0}, stream);
    }
};

template <class Layout> class TreeOf final : public DeviceTree {
  public:
    explicit TreeOf(const DevicePlace& place) : place_(place), stream_(stream_of(place)) {}

    std::size_t size() const override { return tree_.size(); }

    void build(DeviceSpan<const Box> boxes) override {
        const Chosen chosen(place_.index);
        if (boxes.size > room_) {
            require_memory("a tree", bytes(boxes.size) - bytes(room_));
            room_ = boxes.size;
        }
        tree_.build(boxes.data, boxes.size, stream_);
    }

    void refit(DeviceSpan<const Box> boxes) override {
        const Chosen chosen(place_.index);
        tree_.look(boxes.data, stream_);
        try {
            tree_.check(boxes.data, stream_);
        } catch (const InvalidBox&) {
            tree_.build(nullptr, 0, stream_);
            throw;
        }
        tree_.refit(boxes.data, stream_);
    }

    std::uint64_t count_pairs(const DeviceTree& other) override {
        const Chosen chosen(place_.index);
        return counted(other).n;
    }

    DeviceArray<Pair> pairs(const DeviceTree& other) override {
        const Chosen chosen(place_.index);
        Counted count = counted(other);
        DeviceArray<Pair> found(count.n, place_);
        if (count.n > 0)
            find<Pass::fill>(other, {count.at.data(), found.span().data, 0});
        return found;
    }

    void pairs(const DeviceTree& other, PairSink& sink) override {
        const Chosen chosen(place_.index);
        Counted count = counted(other);
        const std::vector<PairPart> parts = parts_of(count);
        std::uint64_t most = 0;
        for (const PairPart& part : parts)
            most = std::max(most, part.end_pair - part.first_pair);
        require_memory("a part of the pairs", most * sizeof(Pair));
        Array<Pair> on_device(most, stream_);
        std::vector<Pair> on_host;
        sink.begin(parts.size(), true);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            fill(other, parts[i], count.at.data(), on_device.data());
            on_host.resize(parts[i].end_pair - parts[i].first_pair);
            download(static_cast<const Pair*>(on_device.data()), std::span(on_host), stream_);
            wait(stream_);
            if (!sink.take(i, on_host))
                break;
            sink.finish(i);
        }
        sink.end();
    }

    std::uint64_t self_pairs_into(DeviceSpan<Pair> room) override {
        const Chosen chosen(place_.index);
        if (size() == 0)
            return 0;
        Array<std::uint64_t> n(1, stream_);
        fill_words(reinterpret_cast<std::uint32_t*>(n.data()), 0, 2, stream_);
        find<Pass::capped>(*this, {n.data(), room.data, room.size});
        return number_at(n.data());
    }

  private:
    using View = typename Layout::View;

    /// at[leaf] pairs come before those of that leaf.
    struct Counted {
        Array<std::uint64_t> at;
        std::uint64_t n = 0;
    };

    /// With finer codes beside the coarse ones, which a crowd of boxes may need.
    static std::size_t bytes(std::size_t n) {
        return BuiltTree::bytes({.form = Layout::form}, n) + n * 2 * sizeof(std::uint64_t);
    }

    Counted counted(const DeviceTree& other) {
        if (size() == 0 || other.size() == 0)
            return {};
        const std::size_t leaves = Layout::leaves(view(*this));
        require_memory("counting pairs", bytes_to_sum(leaves));
        Counted count{Array<std::uint64_t>(leaves + 1, stream_)};
        find<Pass::count>(other, {count.at.data(), nullptr, 0});
        scan(count.at.data(), leaves, spare_, stream_);
        count.n = number_at(count.at.data() + leaves);
        return count;
    }

    std::vector<PairPart> parts_of(const Counted& count) {
        if (count.n == 0)
            return {};
        const std::uint64_t room = std::min(Layout::max_part, free_memory() / sizeof(Pair));
        if (count.n <= room)
            return {{0, static_cast<std::uint32_t>(count.at.size() - 1), 0, count.n}};
        std::vector<std::uint64_t> at(count.at.size());
        download(count.at.data(), std::span(at), stream_);
        wait(stream_);
        return cut_into_parts(at, room);
    }

    static const View& view(const DeviceTree& tree) {
        return Layout::of(static_cast<const TreeOf&>(tree).tree_);
    }
    template <Pass pass> void find(const DeviceTree& other, const PairsTo& to) {
        if (&other == this)
            Layout::template find<true, pass>(view(*this), view(*this), to, stream_);
        else
            Layout::template find<false, pass>(view(*this), view(other), to, stream_);
    }
    void fill(const DeviceTree& other, const PairPart& part, std::uint64_t* at, Pair* pairs) {
        if (&other == this)
            Layout::template fill<true>(view(*this), view(*this), part, at, pairs, stream_);
        else
            Layout::template fill<false>(view(*this), view(other), part, at, pairs, stream_);
    }

    std::uint64_t number_at(const std::uint64_t* at) {
        std::uint64_t number = 0;
        download(at, std::span(&number, 1), stream_);
        wait(stream_);
        return number;
    }

    DevicePlace place_;
    Stream stream_;
    BuiltTree tree_{{.form = Layout::form}};
    Spare spare_;
    std::size_t room_ = 0; ///< boxes that the tree has memory for
};

} // namespace

std::unique_ptr<DeviceTree> make_device_tree(const DeviceBvhOptions& options) {
    const Chosen chosen(options.place.index); // says if there is none
    if (options.builder == DeviceBuilder::hilbert)
        return std::make_unique<TreeOf<Packed>>(options.place);
    return std::make_unique<TreeOf<Radix>>(options.place);
}

} // namespace boxwood::detail
