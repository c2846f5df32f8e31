#include "trees/dynamic/order_degradation.h"

#include "trees/builders/hilbert.h"
#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace boxwood {
namespace {

/// Boxes that never move: their area ratios are made up.
struct Still {
    std::vector<Box> boxes = random_boxes(4000, .05f, 1);
    PackedLayout layout =
        PackedLayout::of_order(boxes, HilbertBuilder{}.order(boxes, serial()).span(), serial());
};

TEST(OrderDegradation, TheCostOfQueriesGrowsWithWhatThereIsToFind) {
    const auto cost = [](std::size_t n, float size) {
        const auto boxes = random_boxes(n, size, 1);
        const auto order = HilbertBuilder{}.order(boxes, serial());
        OrderDegradation degradation;
        degradation.start(1, PackedLayout::of_order(boxes, order.span(), serial()), boxes);
        return degradation.excess(2);
    };
    EXPECT_GT(cost(4000, .05f), 0);
    EXPECT_GT(cost(4000, .3f), 2 * cost(4000, .05f));
    OrderDegradation of_none;
    of_none.start(1, PackedLayout{}, {});
    EXPECT_EQ(of_none.excess(10), 0);
    of_none.degraded(10);
    EXPECT_FALSE(of_none.is_due());
}

/// The mean of what a frame costs above a refit, of a thousand, where the area ratio grows since an
/// order as `area_ratio_at` says.
double mean_cost(double cost_of_order, const std::function<double(std::size_t)>& area_ratio_at) {
    const Still still;
    OrderDegradation degradation;
    degradation.start(cost_of_order, still.layout, still.boxes);
    double cost = 0;
    std::size_t since = 0;
    for (std::size_t frame = 0; frame < 1000; ++frame) {
        ++since;
        if (!degradation.is_due_next()) {
            degradation.degraded(area_ratio_at(since));
            if (!degradation.is_due()) {
                cost += degradation.excess(area_ratio_at(since));
                continue;
            }
        }
        cost += cost_of_order;
        degradation.reordered(cost_of_order, still.layout, still.boxes);
        since = 0;
    }
    return cost / 1000;
}

double best_mean_cost(double cost_of_order,
                      const std::function<double(std::size_t)>& area_ratio_at) {
    const Still still;
    OrderDegradation degradation;
    degradation.start(cost_of_order, still.layout, still.boxes);
    double best = std::numeric_limits<double>::infinity(), sum = cost_of_order;
    for (std::size_t period = 1; period <= 1000; ++period) {
        best = std::min(best, sum / static_cast<double>(period));
        sum += degradation.excess(area_ratio_at(period));
    }
    return best;
}

TEST(OrderDegradation, SteadyMotionCostsAboutAsMuchAsWithTheBestFixedPeriod) {
    for (const double growth : {0., 1e-4, 1e-2, .1, .4, 2.})
        for (const double power : {.5, 1., 1.5})
            for (const double cost_of_order : {2., 12., 100.}) {
                const auto area_ratio = [&](std::size_t frames) {
                    return 1 + growth * std::pow(static_cast<double>(frames), power);
                };
                EXPECT_LE(mean_cost(cost_of_order, area_ratio),
                          1.25 * best_mean_cost(cost_of_order, area_ratio) + 1e-9)
                    << growth << " " << power << " " << cost_of_order;
            }
}

TEST(OrderDegradation, WhatBoxesDidOnceIsEndedWhenItHasCostEnough) {
    const Still still;
    OrderDegradation degradation;
    degradation.patience = 3;
    const double cost_of_order = 100;
    degradation.start(cost_of_order, still.layout, still.boxes);
    double paid = 0;
    for (std::size_t frame = 0; frame < 1000; ++frame) {
        degradation.degraded(1.1);
        paid += degradation.excess(1.1);
        EXPECT_EQ(degradation.is_due(), paid >= 300);
        if (degradation.is_due())
            return;
    }
    FAIL() << "never due";
}

TEST(OrderDegradation, WhereEachFrameWantsANewOrderARefitIsTriedNowAndThen) {
    const Still still;
    OrderDegradation degradation;
    degradation.start(1, still.layout, still.boxes);
    std::size_t tried = 0;
    for (std::size_t frame = 0; frame < 90; ++frame) {
        if (!degradation.is_due_next()) {
            ++tried;
            degradation.degraded(10);
            EXPECT_TRUE(degradation.is_due());
        }
        degradation.reordered(1, still.layout, still.boxes);
    }
    EXPECT_GE(tried, 5u);
    EXPECT_LE(tried, 15u);
    degradation.degraded(1); // they rest
    EXPECT_FALSE(degradation.is_due());
    EXPECT_FALSE(degradation.is_due_next());
}

} // namespace
} // namespace boxwood
