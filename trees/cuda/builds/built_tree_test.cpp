#include "trees/builders/hilbert.h"
#include "trees/cuda/builds/built_tree.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/cuda/testing/packed_layout.h"
#include "trees/ordering/curve_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

namespace boxwood::cuda {
namespace {

constexpr Form forms[] = {Form::packed, Form::radix, Form::hploc, Form::radix_wide8,
                          Form::hploc_wide8};

BoxFamily crowd() {
    BoxFamily family{"in few cells", random_boxes(600, .0001f, 3)};
    for (std::size_t i = 1; i < 600; ++i)
        for (Vec3<float>* corner : {&family.boxes[i].min, &family.boxes[i].max})
            *corner = .001f * *corner;
    family.boxes[0] = {{9, 9, 9}, {10, 10, 10}};
    return family;
}

BoxFamily bars() {
    BoxFamily family{"bars", random_boxes(1000, .01f, 6)};
    for (std::size_t i = 0; i < 1000; ++i)
        family.boxes[i].max[static_cast<int>(i % 3)] += 2;
    return family;
}

/// By group, code and item.
std::vector<std::uint32_t> packed_order(const std::vector<Box>& boxes, bool fine) {
    const std::size_t n = boxes.size();
    const CurveGrid grid = curve_grid(boxwood::measure_centres(boxes).box, fine ? 21 : 10);
    std::vector<std::uint32_t> coarse(n), order(n);
    std::vector<std::uint64_t> codes(n);
    coarse_codes(boxes, Curve::hilbert, grid, coarse.data());
    fine ? fine_codes(boxes, Curve::hilbert, grid, codes.data())
         : void(std::ranges::copy(coarse, codes.begin()));
    if (const GroupOfBox group = HilbertBuilder::groups(boxes))
        for (std::size_t i = 0; i < n; ++i)
            codes[i] = std::uint64_t{group(boxes[i])} << 62 | codes[i] >> (fine ? 1 : 0);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return codes[i]; });
    return order;
}

void expect_packed(const BuiltTree& made, const std::vector<Box>& boxes,
                   std::span<const std::uint32_t> order) {
    const PackedLayout wanted = PackedLayout::of_order(boxes, order, serial());
    const PackedView& view = made.packed();
    ASSERT_EQ(view.n, boxes.size());
    ASSERT_EQ(view.depth, wanted.depth());
    EXPECT_TRUE(same_bytes(view.items, wanted.items().data(), wanted.items().size_bytes()));
    for (unsigned l = 0; l < view.depth; ++l)
        EXPECT_TRUE(same_bytes(view.blocks + view.first[l], wanted.level(l).data(),
                               wanted.level(l).size_bytes()));
    if (!boxes.empty()) {
        EXPECT_EQ(*made.bounds(), wanted.bounds());
    }
}

/// Checks all boxes of a tree with pointers, and counts its items.
struct Traversed {
    const BuiltTree& made;
    const std::vector<Box>& boxes;
    std::vector<int> items;

    Traversed(const BuiltTree& of, const std::vector<Box>& with)
        : made(of), boxes(with), items(with.size()) {
        if (!boxes.empty() && made.form() >= Form::radix_wide8) {
            EXPECT_EQ(wide8(0), *made.bounds());
        } else if (!boxes.empty() && made.form() == Form::radix) {
            binary(made.radix(), *made.radix().root);
        } else if (!boxes.empty()) {
            binary(made.hploc(), *made.hploc().root);
        }
        EXPECT_EQ(items, std::vector<int>(boxes.size(), 1));
    }
    Box item(std::uint32_t i) {
        ++items.at(i);
        return boxes[i];
    }
    template <class View> Box binary(const View& view, std::uint32_t ref) {
        if (RadixTreeView::is_leaf(ref))
            return item(view.items[RadixTreeView::slot(ref)]);
        Box box = binary(view, view.nodes[ref].left);
        box.extend(binary(view, view.nodes[ref].right));
        EXPECT_EQ(view.nodes[ref].box, box);
        return box;
    }
    Box wide8(std::uint32_t ref) {
        const Wide8Node& node = made.wide8().nodes[ref];
        Box all;
        for (unsigned lane = 0; lane < 8; ++lane) {
            const std::uint32_t child = node.ref[lane];
            if (child == nobody)
                continue;
            const Box box = Wide8View::is_leaf(child)
                                ? item(made.wide8().items[Wide8View::slot(child)])
                                : wide8(child);
            const Box noted{{node.plane[0][lane], node.plane[1][lane], node.plane[2][lane]},
                            {node.plane[3][lane], node.plane[4][lane], node.plane[5][lane]}};
            EXPECT_EQ(noted, box);
            all.extend(box);
        }
        return all;
    }
};

void expect_tree(const BuiltTree& made, const std::vector<Box>& boxes) {
    if (made.form() == Form::packed) {
        const std::span<const std::uint32_t> order(made.packed().items, boxes.size());
        std::vector<std::uint32_t> items(order.begin(), order.end());
        std::ranges::sort(items);
        for (std::uint32_t i = 0; i < items.size(); ++i)
            ASSERT_EQ(items[i], i);
        expect_packed(made, boxes, order);
    } else {
        const Traversed traversed(made, boxes);
    }
}

TEST(BuiltTree, PackedHasTheOrderOfTheCpusCodes) {
    std::vector<BoxFamily> families = device_families();
    families.push_back(bars());
    families.push_back(crowd());
    for (const BoxFamily& family : families) {
        SCOPED_TRACE(family.name);
        on_host::set_seed(family.boxes.size());
        BuiltTree made;
        made.enqueue(family.boxes.data(), family.boxes.size(), {});
        expect_packed(made, family.boxes, packed_order(family.boxes, false));
        const bool fine = !made.check(family.boxes.data(), {});
        if (family.boxes.size() > 1000) {
            EXPECT_FALSE(fine);
        } else if (family.name == "in few cells" || family.name == "identical boxes") {
            EXPECT_TRUE(fine);
        }
        if (fine) {
            made.build(family.boxes.data(), family.boxes.size(), {});
            expect_packed(made, family.boxes, packed_order(family.boxes, true));
            EXPECT_TRUE(made.check(family.boxes.data(), {}));
        }
    }
}

TEST(BuiltTree, HasTheOrderOfTheCpuAndHoldsEachItemOnce) {
    for (const BoxFamily& family : device_families())
        for (const Form form : forms) {
            if (form == Form::packed || family.boxes.size() > 1000)
                continue; // above; and where the kernels' own tests are
            SCOPED_TRACE(family.name + ", form " + std::to_string(static_cast<int>(form)));
            on_host::set_seed(family.boxes.size());
            BuiltTree made({.form = form});
            made.build(family.boxes.data(), family.boxes.size(), {});
            const CurveOrder order = curve_order(family.boxes, Curve::hilbert, serial());
            EXPECT_TRUE(std::ranges::equal(std::span(made.radix().items, family.boxes.size()),
                                           order.order));
            expect_tree(made, family.boxes);
        }
}

TEST(BuiltTree, IsBuiltAgainWhereItIs) {
    for (const Form form : forms) {
        SCOPED_TRACE(static_cast<int>(form));
        BuiltTree made({.form = form, .refits_some = form == Form::packed});
        made.build(random_boxes(700, .1f, 1).data(), 700, {});
        const auto places = [&] {
            return std::vector<const void*>{
                made.packed().blocks, made.packed().items, made.radix().nodes,
                made.radix().leaves,  made.hploc().nodes,  made.wide8().nodes,
                made.wide8().items,   made.radix().root,   made.bounds()};
        };
        const auto first = places();
        for (const std::size_t n : {700u, 699u, 0u, 17u, 1u, 2u, 700u}) {
            const std::vector<Box> boxes = random_boxes(n, .1f, 2);
            made.enqueue(boxes.data(), n, {});
            EXPECT_TRUE(made.check(boxes.data(), {}));
            EXPECT_EQ(made.size(), n);
            expect_tree(made, boxes);
            EXPECT_EQ(places(), first);
            const std::vector<Box> moved = random_boxes(n, .2f, 3);
            made.refit(moved.data(), {});
            expect_tree(made, moved);
            EXPECT_EQ(places(), first);
        }
        const std::vector<Box> more = random_boxes(1500, .1f, 4);
        made.build(more.data(), 1500, {});
        expect_tree(made, more);
    }
}

TEST(BuiltTree, RefitsSomeItems) {
    std::vector<Box> boxes = random_boxes(500, .1f, 1);
    BuiltTree made({.refits_some = true});
    made.build(boxes.data(), boxes.size(), {});
    const std::vector<std::uint32_t> moved{3, 499, 77, 3};
    for (const std::uint32_t item : moved)
        boxes[item].max = boxes[item].max + Vec3<float>{1, 2, 3};
    made.refit(boxes.data(), moved.data(), moved.size(), {});
    expect_tree(made, boxes);
    BuiltTree other({.form = Form::radix});
    other.build(boxes.data(), boxes.size(), {});
    EXPECT_THROW(other.refit(boxes.data(), moved.data(), moved.size(), {}), std::logic_error);
}

TEST(BuiltTree, RefusesBadBoxesAsTheCpuDoes) {
    const float inf = Box::inf, nan = std::nanf("");
    for (const Form form : forms)
        for (const Box& bad :
             {Box{{nan, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {1, inf, 1}}, Box{{0, 0, 2}, {1, 1, 1}},
              Box{{0, -inf, 0}, {1, 1, 1}}, Box{}, Box{{nan, nan, nan}, {nan, nan, nan}}}) {
            std::vector<Box> boxes = random_boxes(300, .1f, 1);
            boxes[299] = boxes[41] = boxes[100] = bad;
            std::string wanted;
            try {
                require_valid(boxes);
            } catch (const InvalidBox& error) {
                wanted = error.what();
            }
            BuiltTree made({.form = form});
            try {
                made.build(boxes.data(), boxes.size(), {});
                ADD_FAILURE();
            } catch (const InvalidBox& error) {
                EXPECT_EQ(error.index, 41u);
                EXPECT_EQ(error.what(), wanted);
            }
            EXPECT_EQ(made.size(), 0u);
            boxes[41] = boxes[299] = boxes[100] = {};
        }
    BuiltTree made;
    const std::vector<Box> good = random_boxes(300, .1f, 1);
    std::vector<Box> boxes = good;
    EXPECT_THROW(made.build(boxes.data(), max_items + 1, {}), std::length_error);
    made.build(boxes.data(), 300, {});
    boxes[7].min.x = nan;
    made.look(boxes.data(), {});
    EXPECT_THROW(made.check(boxes.data(), {}), InvalidBox);
}

TEST(BuiltTree, SaysHowMuchMemoryItTakes) {
    const std::size_t n = 1000000;
    EXPECT_LT(BuiltTree::bytes({.form = Form::packed}, n), 70 * n);
    EXPECT_LT(BuiltTree::bytes({.form = Form::radix}, n), 110 * n);
    EXPECT_LT(BuiltTree::bytes({.form = Form::hploc}, n), 110 * n);
    EXPECT_LT(BuiltTree::bytes({.form = Form::hploc_wide8}, n), 400 * n);
    EXPECT_LT(BuiltTree::bytes({}, 0), 1000u);
}

} // namespace
} // namespace boxwood::cuda
