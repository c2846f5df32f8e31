#include "trees/bvh.h"

#include "kernels/arithmetic/rounding.h"
#include "trees/dynamic/detail/moving_tree.h"
#include "trees/layouts/detail/model.h"
#include "trees/optimizers/refit.h"
#include "trees/queries/box_distance.h"
#include "trees/queries/filters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

using PackedModel =
    LayoutModel<PackedLayout, std::reference_wrapper<const PackedLayout>>; // of a MovingTree

/// Sum of half the surface areas of the inner nodes over that of the root; 0 if it has none.
double area_of(const Tree& tree) {
    if (tree.empty() || !(tree.nodes[0].box.half_area() > 0))
        return 0;
    double sum = 0;
    for (const TreeNode& node : tree.nodes)
        sum += node.count > 1 ? node.box.half_area() : 0;
    return sum / tree.nodes[0].box.half_area();
}

} // namespace

Bvh::Bvh(Boxes boxes, const BvhOptions& options)
    : BoxQueries(nullptr, detail::executor_of(options.executor, options.threads)),
      options_(options) {
    if (!options.builder.build)
        throw std::invalid_argument("BvhOptions::builder is empty; give a builder, such as "
                                    "BinnedSahBuilder{}");
    if (!(options.rebuild_above >= 1))
        throw std::invalid_argument("BvhOptions::rebuild_above is a ratio of at least 1");
    rebuild(boxes);
    rebuilds_ = 0;
}

Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;
Bvh::~Bvh() = default;

std::size_t Bvh::size() const { return packed_ ? packed_->size() : tree_.size(); }

std::size_t Bvh::bytes() const {
    return packed_ ? packed_->bytes()
                   : layout_->bytes() + tree_.nodes.bytes() + tree_.order.bytes();
}

void Bvh::rebuild(Boxes boxes) {
    if (is_packed()) {
        Buffer<std::uint32_t> order = options_.builder.order
                                          ? options_.builder.order(boxes, *executor_)
                                          : options_.builder(boxes, *executor_).order;
        if (!packed_) {
            packed_ = std::make_unique<detail::MovingTree>();
            layout_ = std::make_unique<PackedModel>(packed_->layout());
        }
        packed_->set_order(boxes, std::move(order), *executor_);
    } else {
        Tree tree = options_.builder(boxes, *executor_);
        layout_ = layout_entry_of(options_.layout).make(tree, *executor_);
        tree_ = std::move(tree);
        built_area_ = area_of(tree_);
    }
    ++rebuilds_;
}

void Bvh::update(Boxes boxes) {
    if (boxes.size() != size())
        return rebuild(boxes);
    require_valid(boxes);
    if (packed_)
        packed_->refit(boxes, *executor_);
    else
        refit(tree_, boxes);
    fit(boxes);
}

void Bvh::update(Boxes boxes, std::span<const std::uint32_t> moved) {
    require_moved(boxes, moved);
    if (packed_)
        packed_->refit(boxes, moved, *executor_);
    else
        refit(tree_, boxes);
    fit(boxes);
}

/// After a refit: again from scratch where that pays, and the layout of a tree.
void Bvh::fit(Boxes boxes) {
    if (area_ratio() > options_.rebuild_above)
        rebuild(boxes);
    else if (!packed_)
        layout_ = layout_entry_of(options_.layout).make(tree_, *executor_);
}

double Bvh::area_ratio() const {
    if (packed_)
        return packed_->area_ratio();
    const double now = area_of(tree_);
    if (built_area_ > 0)
        return now / built_area_;
    return now > 0 ? std::numeric_limits<double>::infinity() : 1; // there was no area at all
}

namespace {

/// A list of moved items as it must be, of trees that hold `held` boxes.
void require_list(std::size_t held, std::size_t given, std::span<const std::uint32_t> moved) {
    if (given != held)
        throw std::invalid_argument("update: the tree holds " + std::to_string(held) + " boxes, " +
                                    std::to_string(given) +
                                    " are given; leave the list of moved items out");
    for (std::size_t i = 0; i < moved.size(); ++i) {
        if (moved[i] >= held)
            throw std::invalid_argument("update: there is no item " + std::to_string(moved[i]));
        if (i > 0 && moved[i] <= moved[i - 1])
            throw std::invalid_argument("update: the moved items do not ascend at item " +
                                        std::to_string(moved[i]));
    }
}

[[noreturn]] void refuse_unlisted(std::size_t item) {
    throw std::invalid_argument("update: the box of item " + std::to_string(item) +
                                " differs from the one held, but the item is not listed as moved");
}

} // namespace

void Bvh::require_moved(Boxes boxes, std::span<const std::uint32_t> moved) const {
    require_list(size(), boxes.size(), moved);
    for (const std::uint32_t item : moved)
        require_valid(boxes[item], item);
    std::size_t unlisted = boxes.size();
    const auto compare = [&](std::uint32_t item, const Box& held) {
        if (!(held == boxes[item]) && !std::ranges::binary_search(moved, item))
            unlisted = std::min<std::size_t>(unlisted, item);
    };
    if (packed_) {
        const PackedLayout& layout = packed_->layout();
        for (std::size_t slot = 0; slot < size(); ++slot)
            compare(layout.items()[slot],
                    layout.level(0)[slot / PackedLayout::width].lane(slot % PackedLayout::width));
    } else {
        for (std::size_t i = 0; i < tree_.nodes.size(); ++i)
            if (tree_.is_leaf(i))
                compare(tree_.item(i), tree_.bounds(i));
    }
    if (unlisted < boxes.size())
        refuse_unlisted(unlisted);
}

namespace {

std::vector<Box> boxes_around(std::span<const Aabb<double>> boxes) {
    std::vector<Box> around(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!boxes[i].is_valid())
            throw InvalidBox(i, "a NaN, an infinity or min > max; give finite corners, min <= max");
        around[i] = round_outward(boxes[i]);
        if (!around[i].is_valid())
            throw InvalidBox(i, "a coordinate beyond the largest float, 3.4e38; scale the scene");
    }
    return around;
}

/// The pairs of the float boxes whose double boxes overlap.
auto exact_pairs(std::span<const Aabb<double>> a, std::span<const Aabb<double>> b, PairSink& sink) {
    return FilteredPairs([a, b](Pair p) { return overlaps(a[p.a], b[p.b]); }, sink);
}

} // namespace

BvhF64::BvhF64(std::span<const Aabb<double>> boxes, const BvhOptions& options)
    : boxes_(boxes.begin(), boxes.end()), around_(boxes_around(boxes), options) {}

std::size_t BvhF64::bytes() const {
    return around_.bytes() + boxes_.capacity() * sizeof(Aabb<double>);
}

void BvhF64::update(std::span<const Aabb<double>> boxes) {
    std::vector<Aabb<double>> held(boxes.begin(), boxes.end());
    around_.update(boxes_around(boxes));
    boxes_ = std::move(held);
}

void BvhF64::update(std::span<const Aabb<double>> boxes, std::span<const std::uint32_t> moved) {
    require_list(size(), boxes.size(), moved);
    for (std::size_t i = 0; i < boxes.size(); ++i)
        if (!(boxes[i] == boxes_[i]) &&
            !std::ranges::binary_search(moved, static_cast<std::uint32_t>(i)))
            refuse_unlisted(i);
    around_.update(boxes_around(boxes), moved);
    std::ranges::copy(boxes, boxes_.begin());
}

void BvhF64::rebuild(std::span<const Aabb<double>> boxes) {
    std::vector<Aabb<double>> held(boxes.begin(), boxes.end());
    around_.rebuild(boxes_around(boxes));
    boxes_ = std::move(held);
}

void BvhF64::self_pairs(PairSink& sink) const {
    auto exact = exact_pairs(boxes_, boxes_, sink);
    around_.self_pairs(exact);
}
std::vector<Pair> BvhF64::self_pairs() const {
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    self_pairs(sink);
    return pairs;
}
std::uint64_t BvhF64::self_pair_count() const {
    CountPairs count;
    self_pairs(count);
    return count.count();
}

void BvhF64::pairs(const BvhF64& other, PairSink& sink) const {
    auto exact = exact_pairs(boxes_, other.boxes_, sink);
    around_.pairs(other.around_, exact);
}
std::vector<Pair> BvhF64::pairs(const BvhF64& other) const {
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    this->pairs(other, sink);
    return pairs;
}
std::uint64_t BvhF64::pair_count(const BvhF64& other) const {
    CountPairs count;
    pairs(other, count);
    return count.count();
}

std::vector<std::uint32_t> BvhF64::overlapping(const Aabb<double>& box) const {
    std::vector<std::uint32_t> items;
    overlapping(box, [&](std::uint32_t item) { items.push_back(item); });
    return items;
}

std::vector<std::uint32_t> BvhF64::containing(Vec3<double> point) const {
    return is_finite(point) ? overlapping({point, point}) : std::vector<std::uint32_t>();
}

/// A region with a NaN, or min > max, is given to the tree as one that shares no point with any.
AnswersOf<std::uint32_t> BvhF64::overlapping(std::span<const Aabb<double>> boxes) const {
    std::vector<Box> around(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        if (is_region(boxes[i]))
            around[i] = round_outward(boxes[i]);
    std::vector<Pair> found;
    AppendPairs sink(found);
    FilteredPairs exact([&](Pair p) { return overlaps(boxes_[p.b], boxes[p.a]); }, sink);
    around_.overlapping(around, exact);
    return detail::answers_of_pairs(boxes.size(), found);
}
AnswersOf<std::uint32_t> BvhF64::containing(std::span<const Vec3<double>> points) const {
    std::vector<Aabb<double>> boxes(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_finite(points[i]))
            boxes[i] = {points[i], points[i]};
    return overlapping(boxes);
}

/// Any k items bound how far the nearest ones are: those nearest to the rounded point in floats.
/// Whatever is within that bound overlaps the box that has it for its half side.
std::vector<Neighbour> BvhF64::nearest(Vec3<double> point, std::size_t k) const {
    std::vector<Neighbour> found;
    k = std::min(k, size());
    if (!is_finite(point) || k == 0)
        return found;
    const auto offer = [&](std::uint32_t item) {
        found.push_back({item, squared_distance(point, boxes_[item])});
    };
    constexpr double max_float = std::numeric_limits<float>::max();
    Vec3<float> rounded;
    for (int axis = 0; axis < 3; ++axis)
        rounded[axis] = static_cast<float>(std::clamp(point[axis], -max_float, max_float));
    double reach = 0;
    for (const Neighbour& near : around_.nearest(rounded, k))
        reach = std::max(reach, squared_distance(point, boxes_[near.item]));
    // Distances round by less than 2^-50 of themselves, and squares below 2^-1000 to nothing.
    const double side = std::sqrt(reach) * (1 + 0x1p-48) + 0x1p-490;
    const Vec3<double> half{side, side, side};
    around_.overlapping(round_outward({point - half, point + half}), offer);
    std::ranges::sort(found, [](const Neighbour& a, const Neighbour& b) {
        return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                        : a.item < b.item;
    });
    if (found.size() > k)
        found.resize(k);
    return found;
}

std::vector<Neighbour> BvhF64::nearest(std::span<const Vec3<double>> points, std::size_t k) const {
    std::vector<Neighbour> all = detail::neighbours_of(points.size(), k);
    constexpr std::size_t in_chunk = 64;
    const std::size_t chunks = (points.size() + in_chunk - 1) / in_chunk;
    around_.executor().for_each(chunks, [&](std::size_t chunk) {
        const std::size_t end = std::min(points.size(), (chunk + 1) * in_chunk);
        for (std::size_t i = chunk * in_chunk; i < end; ++i)
            std::ranges::copy(nearest(points[i], k),
                              all.begin() + static_cast<std::ptrdiff_t>(i * k));
    });
    return all;
}

} // namespace boxwood
