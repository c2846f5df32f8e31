#include "trees/dynamic/order_degradation.h"

#include "trees/dynamic/detail/item_sample.h"
#include "trees/dynamic/detail/survey.h"
#include "trees/queries/regions.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace boxwood {
using namespace detail;

void OrderDegradation::start(double cost, const PackedLayout& layout, Boxes boxes) {
    start(cost, 0);
    measure(layout, boxes);
}

void OrderDegradation::start(double cost, double query) {
    const double same = patience;
    *this = {};
    patience = same;
    cost_ = cost;
    fresh_query_ = query;
}

/// Some of the boxes are queries by region. All pairs together take about a quarter of as many box
/// tests: each found once, and by whole blocks.
void OrderDegradation::measure(const PackedLayout& layout, Boxes boxes) {
    constexpr std::size_t min_sampled = 16, max_sampled = 256;
    constexpr double per_test = .3, share = .28;
    std::vector<Box> sampled;
    for (const std::uint32_t item :
         sampled_items(boxes.size(), std::clamp(boxes.size() / 64, min_sampled, max_sampled)))
        if (!is_absent(boxes[item]))
            sampled.push_back(boxes[item]);
    fresh_query_ = 0;
    if (sampled.empty())
        return;
    Work work;
    CountPairs ignored;
    regions(layout, Boxes(sampled), serial(), ignored, &work);
    fresh_query_ = per_test * share * static_cast<double>(work.box_tests) /
                   static_cast<double>(sampled.size());
}

void OrderDegradation::reordered(double cost, const PackedLayout& layout, Boxes boxes) {
    constexpr std::size_t between_measures = 16;
    reordered(cost, fresh_query_);
    if (reorders_ % between_measures == 0)
        measure(layout, boxes);
}

void OrderDegradation::reordered(double cost, double query) {
    fresh_query_ = query;
    ++reorders_;
    in_a_row_ = frames_ == 0 ? in_a_row_ + 1 : 0;
    cost_ = cost;
    before_ = newest_ = 0;
    frames_ = 0;
}

/// Box tests grow with the surface a little more than in proportion: by powers of 1.05 to 1.5 in
/// scenes of boxes of one size and of many.
double OrderDegradation::excess(double area_ratio) const {
    return area_ratio > 1 ? fresh_query_ * (std::pow(area_ratio, 1.3) - 1) : 0;
}

void OrderDegradation::degraded(double area_ratio) {
    before_ += newest_;
    newest_ = excess(area_ratio);
    if (++frames_ == 1)
        first_ = newest_;
}

/// In the frame that is number `age` since the order.
bool OrderDegradation::is_due(double excess, std::size_t age, double before) const {
    return excess * static_cast<double>(age) >= cost_ + before ||
           excess + before >= patience * cost_;
}

bool OrderDegradation::is_due() const { return is_due(newest_, frames_, before_); }

bool OrderDegradation::is_due_next() const {
    constexpr std::size_t max_in_a_row = 8; // then what a frame costs is looked at once more
    if (frames_ == 0)
        return in_a_row_ < max_in_a_row && is_due(first_, 1, 0);
    const auto age = static_cast<double>(frames_);
    return is_due(newest_ * (age + 1) / age, frames_ + 1, before_ + newest_);
}

} // namespace boxwood
