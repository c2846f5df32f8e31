/// What keeping pairs costs, and when it pays.

#include "trees/dynamic/detail/cached_pairs.h"
#include "trees/dynamic/detail/box_steps.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <utility>

namespace boxwood::detail {

double CachedPairs::spent_anew() const { return n() * per_item_anew + pairs_ * per_pair_anew; }

/// A third more pairs than overlap are found.
double CachedPairs::renewal_cost() const {
    return n() * (per_item_renewed + per_item_anew) + pairs_ * 1.3 * (per_found + per_pair_anew);
}

/// After k frames there are k times as many restless. Renewing every k frames costs
/// renewal / k + k / 2 times what those of one frame cost: least, where both are the same.
double CachedPairs::churn_cost() const {
    const auto fresh = static_cast<double>(std::min(fresh_before_, fresh_.size()));
    return fresh == 0
               ? 0
               : std::sqrt(2 * renewal_cost() * fresh * per_restless) + pairs_ * per_left_out;
}

/// Renewals cost as step / margin, pairs unsure as the margin; both little between these bounds.
double CachedPairs::margin_for(double step) const {
    constexpr double most = double{FLT_MAX} / 8;
    return std::min(margin > 0 ? margin * side_ : std::clamp(80 * step, .03 * side_, .08 * side_),
                    most);
}

double CachedPairs::forecast(std::vector<float> steps, double items, std::size_t moved) {
    const std::size_t most =
        std::min(static_cast<std::size_t>(std::max(1., n() / 16 / items)), steps.size());
    std::ranges::partial_sort(steps, steps.begin() + static_cast<std::ptrdiff_t>(most),
                              std::greater<>());
    pace_ = most == 0 ? 0 : std::min(steps[most - 1], FLT_MAX / 8);
    double least = most == 0 ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < most; k += k / 8 + 1) {
        const double step = double{steps[k]}, restless = static_cast<double>(k) * items;
        constexpr double per_pair = 50; // examined in a step of a side, by the logarithm
        const double cost = step / side_ * (pairs_ + n()) * per_pair * per_examined +
                            (step > 0 ? step / margin_for(step) * renewal_cost() : 0) +
                            restless * per_restless;
        if (cost < least) {
            least = cost;
            pace_ = steps[k];
        }
    }
    return forecast_ = least + static_cast<double>(moved) * per_moved;
}

/// Of sixteen calm items the fastest is known.
void CachedPairs::forecast_by_frame() {
    std::vector<float> steps = steps_;
    for (const Out& out : out_)
        steps.push_back(out.step);
    forecast(std::move(steps), 1, follow_block * steps_.size() + out_.size());
}

} // namespace boxwood::detail
