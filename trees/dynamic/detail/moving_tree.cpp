#include "trees/dynamic/detail/moving_tree.h"

#include "trees/builders/hilbert.h"
#include "trees/ordering/detail/radix_sort.h"

#include <algorithm>
#include <limits>

namespace boxwood::detail {
namespace {

std::uint32_t item_of(std::uint64_t record) { return static_cast<std::uint32_t>(record); }

/// The present boxes and their items, in their order; after these the absent items. Returns how
/// many are present. Without a branch: who is absent can be any.
std::size_t gather_present(Boxes boxes, std::vector<Box>& present,
                           std::vector<std::uint32_t>& items) {
    present.resize(boxes.size());
    items.resize(boxes.size());
    std::vector<std::uint32_t> gone(boxes.size());
    std::size_t n = 0;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        present[n] = boxes[i];
        items[n] = gone[i - n] = i;
        n += boxes[i].min.x <= boxes[i].max.x;
    }
    present.resize(n);
    std::copy_n(gone.begin(), boxes.size() - n, items.begin() + static_cast<std::ptrdiff_t>(n));
    return n;
}

} // namespace

Buffer<std::uint32_t> present_order(Boxes boxes, const Survey& survey, const Executor& executor) {
    if (!survey.some_absent)
        return HilbertBuilder{}.order(boxes, executor, &survey.centres);
    std::vector<Box> present;
    std::vector<std::uint32_t> items;
    const std::size_t n = gather_present(boxes, present, items);
    Buffer<std::uint32_t> order(boxes.size());
    std::ranges::transform(HilbertBuilder{}.order(present, executor, &survey.centres),
                           order.begin(), [&](std::uint32_t i) { return items[i]; });
    std::copy(items.begin() + static_cast<std::ptrdiff_t>(n), items.end(), order.begin() + n);
    return order;
}

std::size_t MovingTree::bytes() const {
    return layout_.bytes() + order_.bytes() + slot_of_.bytes() + records_.bytes() + spare_.bytes() +
           incoming_.bytes() + incoming_spare_.bytes() + taken_out_.capacity() +
           gathered_.capacity() * sizeof(Box) + gathered_items_.capacity() * sizeof(std::uint32_t);
}

double MovingTree::area_ratio() const {
    const double now = surface();
    if (tight_ > 0)
        return now / tight_;
    return now > 0 ? std::numeric_limits<double>::infinity() : 1; // what was not there came
}

/// mergeable_curve_order; the records of absent items come last.
MergeableOrder MovingTree::mergeable_order(Boxes boxes, const Survey& found,
                                           const Executor& executor) {
    if (!found.some_absent)
        return mergeable_curve_order(boxes, Curve::hilbert, HilbertBuilder::groups(boxes), executor,
                                     &found.centres);
    const std::size_t n = gather_present(boxes, gathered_, gathered_items_);
    const MergeableOrder present = mergeable_curve_order(
        gathered_, Curve::hilbert, HilbertBuilder::groups(gathered_), executor, &found.centres);
    MergeableOrder all{present.grid, present.group, {}};
    if (present.records.size() == n) {
        all.records = Buffer<std::uint64_t>(boxes.size());
        constexpr std::uint64_t beyond = ~std::uint64_t{0} << 32; // there is no fourth group
        for (std::size_t i = 0; i < boxes.size(); ++i)
            all.records[i] =
                i < n ? (present.records[i] & beyond) | gathered_items_[item_of(present.records[i])]
                      : beyond | gathered_items_[i];
    }
    return all;
}

void MovingTree::place(Boxes boxes, const Executor& executor) {
    layout_.take(boxes, order_.span(), executor);
    slots_known_ = false;
    tight_ = surface();
}

void MovingTree::reorder(Boxes boxes, const std::optional<Survey>& known,
                         const Executor& executor) {
    order_ = present_order(boxes, known ? *known : survey_of(boxes, executor), executor);
    records_ = {};
    place(boxes, executor);
    step = {boxes.size(), true};
}

void MovingTree::order_to_merge(Boxes boxes, const std::optional<Survey>& known,
                                const Executor& executor) {
    const std::size_t n = boxes.size();
    const Survey found = known ? *known : survey_of(boxes, executor);
    MergeableOrder kept = mergeable_order(boxes, found, executor);
    if (kept.records.size() != n)
        return reorder(boxes, found, executor);
    grid_ = kept.grid;
    group_ = kept.group;
    records_ = std::move(kept.records);
    if (order_.size() != n)
        order_ = Buffer<std::uint32_t>(n);
    std::transform(records_.begin(), records_.end(), order_.begin(), item_of);
    place(boxes, executor);
    step = {n, true};
}

void MovingTree::set_order(Boxes boxes, Buffer<std::uint32_t> order, const Executor& executor) {
    order_ = std::move(order);
    records_ = {};
    place(boxes, executor);
}

void MovingTree::merge_in(Boxes boxes, std::span<const std::uint32_t> items,
                          const Executor& executor) {
    const std::size_t n = boxes.size();
    if (records_.size() != n)
        return order_to_merge(boxes, {}, executor);
    if (spare_.size() != n) {
        spare_ = Buffer<std::uint64_t>(n);
        taken_out_.assign(n, 0);
    }
    gathered_.clear();
    for (const std::uint32_t item : items) {
        gathered_.push_back(boxes[item]);
        taken_out_[item] = 1;
    }
    incoming_ = Buffer<std::uint64_t>(items.size());
    incoming_spare_ = Buffer<std::uint64_t>(items.size());
    curve_records(gathered_, Curve::hilbert, grid_, group_, incoming_.data());
    // From numbers among the items to items: ascending, too, so that the sort stays by item.
    for (std::uint64_t& record : incoming_)
        record = (record >> 32 << 32) | items[item_of(record)];
    radix_sort(incoming_, incoming_spare_, 32, 64, serial());

    std::size_t next = 0, to = 0;
    for (const std::uint64_t record : records_) {
        if (taken_out_[item_of(record)])
            continue;
        while (next < incoming_.size() && incoming_[next] < record)
            spare_[to++] = incoming_[next++];
        spare_[to++] = record;
    }
    while (next < incoming_.size())
        spare_[to++] = incoming_[next++];
    for (const std::uint32_t item : items)
        taken_out_[item] = 0;
    std::swap(records_, spare_);
    std::transform(records_.begin(), records_.end(), order_.begin(), item_of);
    place(boxes, executor);
    step = {items.size(), false};
}

void MovingTree::sort_part(Boxes boxes, std::size_t begin, std::size_t end,
                           const Executor& executor) {
    gathered_.clear();
    for (std::size_t slot = begin; slot < end; ++slot)
        gathered_.push_back(boxes[order_[slot]]);
    Buffer<std::uint32_t> part = present_order(gathered_, survey_of(gathered_, executor), executor);
    for (std::uint32_t& item : part)
        item = order_[begin + item];
    std::ranges::copy(part, order_.begin() + begin);
    records_ = {};
    place(boxes, executor);
    step = {end - begin, false};
}

void MovingTree::note_slots() {
    if (slots_known_)
        return;
    if (slot_of_.size() != order_.size())
        slot_of_ = Buffer<std::uint32_t>(order_.size());
    for (std::size_t slot = 0; slot < order_.size(); ++slot)
        slot_of_[order_[slot]] = static_cast<std::uint32_t>(slot);
    slots_known_ = true;
}

void MovingTree::refit(Boxes boxes, const Executor& executor) { layout_.refit(boxes, executor); }

void MovingTree::refit(Boxes boxes, std::span<const std::uint32_t> items) {
    note_slots();
    moved_slots_.resize(items.size());
    std::ranges::transform(items, moved_slots_.begin(),
                           [&](std::uint32_t item) { return slot_of_[item]; });
    layout_.refit(boxes, moved_slots_);
}

void MovingTree::refit(Boxes boxes, std::span<const std::uint32_t> items,
                       const Executor& executor) {
    if (items.size() < size() / 16)
        refit(boxes, items);
    else
        refit(boxes, executor);
}

void MovingTree::exchange(Boxes boxes, const Executor& executor) {
    const double ratio = area_ratio();
    refit(boxes, executor);
    tight_ = ratio > 0 ? surface() / ratio : surface();
}

std::string MovingTree::fault() const {
    std::vector<std::uint8_t> seen(size());
    for (std::size_t slot = 0; slot < size(); ++slot) {
        const std::uint32_t item = order_[slot];
        if (item >= size() || seen[item]++)
            return "slot " + std::to_string(slot) + ": item " + std::to_string(item) +
                   " is none, or there twice";
        if (layout_.items()[slot] != item)
            return "slot " + std::to_string(slot) + " of the layout holds another item";
        if (slots_known_ && slot_of_[item] != slot)
            return "item " + std::to_string(item) + " is not where it is noted";
    }
    for (std::size_t i = 1; i < records_.size(); ++i)
        if (records_[i - 1] >= records_[i])
            return "records " + std::to_string(i) + " and the one before it are out of order";
    return layout_.fault();
}

} // namespace boxwood::detail
