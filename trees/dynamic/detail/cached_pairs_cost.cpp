/// What caching pairs costs, and when it pays.

#include "trees/dynamic/detail/box_steps.h"
#include "trees/dynamic/detail/cached_pairs.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <utility>

namespace boxwood::detail {

double CachedPairs::search_cost() const {
    return n() * per_item_searched + pairs_ * per_pair_searched;
}

/// A third more pairs than overlap are found.
double CachedPairs::rebuild_cost() const {
    return n() * (per_item_rebuilt + per_item_searched) +
           pairs_ * 1.3 * (per_found + per_pair_searched);
}

/// After k frames there are k times as many fast items. A rebuild every k frames costs
/// rebuild / k + k / 2 times what those of one frame cost: least, where both are the same.
double CachedPairs::churn_cost() const {
    const auto fresh = static_cast<double>(std::min(fresh_before_, fresh_.size()));
    return fresh == 0
               ? 0
               : std::sqrt(2 * rebuild_cost() * fresh * per_fast_item) + pairs_ * per_left_out;
}

/// Rebuilds cost as step / margin, pairs unsure as the margin; both little between these bounds.
double CachedPairs::margin_for(double step) const {
    constexpr double max_margin = double{FLT_MAX} / 8;
    return std::min(margin > 0 ? margin * side_ : std::clamp(80 * step, .03 * side_, .08 * side_),
                    max_margin);
}

double CachedPairs::forecast(std::vector<float> steps, double items, std::size_t moved) {
    const std::size_t max_fast =
        std::min(static_cast<std::size_t>(std::max(1., n() / 16 / items)), steps.size());
    std::ranges::partial_sort(steps, steps.begin() + static_cast<std::ptrdiff_t>(max_fast),
                              std::greater<>());
    pace_ = max_fast == 0 ? 0 : std::min(steps[max_fast - 1], FLT_MAX / 8);
    double lowest = max_fast == 0 ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < max_fast; k += k / 8 + 1) {
        const double step = double{steps[k]}, fast = static_cast<double>(k) * items;
        constexpr double per_pair = 50; // examined in a step of a side, by the logarithm
        const double cost = step / side_ * (pairs_ + n()) * per_pair * per_examined +
                            (step > 0 ? step / margin_for(step) * rebuild_cost() : 0) +
                            fast * per_fast_item;
        if (cost < lowest) {
            lowest = cost;
            pace_ = steps[k];
        }
    }
    return forecast_ = lowest + static_cast<double>(moved) * per_moved;
}

/// Of sixteen slow items the fastest is known.
void CachedPairs::forecast_by_frame() {
    std::vector<float> steps = steps_;
    for (const Out& out : out_)
        steps.push_back(out.step);
    forecast(std::move(steps), 1, follow_block * steps_.size() + out_.size());
}

} // namespace boxwood::detail
