#include "bench/truth/column_sweep.h"

#include "bench/peers/brute_force.h"
#include "trees/executor.h"

#include <algorithm>
#include <array>
#include <limits>

namespace boxwood::bench {
namespace {

/// Boxes whose places and sizes say where to cut.
constexpr std::size_t max_sampled = 4096;
/// A column has about so many boxes at least, each box is in so many columns at most in the mean.
constexpr std::size_t min_per_column = 64;
constexpr double max_columns_of_box = 4;
constexpr std::uint32_t max_along_axis = 4096;

bool is_box(const Aabb<float>& b) { // false for NaN
    return b.min.x <= b.max.x && b.min.y <= b.max.y && b.min.z <= b.max.z;
}

/// The k-th of n numbers, k a share of n.
double quantile(std::vector<double>& numbers, double share) {
    const auto at = numbers.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size() - 1));
    std::nth_element(numbers.begin(), at, numbers.end());
    return *at;
}

} // namespace

ColumnSweep::ColumnSweep(std::span<const Aabb<float>> boxes, unsigned threads)
    : boxes_(boxes), threads_(threads) {
    cut(max_columns_of_box * static_cast<double>(boxes.size()));
    list();
}

/// Monotone, so that two boxes that overlap have a column in common, that of the greater of their
/// lower corners among them; where it lies beyond all cuts does not matter.
std::uint32_t ColumnSweep::column_of(float at, int axis) const {
    const double column = (static_cast<double>(at) - low_[axis]) * per_unit_[axis];
    const std::uint32_t last = count_[axis] - 1;
    return column >= last ? last : column > 0 ? static_cast<std::uint32_t>(column) : 0;
}

/// Columns twice as wide as the median box, fewer where they would be nearly empty or where long
/// boxes would fill too many.
void ColumnSweep::cut(double max_entries) {
    std::vector<double> places, sides;
    double extent[2]{};
    std::uint32_t wanted[2]{1, 1};
    for (const int axis : {0, 1}) {
        places.clear();
        sides.clear();
        const std::size_t n = std::min(boxes_.size(), max_sampled);
        for (std::size_t k = 0; k < n; ++k) {
            const Aabb<float>& box = boxes_[k * boxes_.size() / n];
            if (!is_box(box))
                continue;
            const auto low = static_cast<double>(box.min[axis + 1]),
                       high = static_cast<double>(box.max[axis + 1]);
            places.push_back(.5 * (low + high));
            sides.push_back(high - low);
        }
        if (places.empty())
            return;
        low_[axis] = quantile(places, .01);
        extent[axis] = quantile(places, .99) - low_[axis];
        const double columns = extent[axis] / (2 * quantile(sides, .5)); // NaN or inf if flat
        wanted[axis] = columns >= max_along_axis ? max_along_axis
                       : columns > 1             ? static_cast<std::uint32_t>(columns)
                                                 : 1;
        if (!(extent[axis] > 0))
            wanted[axis] = 1;
    }
    const std::size_t max_columns = std::max<std::size_t>(1, boxes_.size() / min_per_column);
    for (bool fits = false; !fits;) {
        while (std::size_t{wanted[0]} * wanted[1] > max_columns)
            wanted[wanted[1] > wanted[0]] /= 2;
        for (const int axis : {0, 1}) {
            count_[axis] = wanted[axis];
            per_unit_[axis] = wanted[axis] > 1 ? wanted[axis] / extent[axis] : 0;
        }
        double entries = 0;
        for (const Aabb<float>& box : boxes_)
            if (is_box(box))
                entries +=
                    static_cast<double>(column_of(box.max.y, 0) - column_of(box.min.y, 0) + 1) *
                    static_cast<double>(column_of(box.max.z, 1) - column_of(box.min.z, 1) + 1);
        fits = entries <= max_entries || std::max(wanted[0], wanted[1]) == 1;
        for (std::uint32_t& columns : wanted)
            columns = std::max(1u, columns / 2);
    }
}

/// Counts, then fills in.
void ColumnSweep::list() {
    const auto for_each_entry = [&](const auto& take) {
        for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
            const Aabb<float>& box = boxes_[i];
            if (!is_box(box))
                continue;
            const std::uint32_t first_z = column_of(box.min.z, 1), last_z = column_of(box.max.z, 1),
                                last_y = column_of(box.max.y, 0);
            for (std::uint32_t y = column_of(box.min.y, 0); y <= last_y; ++y)
                for (std::uint32_t z = first_z; z <= last_z; ++z)
                    take(std::size_t{y} * count_[1] + z, i);
        }
    };
    first_.assign(std::size_t{count_[0]} * count_[1] + 1, 0);
    for_each_entry([&](std::size_t column, std::uint32_t) { ++first_[column + 1]; });
    for (std::size_t column = 1; column < first_.size(); ++column)
        first_[column] += first_[column - 1];
    entries_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_each_entry([&](std::size_t column, std::uint32_t i) { entries_[next[column]++] = i; });
}

/// Calls take(column, its pairs, lower item first), on several threads.
template <class Take> void ColumnSweep::for_each_column(const Take& take) const {
    make_executor("tbb", threads_)->for_each(first_.size() - 1, [&](std::size_t column) {
        const auto begin = entries_.begin() + static_cast<std::ptrdiff_t>(first_[column]),
                   end = entries_.begin() + static_cast<std::ptrdiff_t>(first_[column + 1]);
        std::vector<std::pair<float, std::uint32_t>> order;
        order.reserve(static_cast<std::size_t>(end - begin));
        for (auto i = begin; i != end; ++i)
            order.emplace_back(boxes_[*i].min.x, *i);
        std::ranges::sort(order);
        std::vector<Aabb<float>> sorted;
        std::vector<std::array<std::uint32_t, 2>> low; // the columns of lower corners
        sorted.reserve(order.size());
        low.reserve(order.size());
        for (const auto& [x, i] : order) {
            sorted.push_back(boxes_[i]);
            low.push_back({column_of(boxes_[i].min.y, 0), column_of(boxes_[i].min.z, 1)});
        }
        const BruteForce rows(sorted);
        const auto y = static_cast<std::uint32_t>(column / count_[1]),
                   z = static_cast<std::uint32_t>(column % count_[1]);
        std::vector<Pair> found;
        for (std::size_t row = 0; row < sorted.size(); ++row) {
            const auto stop = std::upper_bound(
                order.begin() + static_cast<std::ptrdiff_t>(row) + 1, order.end(),
                sorted[row].max.x, [](float x, const auto& entry) { return x < entry.first; });
            rows.append_row(row, row + 1, static_cast<std::size_t>(stop - order.begin()), found);
        }
        std::size_t kept = 0;
        for (const Pair p : found) {
            const auto &a = low[p.a], &b = low[p.b];
            if (std::max(a[0], b[0]) != y || std::max(a[1], b[1]) != z)
                continue; // another column's
            const auto [lower, higher] = std::minmax(order[p.a].second, order[p.b].second);
            found[kept++] = {lower, higher};
        }
        found.resize(kept);
        take(column, std::span<const Pair>(found));
    });
}

PairsDigest ColumnSweep::digest(const std::function<bool(Pair)>& is_left_out) const {
    std::vector<PairsDigest> parts(first_.size() - 1);
    for_each_column([&](std::size_t column, std::span<const Pair> pairs) {
        for (const Pair p : pairs)
            if (!is_left_out || !is_left_out(p))
                parts[column].add(p);
    });
    PairsDigest all;
    for (const PairsDigest& part : parts)
        all.add(part);
    return all;
}

std::vector<Pair> ColumnSweep::pairs() const {
    std::vector<std::vector<Pair>> parts(first_.size() - 1);
    for_each_column([&](std::size_t column, std::span<const Pair> pairs) {
        parts[column].assign(pairs.begin(), pairs.end());
    });
    return sorted_pairs(std::move(parts));
}

} // namespace boxwood::bench
