#include "trees/dynamic/detail/order_degradation.h"

#include "trees/testing/box_families.h"
#include "trees/builders/hilbert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace boxwood {
using namespace detail;
namespace {

/// Boxes that never move: how loose they are is made up.
struct Still {
    std::vector<Box> boxes = random_boxes(4000, .05f, 1);
    PackedLayout layout =
        PackedLayout::of_order(boxes, HilbertBuilder{}.order(boxes, serial()).span(), serial());
};

TEST(OrderAge, TheCostOfQueriesGrowsWithWhatThereIsToFind) {
    const auto cost = [](std::size_t n, float size) {
        const auto boxes = random_boxes(n, size, 1);
        const auto order = HilbertBuilder{}.order(boxes, serial());
        OrderAge age;
        age.start(1, PackedLayout::of_order(boxes, order.span(), serial()), boxes);
        return age.query_cost();
    };
    EXPECT_GT(cost(4000, .05f), 0);
    EXPECT_GT(cost(4000, .3f), 2 * cost(4000, .05f));
    OrderAge of_none;
    of_none.start(1, PackedLayout{}, {});
    EXPECT_EQ(of_none.query_cost(), 0);
    of_none.aged(10);
    EXPECT_FALSE(of_none.is_due());
}

/// The mean of what a frame costs above a refit, of a thousand, where looseness grows since an
/// order as told.
double mean_cost(double price, const std::function<double(std::size_t)>& looseness_at) {
    const Still still;
    OrderAge age;
    age.start(price, still.layout, still.boxes);
    double cost = 0;
    std::size_t since = 0;
    for (std::size_t frame = 0; frame < 1000; ++frame) {
        ++since;
        if (!age.is_due_next()) {
            age.aged(looseness_at(since));
            if (!age.is_due()) {
                cost += age.excess(looseness_at(since));
                continue;
            }
        }
        cost += price;
        age.renewed(price, still.layout, still.boxes);
        since = 0;
    }
    return cost / 1000;
}

double best_mean_cost(double price, const std::function<double(std::size_t)>& looseness_at) {
    const Still still;
    OrderAge age;
    age.start(price, still.layout, still.boxes);
    double best = std::numeric_limits<double>::infinity(), sum = price;
    for (std::size_t period = 1; period <= 1000; ++period) {
        best = std::min(best, sum / static_cast<double>(period));
        sum += age.excess(looseness_at(period));
    }
    return best;
}

TEST(OrderAge, SteadyMotionCostsAboutAsMuchAsWithTheBestFixedPeriod) {
    for (const double growth : {0., 1e-4, 1e-2, .1, .4, 2.})
        for (const double power : {.5, 1., 1.5})
            for (const double price : {2., 12., 100.}) {
                const auto looseness = [&](std::size_t frames) {
                    return 1 + growth * std::pow(static_cast<double>(frames), power);
                };
                EXPECT_LE(mean_cost(price, looseness),
                          1.25 * best_mean_cost(price, looseness) + 1e-9)
                    << growth << " " << power << " " << price;
            }
}

TEST(OrderAge, WhatBoxesDidOnceIsEndedWhenItHasCostEnough) {
    const Still still;
    OrderAge age;
    age.patience = 3;
    const double price = 100;
    age.start(price, still.layout, still.boxes);
    double paid = 0;
    for (std::size_t frame = 0; frame < 1000; ++frame) {
        age.aged(1.1);
        paid += age.excess(1.1);
        EXPECT_EQ(age.is_due(), paid >= 300);
        if (age.is_due())
            return;
    }
    FAIL() << "never due";
}

TEST(OrderAge, WhereEachFrameWantsANewOrderARefitIsTriedNowAndThen) {
    const Still still;
    OrderAge age;
    age.start(1, still.layout, still.boxes);
    std::size_t tried = 0;
    for (std::size_t frame = 0; frame < 90; ++frame) {
        if (!age.is_due_next()) {
            ++tried;
            age.aged(10);
            EXPECT_TRUE(age.is_due());
        }
        age.renewed(1, still.layout, still.boxes);
    }
    EXPECT_GE(tried, 5u);
    EXPECT_LE(tried, 15u);
    age.aged(1); // they rest
    EXPECT_FALSE(age.is_due());
    EXPECT_FALSE(age.is_due_next());
}

} // namespace
} // namespace boxwood
