#pragma once

#include "trees/cuda/builds/codes.cuh"
#include "trees/cuda/builds/collapse.cuh"
#include "trees/cuda/builds/hploc.cuh"
#include "trees/cuda/builds/packed_refit.cuh"

#include <stdexcept>
#include <type_traits>

namespace boxwood::cuda {

/// What a tree on the device is.
enum class Form : std::uint8_t {
    packed,      ///< sixteen wide, without pointers: for pairs and regions
    radix,       ///< binary, by the codes
    hploc,       ///< binary, by area
    radix_wide8, ///< eight wide, of either of these: for rays
    hploc_wide8
};

struct BuildOptions {
    Form form = Form::packed;
    Curve curve = Curve::hilbert;
    bool refits_some = false; ///< packed: knows each item's slot
};

/// What the device finds out while it builds.
struct BuildState {
    Centres centres;
    std::uint32_t crowded;
    CodeRule rule;
    std::uint32_t root, n_nodes;
    Box bounds;
    CollapseRoom::Levels levels;
};

/// A tree in the device's memory, and all that its build needs. The boxes stay the caller's. Once
/// it was built, enqueue() and refit() allocate nothing while n is no more than it was, so that a
/// graph may capture them; nothing that it captured moves before n grows, and the views stay what
/// they are while n is the same.
class BuiltTree {
  public:
    explicit BuiltTree(BuildOptions options = {}) : options_(options) {}

    /// Of n boxes in the device's memory; waits for it. Throws InvalidBox for the first bad one, as
    /// the CPU does, and std::length_error for more than max_items; then it has no items.
    void build(const Box* boxes, std::size_t n, Stream stream);

    /// The same without waiting. Of bad boxes comes a tree with wrong answers, which nothing else
    /// suffers from; check() finds them.
    void enqueue(const Box* boxes, std::size_t n, Stream stream);
    /// Waits, and throws as build(). False if so many boxes have the same codes that build() would
    /// take finer ones, from then on: the tree is right, but slow.
    bool check(const Box* boxes, Stream stream);

    /// New boxes for the items where they are: for all of them, or for those named (packed with
    /// refits_some alone, else std::logic_error). Valid ones, or check() finds them after look().
    void refit(const Box* boxes, Stream stream);
    void refit(const Box* boxes, const std::uint32_t* moved, std::size_t n_moved, Stream stream);
    void look(const Box* boxes, Stream stream);

    Form form() const { return options_.form; }
    std::size_t size() const { return n_; }
    /// What a tree of n items takes on the device, with what CUB sorts in.
    static std::size_t bytes(const BuildOptions& options, std::size_t n);

    /// Of the form that it has.
    const PackedView& packed() const { return packed_; }
    const RadixTreeView& radix() const { return radix_; }
    const BinaryView& hploc() const { return hploc_; }
    /// Of hploc: find_parents.
    const std::uint32_t* parents() const { return parents_.data(); }
    const Wide8View& wide8() const { return wide8_.view; }
    /// Of all items; packed and wide8 alone.
    const Box* bounds() const { return &state_.data()->bounds; }

  private:
    bool is_packed() const { return options_.form == Form::packed; }
    bool is_wide8() const { return options_.form >= Form::radix_wide8; }
    bool is_radix() const {
        return options_.form == Form::radix || options_.form == Form::radix_wide8;
    }
    template <class Visit> void each_array(std::size_t n, const Visit& visit);
    void reserve(std::size_t n, Stream stream);
    void set_views();
    void forget() {
        n_ = 0;
        packed_ = {};
        radix_ = {};
        hploc_ = {};
        wide8_ = {};
    }
    template <int bits, class Code>
    void sort_codes(const Box* boxes, Array<Code>& codes, Array<Code>& sorted, Spare& spare,
                    Stream stream);
    template <class Node> void make_wide8(const Node* nodes, const Box* boxes, Stream stream);

    BuildOptions options_;
    std::uint32_t n_ = 0;
    bool is_fine_ = false; ///< of packed: by 21 bits per axis

    Array<BuildState> state_;
    Spare spare_, fine_spare_; ///< two, as a graph may have recorded what is done with one
    Array<std::uint32_t> coarse_, sorted_coarse_, unsorted_, items_, met_;
    Array<std::uint64_t> fine_, sorted_fine_;

    Array<PackedBlock> blocks_;
    Array<std::uint32_t> block_items_, slots_, touched_;
    PackedView packed_;

    Array<Box> leaves_;
    Array<RadixNode> radix_nodes_;
    RadixTreeView radix_;

    Array<BinaryNode> hploc_nodes_;
    Array<std::uint64_t> clusters_;
    Array<std::uint32_t> parents_;
    BinaryView hploc_;

    Array<CollapseNode> collapse_nodes_;
    Array<std::uint32_t> ranks_, queue_, wide8_parents_, wide8_met_;
    Array<Wide8Node> wide8_nodes_;
    Wide8Tree wide8_;
};

/// One thread.
__global__ void begin_build(BuildState* state) {
    state->centres = no_centres();
    state->crowded = 0;
}

/// visit(array, elements, whether these are 0 at first) for all that a tree of n items has.
template <class Visit> void BuiltTree::each_array(std::size_t n, const Visit& visit) {
    const std::size_t nodes = n > 1 ? n - 1 : n;
    visit(state_, 1, false);
    visit(unsorted_, n, false);
    visit(items_, n, false);
    if (is_packed() && !is_fine_) {
        visit(coarse_, n, false);
        visit(sorted_coarse_, n, false);
    } else {
        visit(fine_, n, false);
        visit(sorted_fine_, n, false);
    }
    if (is_packed()) {
        const PackedView view = packed_levels(static_cast<std::uint32_t>(n));
        visit(blocks_, view.first[view.depth], false);
        visit(block_items_, blocks_for(n, PackedView::width) * PackedView::width, false);
        visit(slots_, options_.refits_some ? n : 0, false);
        visit(touched_, options_.refits_some ? view.first[view.depth] : 0, true);
        return;
    }
    visit(met_, n, false);
    if (is_radix()) {
        visit(leaves_, n, false);
        visit(radix_nodes_, nodes, false);
    } else {
        visit(hploc_nodes_, nodes, false);
        visit(clusters_, n, false);
    }
    if (is_wide8() || !is_radix())
        visit(parents_, 2 * n, false);
    if (is_wide8()) {
        visit(collapse_nodes_, nodes, false);
        visit(ranks_, n, false);
        visit(queue_, nodes, false);
        visit(wide8_parents_, nodes, false);
        visit(wide8_met_, nodes, true);
        visit(wide8_nodes_, nodes, false);
    }
}

inline std::size_t BuiltTree::bytes(const BuildOptions& options, std::size_t n) {
    std::size_t sum = n * (options.form == Form::packed ? 8 : 12); // CUB's, more or less
    BuiltTree(options).each_array(
        n, [&]<class T>(const Array<T>&, std::size_t size, bool) { sum += size * sizeof(T); });
    return sum;
}

inline void BuiltTree::reserve(std::size_t n, Stream stream) {
    each_array(n, [&]<class T>(Array<T>& array, std::size_t size, bool is_zero) {
        if (array.size() >= size)
            return;
        make_room(array, size, stream);
        if (is_zero)
            fill_bytes(array.data(), 0, size * sizeof(T), stream);
    });
}

inline void BuiltTree::set_views() {
    packed_ = packed_levels(is_packed() ? n_ : 0);
    packed_.blocks = blocks_.data();
    packed_.items = block_items_.data();
    BuildState* const state = state_.data();
    radix_ = {n_, leaves_.data(), items_.data(), radix_nodes_.data(), &state->root};
    hploc_ = {n_, items_.data(), hploc_nodes_.data(), &state->root};
    wide8_ = {{n_, wide8_nodes_.data(), items_.data()},
              wide8_parents_.data(),
              wide8_met_.data(),
              &state->n_nodes,
              &state->bounds};
}

template <int bits, class Code>
void BuiltTree::sort_codes(const Box* boxes, Array<Code>& codes, Array<Code>& sorted, Spare& spare,
                           Stream stream) {
    BuildState* const state = state_.data();
    const std::size_t blocks = blocks_for(n_, code_threads);
    launch(stream, 1, code_threads, make_code_rule<bits>, boxes, n_, &state->centres, is_packed(),
           &state->rule);
    launch(stream, blocks, code_threads, curve_codes<bits, Code>, boxes, n_, options_.curve,
           &state->rule, codes.data(), unsorted_.data());
    const int top = is_packed() ? static_cast<int>(sizeof(Code) * 8) : 3 * bits;
    sort_by_bits(codes.data(), sorted.data(), unsorted_.data(), items_.data(), n_, 0, top, spare,
                 stream);
    if (is_packed())
        launch(stream, blocks, code_threads, count_crowded<Code>, sorted.data(), n_,
               &state->crowded);
}

template <class Node>
void BuiltTree::make_wide8(const Node* nodes, const Box* boxes, Stream stream) {
    BuildState* const state = state_.data();
    collapse(BinarySource<Node>{n_, nodes, &state->root, items_.data(), boxes},
             {parents_.data(), met_.data(), ranks_.data(), queue_.data(), collapse_nodes_.data(),
              &state->levels},
             wide8_, spare_, stream);
}

inline void BuiltTree::enqueue(const Box* boxes, std::size_t n, Stream stream) {
    require_at_most_max_items(n);
    forget(); // what there is not memory for
    reserve(n, stream);
    n_ = static_cast<std::uint32_t>(n);
    set_views();
    if (n == 0)
        return;
    look(boxes, stream);
    if (is_packed() && !is_fine_)
        sort_codes<10>(boxes, coarse_, sorted_coarse_, spare_, stream);
    else
        sort_codes<21>(boxes, fine_, sorted_fine_, fine_spare_, stream);
    const std::size_t blocks = blocks_for(n, radix_threads);
    if (is_packed()) {
        fill_packed(packed_, boxes, items_.data(), &state_.data()->bounds, stream);
        if (options_.refits_some)
            launch(stream, blocks, radix_threads, find_slots, packed_, slots_.data());
        return;
    }
    if (is_radix())
        make_radix_tree(radix_, sorted_fine_.data(), boxes, met_.data(), stream);
    else
        make_hploc({hploc_, sorted_fine_.data(), boxes, clusters_.data(), met_.data()}, stream);
    if (options_.form == Form::radix_wide8)
        make_wide8(radix_nodes_.data(), boxes, stream);
    else if (is_wide8())
        make_wide8(hploc_nodes_.data(), boxes, stream);
    else if (!is_radix())
        launch(stream, blocks, radix_threads, find_parents, hploc_, parents_.data(), met_.data());
}

inline void BuiltTree::look(const Box* boxes, Stream stream) {
    if (n_ == 0)
        return;
    launch(stream, 1, 1, begin_build, state_.data());
    launch(stream, std::min<std::size_t>(blocks_for(n_, code_threads), max_measure_blocks),
           code_threads, measure_centres, boxes, n_, &state_.data()->centres);
}

inline bool BuiltTree::check(const Box* boxes, Stream stream) {
    if (n_ == 0)
        return true;
    BuildState state;
    download(state_.data(), std::span(&state, 1), stream);
    wait(stream);
    if (state.centres.first_bad != none_bad) {
        Box bad;
        download(boxes + state.centres.first_bad, std::span(&bad, 1), stream);
        wait(stream);
        require_valid(bad, state.centres.first_bad);
    }
    return !is_packed() || is_fine_ || state.crowded <= n_ / 8;
}

inline void BuiltTree::build(const Box* boxes, std::size_t n, Stream stream) {
    try {
        enqueue(boxes, n, stream);
        if (!check(boxes, stream)) {
            is_fine_ = true;
            enqueue(boxes, n, stream);
            wait(stream);
        }
    } catch (...) {
        forget();
        throw;
    }
}

inline void BuiltTree::refit(const Box* boxes, Stream stream) {
    if (n_ == 0)
        return;
    if (is_packed())
        fill_packed(packed_, boxes, nullptr, &state_.data()->bounds, stream);
    else if (is_wide8())
        refit_wide8_tree(wide8_, boxes, stream);
    else if (is_radix())
        make_radix_tree(radix_, sorted_fine_.data(), boxes, met_.data(), stream);
    else
        refit_binary_tree(hploc_, boxes, parents_.data(), met_.data(), stream);
}

inline void BuiltTree::refit(const Box* boxes, const std::uint32_t* moved, std::size_t n_moved,
                             Stream stream) {
    if (!is_packed() || !options_.refits_some)
        throw std::logic_error("BuiltTree: refit of some items is for the form packed, built with "
                               "refits_some");
    refit_packed_items(packed_, boxes,
                       {moved, static_cast<std::uint32_t>(n_moved), slots_.data(), touched_.data()},
                       &state_.data()->bounds, stream);
}

} // namespace boxwood::cuda
