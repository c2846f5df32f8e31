#include "trees/bvh.h"

#include "kernels/arithmetic/rounding.h"
#include "trees/builders/binned_sah.h"
#include "trees/builders/ploc.h"
#include "trees/queries/box_distance.h"
#include "trees/testing/box_families.h"
#include "trees/testing/region_queries.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

namespace boxwood {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Throws;
using ::testing::ThrowsMessage;

using Items = std::vector<std::uint32_t>;

template <class Holds> Items items_where(std::size_t n, const Holds& holds) {
    Items items;
    for (std::uint32_t i = 0; i < n; ++i)
        if (holds(i))
            items.push_back(i);
    return items;
}

template <class Real, class Point>
std::vector<Neighbour> brute_nearest(std::span<const Aabb<Real>> boxes, Point point,
                                     std::size_t k) {
    std::vector<Neighbour> all;
    if (!is_finite(point))
        return all;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        all.push_back({i, squared_distance(point, boxes[i])});
    std::ranges::sort(all, [](const Neighbour& a, const Neighbour& b) {
        return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                        : a.item < b.item;
    });
    all.resize(std::min(k, all.size()));
    return all;
}

std::vector<Pair> ascending(std::vector<Pair> pairs) {
    std::ranges::sort(pairs);
    return pairs;
}

std::vector<BvhOptions> some_options() {
    return {{},
            {.builder = BinnedSahBuilder{}, .layout = LayoutName::wide8},
            {.builder = make_builder("ploc+reinsertion"),
             .layout = LayoutName::quantised8,
             .threads = 2},
            {.builder = PlocBuilder{}, .executor = make_executor("openmp", 2)},
            {.builder = BinnedSahBuilder{}, .layout = LayoutName::binary_f64}};
}

Items in_boxes(Boxes boxes, Vec3<float> p) {
    return items_where(boxes.size(), [&](auto i) { return boxes[i].contains(p); });
}

void expect_all_answers(const BoxQueries& bvh, Boxes boxes) {
    const std::vector<Pair> pairs = brute_force(boxes);
    EXPECT_EQ(ascending(bvh.self_pairs()), pairs);
    EXPECT_EQ(bvh.self_pair_count(), pairs.size());

    const QueriesOfRegions q = queries_for(boxes);
    const auto of_boxes = bvh.overlapping(q.boxes);
    const auto of_balls = bvh.overlapping(q.balls);
    const auto of_points = bvh.containing(q.points);
    const std::vector<Neighbour> near = bvh.nearest(q.points, 3);
    const std::vector<Vec3<float>> two(2);
    EXPECT_THROW(bvh.nearest(two, std::size_t{1} << 63), std::length_error); // times 2 is 0
    ASSERT_EQ(of_boxes.size(), q.boxes.size());
    ASSERT_EQ(near.size(), 3 * q.points.size());
    const auto list = [](std::span<const std::uint32_t> items) {
        return Items(items.begin(), items.end());
    };
    for (std::size_t i = 0; i < q.boxes.size(); ++i) {
        const Items wanted = items_where(boxes.size(), [&](auto item) {
            return !q.boxes[i].is_empty() && overlaps(boxes[item], q.boxes[i]);
        });
        EXPECT_EQ(bvh.overlapping(q.boxes[i]), wanted);
        EXPECT_EQ(list(of_boxes[i]), wanted);
    }
    for (std::size_t i = 0; i < q.balls.size(); ++i)
        EXPECT_EQ(bvh.overlapping(q.balls[i]), list(of_balls[i]));
    for (std::size_t i = 0; i < q.points.size(); ++i) {
        EXPECT_EQ(bvh.containing(q.points[i]), in_boxes(boxes, q.points[i]));
        EXPECT_EQ(list(of_points[i]), in_boxes(boxes, q.points[i]));
        const std::vector<Neighbour> wanted = brute_nearest(boxes, q.points[i], 3);
        EXPECT_EQ(bvh.nearest(q.points[i], 3), wanted);
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(near[3 * i + k], k < wanted.size() ? wanted[k] : Neighbour{});
    }
}

TEST(Bvh, AnswersAsBruteForceWithAnyOptions) {
    for (const auto& [family, boxes] : box_families())
        for (const BvhOptions& options : some_options()) {
            SCOPED_TRACE(family + ", layout " + std::to_string(static_cast<int>(options.layout)));
            const Bvh bvh(boxes, options);
            EXPECT_EQ(bvh.size(), boxes.size());
            expect_all_answers(bvh, boxes);
        }
}

TEST(DynamicBvh, AnswersAsBruteForce) {
    for (const auto& [family, boxes] : box_families()) {
        SCOPED_TRACE(family);
        expect_all_answers(DynamicBvh(boxes), boxes);
        expect_all_answers(DynamicBvh(boxes, {.threads = 2}), boxes);
    }
}

TEST(Bvh, PairsOfTwoTrees) {
    const std::vector<Box> a = random_boxes(500, .2f, 1), b = random_boxes(300, .2f, 2);
    std::vector<Pair> wanted;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        for (std::uint32_t j = 0; j < b.size(); ++j)
            if (overlaps(a[i], b[j]))
                wanted.push_back({i, j});
    for (const BvhOptions& options : some_options()) {
        const Bvh first(a, options), second(b, options);
        EXPECT_EQ(ascending(first.pairs(second)), wanted);
        EXPECT_EQ(first.pair_count(second), wanted.size());
    }
    EXPECT_EQ(ascending(DynamicBvh(a).pairs(DynamicBvh(b))), wanted);
    EXPECT_THAT([&] { Bvh(a).pairs(DynamicBvh(b)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("both must have one layout")));
}

TEST(Bvh, FunctionsAreCalledUntilTheySayFalse) {
    const std::vector<Box> boxes = random_boxes(200, .5f, 3);
    const Bvh bvh(boxes);
    std::vector<Pair> all;
    bvh.self_pairs([&](Pair pair) { all.push_back(pair); });
    EXPECT_EQ(all, bvh.self_pairs());
    std::size_t calls = 0;
    bvh.self_pairs([&](Pair) { return ++calls < 5; });
    EXPECT_EQ(calls, 5u);
    const Bvh of_two(random_boxes(20'000, .02f, 3), {.threads = 2});
    std::vector<Pair> begun; // by the caller's thread alone, and in order
    of_two.self_pairs([&](Pair pair) {
        begun.push_back(pair);
        return begun.size() < 5;
    });
    std::vector<Pair> wanted = of_two.self_pairs();
    ASSERT_GT(wanted.size(), 1000u);
    wanted.resize(5);
    EXPECT_EQ(begun, wanted);
    std::size_t across = 0;
    of_two.pairs(of_two, [&](Pair) { return ++across < 5; });
    EXPECT_EQ(across, 5u);
    Items items;
    bvh.overlapping(boxes[0], [&](std::uint32_t item) { items.push_back(item); });
    EXPECT_EQ(items, bvh.overlapping(boxes[0]));
    const std::uint32_t first = items.front();
    bvh.overlapping(boxes[0], [&](std::uint32_t item) {
        EXPECT_EQ(item, first);
        return false;
    });
}

std::vector<Box> moved(std::vector<Box> boxes, float by, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> step(-by, by);
    for (Box& box : boxes) {
        const Vec3<float> d{step(random), step(random), step(random)};
        box = {box.min + d, box.max + d};
    }
    return boxes;
}

TEST(Bvh, FollowsBoxesThatMove) {
    for (const BvhOptions& options : some_options()) {
        SCOPED_TRACE(static_cast<int>(options.layout));
        std::vector<Box> boxes = random_boxes(400, .05f, 4);
        Bvh bvh(boxes, options);
        boxes = moved(boxes, 1e-4f, 1);
        bvh.update(boxes);
        EXPECT_EQ(bvh.rebuilds(), 0u) << "a small step is no reason to build again";
        expect_all_answers(bvh, boxes);
        boxes = moved(boxes, .5f, 2);
        bvh.update(boxes);
        EXPECT_EQ(bvh.rebuilds(), 1u);
        expect_all_answers(bvh, boxes);
        boxes.resize(123);
        bvh.update(boxes);
        expect_all_answers(bvh, boxes);
        boxes = random_boxes(500, .1f, 5);
        bvh.update(boxes);
        expect_all_answers(bvh, boxes);
    }
}

TEST(Bvh, ChecksTheListOfMovedItems) {
    for (const BvhOptions& options : some_options()) {
        std::vector<Box> boxes = random_boxes(400, .1f, 6);
        const std::vector<Box> before = boxes;
        Bvh bvh(boxes, options);
        boxes[7] = boxes[300] = {{.2f, .2f, .2f}, {.3f, .3f, .3f}};
        const auto update = [&](const Items& list) {
            return [&, list] { bvh.update(boxes, list); };
        };
        EXPECT_THAT(update({7}), ThrowsMessage<std::invalid_argument>(HasSubstr("item 300")));
        EXPECT_THAT(update({}), ThrowsMessage<std::invalid_argument>(HasSubstr("item 7 ")));
        EXPECT_THAT(update({300, 7}), ThrowsMessage<std::invalid_argument>(HasSubstr("ascend")));
        EXPECT_THAT(update({7, 300, 400}), ThrowsMessage<std::invalid_argument>(HasSubstr("400")));
        expect_all_answers(bvh, before);
        bvh.update(boxes, Items{7, 8, 300}); // may list more
        expect_all_answers(bvh, boxes);
        boxes.pop_back();
        EXPECT_THAT(update({7, 300}), Throws<std::invalid_argument>());
    }
}

TEST(Bvh, RefusesBadBoxesByIndexAndStaysAsItWas) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Box> good = random_boxes(50, .3f, 7);
    std::vector<Box> bad = good;
    bad[31].max.y = nan;
    for (const BvhOptions& options : some_options()) {
        EXPECT_THAT([&] { Bvh(bad, options); }, ThrowsMessage<InvalidBox>(HasSubstr("box 31")));
        Bvh bvh(good, options);
        EXPECT_THROW(bvh.update(bad), InvalidBox);
        EXPECT_THROW(bvh.update(bad, Items{31}), InvalidBox);
        EXPECT_THROW(bvh.rebuild(bad), InvalidBox);
        expect_all_answers(bvh, good);
    }
    EXPECT_THROW(DynamicBvh{bad}, InvalidBox);
}

TEST(Bvh, RefusesOptionsThatMakeNoSense) {
    const std::vector<Box> boxes = random_boxes(5, .3f, 7);
    EXPECT_THROW(Bvh(boxes, {.builder = BuildFunction{}}), std::invalid_argument);
    EXPECT_THROW(Bvh(boxes, {.threads = 0}), std::invalid_argument);
    EXPECT_THROW(Bvh(boxes, {.threads = 2, .executor = make_executor("serial", 1)}),
                 std::invalid_argument);
    EXPECT_THROW(Bvh(boxes, {.rebuild_above = .5}), std::invalid_argument);
    EXPECT_THROW(Bvh(boxes, {.rebuild_above = std::numeric_limits<double>::quiet_NaN()}),
                 std::invalid_argument);
}

TEST(Bvh, NamesItsLayoutsAndKernelsAsTheRegistriesDo) {
    EXPECT_EQ(layout_entry_of(LayoutName::binary).name, "binary");
    EXPECT_EQ(layout_entry_of(LayoutName::wide8_f64).name, "wide8_f64");
    EXPECT_EQ(layout_entry_of(LayoutName::packed).name, "packed");
    EXPECT_EQ(to_string(RayKernelName::moller_trumbore_f32), "moller_trumbore_f32");
    EXPECT_EQ(to_string(RayKernelName::baldwin_weber_f32), "baldwin_weber_f32");
    EXPECT_EQ(to_string(RayKernelName::plucker_f32), "plucker_f32");
    EXPECT_EQ(to_string(RayKernelName::watertight), "watertight");
    EXPECT_EQ(to_string(RayKernelName::moller_trumbore_f64), "moller_trumbore_f64");
    EXPECT_EQ(to_string(RayKernelName::exact), "exact");
}

TEST(Bvh, MovesWithWhatItHolds) {
    const std::vector<Box> boxes = random_boxes(100, .3f, 8);
    Bvh a(boxes), b;
    EXPECT_TRUE(b.empty());
    b = std::move(a);
    expect_all_answers(b, boxes);
    const Bvh c(std::move(b));
    expect_all_answers(c, boxes);
}

// Doubles.

using Boxes64 = std::vector<Aabb<double>>;

/// Boxes a few ulps of a float apart, where rounding to floats makes some overlap that do not.
Boxes64 close_boxes(std::size_t n, double where, double step, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> place(0, 40), extent(0, 5);
    Boxes64 boxes(n);
    for (Aabb<double>& box : boxes)
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = where + step * place(random);
            box.max[axis] = box.min[axis] + step * extent(random);
        }
    return boxes;
}

void expect_exact_answers(const BvhF64& bvh, const Boxes64& boxes) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a)
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
            if (overlaps(boxes[a], boxes[b]))
                pairs.push_back({a, b});
    EXPECT_EQ(ascending(bvh.self_pairs()), pairs);
    EXPECT_EQ(bvh.self_pair_count(), pairs.size());
    std::vector<Vec3<double>> points;
    for (const Aabb<double>& box : boxes)
        points.push_back(box.max);
    const AnswersOf<std::uint32_t> all = bvh.overlapping(boxes), at = bvh.containing(points);
    ASSERT_EQ(all.size(), boxes.size());
    const std::vector<Neighbour> near = bvh.nearest(points, 2);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        EXPECT_THAT(bvh.overlapping(boxes[i]), ElementsAreArray(all[i]));
        EXPECT_THAT(bvh.containing(points[i]), ElementsAreArray(at[i]));
        std::vector<Neighbour> two = bvh.nearest(points[i], 2);
        two.resize(2);
        EXPECT_THAT(std::span(near).subspan(2 * i, 2), ElementsAreArray(two));
    }
    for (std::size_t i = 0; i < boxes.size(); i += 3) {
        Aabb<double> box = boxes[i];
        const auto overlapping = [&] {
            return items_where(boxes.size(), [&](auto item) { return overlaps(boxes[item], box); });
        };
        EXPECT_EQ(bvh.overlapping(box), overlapping());
        box.max = box.min;
        EXPECT_EQ(bvh.overlapping(box), overlapping());
        EXPECT_EQ(bvh.containing(box.min), overlapping());
        const Vec3<double> outside = boxes[i].max + boxes[i].max - boxes[i].min;
        for (const Vec3<double> p : {box.min, outside}) {
            EXPECT_EQ(bvh.nearest(p, 4), brute_nearest<double>(boxes, p, 4));
            EXPECT_EQ(bvh.nearest(p, boxes.size() + 1),
                      brute_nearest<double>(boxes, p, boxes.size()));
        }
    }
}

TEST(BvhF64, IsExactWhereFloatsAreNot) {
    std::vector<Boxes64> families{{}};
    for (const auto& [where, step] :
         {std::pair{0., 1.}, {1., 0x1p-30}, {-1e6, 1e-4}, {1e30, 1e15}, {0., 1e-200}, {7., 1e-60}})
        families.push_back(close_boxes(300, where, step, 9));
    for (const auto& [family, boxes] : box_families())
        if (boxes.size() <= 600) {
            families.emplace_back();
            for (const Box& box : boxes)
                families.back().push_back(static_cast<Aabb<double>>(box));
        }
    for (const Boxes64& boxes : families) {
        expect_exact_answers(BvhF64(boxes), boxes);
        expect_exact_answers(
            BvhF64(boxes,
                   {.builder = BinnedSahBuilder{}, .layout = LayoutName::wide16, .threads = 2}),
            boxes);
    }
    // The test has a point: rounded outward, some of these overlap that do not.
    std::vector<Box> rounded;
    for (const Aabb<double>& box : families[2])
        rounded.push_back(round_outward(box));
    EXPECT_GT(brute_force(rounded).size(), BvhF64(families[2]).self_pair_count());
}

TEST(BvhF64, FollowsBoxesThatMoveAndChecksTheList) {
    Boxes64 boxes = close_boxes(200, 1, 0x1p-30, 10);
    BvhF64 bvh(boxes);
    boxes[5].max.x += 0x1p-40; // less than any float sees
    const auto update = [&](const Items& list) { return [&, list] { bvh.update(boxes, list); }; };
    EXPECT_THAT(update({}), ThrowsMessage<std::invalid_argument>(HasSubstr("item 5 ")));
    EXPECT_THAT(update({7, 5}), ThrowsMessage<std::invalid_argument>(HasSubstr("do not ascend")));
    bvh.update(boxes, Items{5});
    expect_exact_answers(bvh, boxes);
    boxes = close_boxes(250, 1, 0x1p-29, 11);
    bvh.update(boxes);
    expect_exact_answers(bvh, boxes);
}

/// Functions are handed what is so in doubles, and one that returns false ends the query.
TEST(BvhF64, HandsAnswersToFunctions) {
    const Boxes64 a = close_boxes(200, 1, 0x1p-30, 14), b = close_boxes(150, 1, 0x1p-30, 15);
    const BvhF64 bvh(a), other(b);
    std::vector<Pair> own, with, first;
    bvh.self_pairs([&](Pair p) { own.push_back(p); });
    bvh.pairs(other, [&](Pair p) { with.push_back(p); });
    EXPECT_EQ(ascending(own), ascending(bvh.self_pairs()));
    EXPECT_EQ(ascending(with), ascending(bvh.pairs(other)));
    bvh.self_pairs([&](Pair p) {
        first.push_back(p);
        return first.size() < 3;
    });
    ASSERT_EQ(first.size(), 3u);
    EXPECT_THAT(own, IsSupersetOf(first));
    std::size_t n_asked = 0;
    bvh.pairs(other, [&](Pair) { return ++n_asked < 2; });
    EXPECT_EQ(n_asked, 2u);
    for (const Aabb<double>& box : b) {
        Items items, at, one;
        bvh.overlapping(box, [&](std::uint32_t item) { items.push_back(item); });
        bvh.containing(box.min, [&](std::uint32_t item) { at.push_back(item); });
        bvh.overlapping(box, [&](std::uint32_t item) {
            one.push_back(item);
            return false;
        });
        EXPECT_EQ(items, items_where(a.size(), [&](auto item) { return overlaps(a[item], box); }));
        EXPECT_EQ(at, bvh.containing(box.min));
        EXPECT_EQ(one.size(), std::min<std::size_t>(1, items.size()));
    }
    const auto refuse = [](std::uint32_t) { ADD_FAILURE(); };
    const Vec3<double> inside = 0.5 * (a[7].min + a[7].max);
    Aabb<double> inverted{inside, inside};
    inverted.max.x -= 0x1p-50; // both corners are within a box
    ASSERT_TRUE(overlaps(a[7], inverted));
    bvh.overlapping(inverted, refuse);
    bvh.containing({std::numeric_limits<double>::quiet_NaN(), 1, 1}, refuse);
}

TEST(BvhF64, PairsOfTwoTreesAndBadInput) {
    const Boxes64 a = close_boxes(100, 1, 0x1p-30, 12), b = close_boxes(150, 1, 0x1p-30, 13);
    std::vector<Pair> wanted;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        for (std::uint32_t j = 0; j < b.size(); ++j)
            if (overlaps(a[i], b[j]))
                wanted.push_back({i, j});
    EXPECT_EQ(ascending(BvhF64(a).pairs(BvhF64(b))), wanted);
    EXPECT_EQ(BvhF64(a).pair_count(BvhF64(b)), wanted.size());

    constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                     inf = std::numeric_limits<double>::infinity();
    const BvhF64 bvh(a);
    EXPECT_TRUE(bvh.containing({nan, 1, 1}).empty());
    EXPECT_TRUE(bvh.nearest({inf, 1, 1}).empty());
    const std::vector<Vec3<double>> points{{nan, 1, 1}, a[7].min};
    EXPECT_TRUE(bvh.containing(points)[0].empty());
    EXPECT_FALSE(bvh.containing(points)[1].empty());
    EXPECT_EQ(bvh.nearest(points, 3)[0], Neighbour{});
    EXPECT_NE(bvh.nearest(points, 3)[3], Neighbour{});
    EXPECT_THROW(bvh.nearest(points, std::numeric_limits<std::size_t>::max()), std::length_error);
    EXPECT_EQ(bvh.nearest({1, 1, 1}, std::numeric_limits<std::size_t>::max()).size(), a.size());
    EXPECT_TRUE(bvh.overlapping({{1, 1, nan}, {2, 2, 2}}).empty());
    const Vec3<double> inside{1 + 0x1p-26, 1 + 0x1p-26, 1 + 0x1p-26};
    Aabb<double> inverted{inside, inside};
    inverted.max.x -= 0x1p-50;
    EXPECT_TRUE(bvh.overlapping(inverted).empty());
    EXPECT_TRUE(bvh.overlapping(std::span<const Aabb<double>>(&inverted, 1))[0].empty());
    EXPECT_EQ(bvh.overlapping({{-inf, -inf, -inf}, {inf, inf, inf}}).size(), a.size());
    Boxes64 bad = a;
    bad[9].max.y = 1e39;
    EXPECT_THAT([&] { BvhF64 x(bad); }, ThrowsMessage<InvalidBox>(HasSubstr("box 9")));
    bad[3].min.z = nan;
    EXPECT_THAT([&] { BvhF64 x(bad); }, ThrowsMessage<InvalidBox>(HasSubstr("box 3")));
}

} // namespace
} // namespace boxwood
