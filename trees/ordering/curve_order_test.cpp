#include "kernels/testing/every_target.h"
#include "trees/ordering/curve_order.h"
#include "trees/testing/box_families.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace boxwood {
namespace {

using Cell = std::array<std::uint32_t, 3>;

/// Bit by bit, x highest.
std::uint64_t interleave(const Cell& cell, int bits) {
    std::uint64_t code = 0;
    for (int bit = bits; bit-- > 0;)
        for (const std::uint32_t x : cell)
            code = code << 1 | (x >> bit & 1);
    return code;
}

/// Points in a lattice of `side`^3, in random order, in a cube whose cells they fall into exactly:
/// the corners (0, 0, 0) and (side, side, side) come first.
std::vector<Box> lattice(int side, std::vector<Cell>& cells) {
    cells = {{0, 0, 0}};
    const std::uint32_t last = static_cast<std::uint32_t>(side);
    cells.push_back({last, last, last});
    for (std::uint32_t i = 1; i < last * last * last; ++i)
        cells.push_back({i % last, i / last % last, i / last / last});
    std::shuffle(cells.begin() + 2, cells.end(), std::mt19937(5));
    std::vector<Box> boxes;
    for (const Cell& c : cells) {
        const Vec3<float> p{static_cast<float>(c[0]), static_cast<float>(c[1]),
                            static_cast<float>(c[2])};
        boxes.push_back({p, p});
    }
    return boxes;
}

TEST(CurveOrder, MortonInterleavesTheBitsOfTheCells) {
    std::vector<Cell> cells;
    const std::vector<Box> boxes = lattice(16, cells);
    on_every_target([&] {
        const CurveOrder found = curve_order(boxes, Curve::morton, serial());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            Cell cell = cells[found.order[i]];
            for (std::uint32_t& x : cell)
                x = std::min(x << 17, (1u << 21) - 1);
            ASSERT_EQ(found.codes[i], interleave(cell, 21));
        }
    });
}

TEST(CurveOrder, HilbertStepsFromNeighbourToNeighbour) {
    std::vector<Cell> cells;
    const std::vector<Box> boxes = lattice(16, cells);
    const auto distance = [&](std::uint32_t a, std::uint32_t b) {
        std::uint32_t sum = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            sum +=
                std::max(cells[a][axis], cells[b][axis]) - std::min(cells[a][axis], cells[b][axis]);
        return sum;
    };
    const auto check = [&](std::span<const std::uint32_t> order) {
        std::vector<std::uint32_t> steps;
        for (const std::uint32_t item : order)
            if (item != 1) // the far corner, which makes the cube a power of two
                steps.push_back(item);
        ASSERT_EQ(steps.size(), 16u * 16 * 16);
        for (std::size_t i = 1; i < steps.size(); ++i)
            ASSERT_EQ(distance(steps[i - 1], steps[i]), 1u) << i;
    };
    on_every_target([&] {
        check(curve_order(boxes, Curve::hilbert, serial()).order.span());
        check(coarse_curve_order(boxes, Curve::hilbert, serial()).span());
    });
}

TEST(CurveOrder, IsSortedByCodeAndThenByItemOnEveryFamily) {
    for (const BoxFamily& family : box_families())
        for (const Curve curve : {Curve::morton, Curve::hilbert}) {
            SCOPED_TRACE(family.name);
            const std::size_t n = family.boxes.size();
            const CurveOrder found = curve_order(family.boxes, curve, serial());
            ASSERT_EQ(found.codes.size(), n);
            ASSERT_EQ(found.order.size(), n);
            for (std::size_t i = 1; i < n; ++i)
                ASSERT_LT(std::pair(found.codes[i - 1], found.order[i - 1]),
                          std::pair(found.codes[i], found.order[i]));
            const Buffer<std::uint32_t> coarse = coarse_curve_order(family.boxes, curve, serial());
            for (const std::span<const std::uint32_t> order :
                 {std::as_const(found).order.span(), coarse.span()}) {
                EXPECT_EQ(order.size(), n);
                std::vector<std::uint32_t> items(order.begin(), order.end()), all(items.size());
                std::iota(all.begin(), all.end(), 0u);
                std::ranges::sort(items);
                EXPECT_EQ(items, all);
            }
        }
}

TEST(CurveOrder, SpreadsItemsOutAtAnyScale) {
    for (const float scale : {1e-44f, 1e-30f, 1.f, 1e30f, 3e38f}) {
        std::vector<Box> boxes(20);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const float x = static_cast<float>(i * 7 % 20) / 20 * scale;
            boxes[i] = {{x, -x, 0}, {x, -x, 0}};
        }
        const CurveOrder found = curve_order(boxes, Curve::morton, serial());
        std::size_t codes = 1;
        for (std::size_t i = 1; i < boxes.size(); ++i)
            codes += found.codes[i] != found.codes[i - 1];
        // 1e-44 is 7 steps of the smallest float.
        EXPECT_GE(codes, scale < 1e-40f ? 7u : 20u) << scale;
    }
}

/// Spread out; in two heaps (few leading digits tell the items apart); and all the same.
std::vector<std::vector<Box>> crowds(std::size_t n) {
    std::vector<std::vector<Box>> all{random_boxes(n, .01f, 3), random_boxes(n, .01f, 4),
                                      std::vector<Box>(n, Box{{1, 2, 3}, {4, 5, 6}})};
    for (std::size_t i = 0; i < n; ++i) {
        Box& box = all[1][i];
        const Vec3<float> shift = i % 2 ? Vec3<float>{1, 1, 1} : Vec3<float>{0, 0, 0};
        box = {1e-4f * box.min + shift, 1e-4f * box.max + shift};
    }
    return all;
}

TEST(CurveOrder, IsTheSameOnEveryExecutorAndInstructionSet) {
    for (const std::vector<Box>& boxes : crowds(40000))
        for (const Curve curve : {Curve::morton, Curve::hilbert}) {
            const CurveOrder expected = curve_order(boxes, curve, serial());
            const Buffer<std::uint32_t> coarse = coarse_curve_order(boxes, curve, serial());
            std::vector<std::uint32_t> items(coarse.begin(), coarse.end());
            std::ranges::sort(items);
            for (std::uint32_t i = 0; i < items.size(); ++i)
                ASSERT_EQ(items[i], i);
            for (std::size_t i = 1; i < boxes.size(); ++i)
                ASSERT_LT(std::pair(expected.codes[i - 1], expected.order[i - 1]),
                          std::pair(expected.codes[i], expected.order[i]));
            const auto check = [&](const Executor& executor) {
                const CurveOrder found = curve_order(boxes, curve, executor);
                EXPECT_TRUE(std::ranges::equal(found.codes, expected.codes));
                EXPECT_TRUE(std::ranges::equal(found.order, expected.order));
                EXPECT_TRUE(std::ranges::equal(coarse_curve_order(boxes, curve, executor), coarse));
            };
            for (const std::string_view name : {"openmp", "tbb"})
                for (const unsigned threads : {2u, 4u})
                    check(*make_executor(name, threads));
            on_every_target([&] { check(serial()); });
        }
}

TEST(CurveOrder, NeighboursInACrowdAreNeighboursInTheOrder) {
    // A cloud that is one cell of the room, which holds another that is one cell of that.
    std::vector<Box> boxes = random_boxes(6000, .001f, 9);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const float scale = i % 100 == 0 ? 1
                            : i % 2      ? 1e-3f
                                         : 1e-5f; // one in a hundred is anywhere
        boxes[i] = {scale * boxes[i].min, scale * boxes[i].max};
    }
    const auto mean_step = [&](std::span<const std::uint32_t> order, float scale) {
        double sum = 0, n = 0;
        const Box* last = nullptr;
        for (const std::uint32_t item : order)
            if ((item % 100 != 0) && (item % 2 ? 1e-3f : 1e-5f) == scale) {
                if (last)
                    sum += static_cast<double>(length(boxes[item].min - last->min) / scale), ++n;
                last = &boxes[item];
            }
        return sum / n;
    };
    const auto coarse = coarse_curve_order(boxes, Curve::hilbert, serial());
    const auto in_blocks = block_curve_order(boxes, Curve::hilbert, nullptr, serial());
    for (const float scale : {1e-3f, 1e-5f}) // in any order a step is two thirds of the cloud
        for (const auto& order : {coarse.span(), in_blocks.span()})
            EXPECT_LT(mean_step(order, scale), 0.15) << scale;
}

TEST(CurveOrder, NamesTheFirstBadBox) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float inf = std::numeric_limits<float>::infinity();
    for (const Box& bad :
         {Box{{nan, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {1, 1, nan}}, Box{{0, -inf, 0}, {1, 1, 1}},
          Box{{0, 0, -inf}, {1, 1, inf}}, Box{{0, 0, 2}, {1, 1, 1}}, Box{}})
        for (const std::size_t n : {1u, 30u, 31u, 32u})
            for (std::size_t at = 0; at < n; ++at) {
                std::vector<Box> boxes = random_boxes(n, .1f, 1);
                boxes[at] = boxes[n - 1] = bad;
                on_every_target([&] {
                    EXPECT_THAT(
                        [&] { curve_order(boxes, Curve::hilbert, serial()); },
                        testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, at)));
                });
            }
}

TEST(CurveOrder, PutsGroupsOneAfterAnotherAndIsTheSameOnEveryTargetAndExecutor) {
    const GroupOfBox by_length = [](const Box& box) -> std::uint32_t {
        return box.max.x - box.min.x > box.max.y - box.min.y;
    };
    for (const BoxFamily& family : box_families()) {
        SCOPED_TRACE(family.name);
        const Boxes boxes = family.boxes;
        const auto order_on = [&](const Executor& executor) {
            const auto order = block_curve_order(boxes, Curve::hilbert, by_length, executor);
            return std::vector<std::uint32_t>(order.begin(), order.end());
        };
        const std::vector<std::uint32_t> order = order_on(serial());
        on_every_target([&] { EXPECT_EQ(order_on(*make_executor("tbb", 2)), order); });
        std::vector<std::uint32_t> groups, items = order, all(boxes.size());
        for (const std::uint32_t item : order)
            groups.push_back(by_length(boxes[item]));
        EXPECT_TRUE(std::ranges::is_sorted(groups));
        std::iota(all.begin(), all.end(), 0u);
        std::ranges::sort(items);
        EXPECT_EQ(items, all);
    }
}

} // namespace
} // namespace boxwood
