#include "trees/dynamic/detail/widen.h"
#include "trees/dynamic/update.h"
#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

/// Boxes that are widened by a margin before a policy takes them: every pair that is within twice
/// the margin is found, in every frame.
namespace boxwood {
namespace {

/// Whether no axis parts the boxes by more than `far`. The boxes stand on a lattice, so that the
/// differences are exact.
bool within(const Box& a, const Box& b, double far) {
    for (int axis = 0; axis < 3; ++axis)
        if (double{b.min[axis]} - double{a.max[axis]} > far ||
            double{a.min[axis]} - double{b.max[axis]} > far)
            return false;
    return true;
}

TEST(MarginPairs, EveryPairWithinTheMarginIsFoundByEveryPolicy) {
    constexpr std::uint32_t n = 250;
    for (const double margin : {0., .1, 1. / 3, 0x1p-10, .5, 1. + 0x1p-30})
        for (const UpdateEntry& entry : updates()) {
            SCOPED_TRACE(std::string(entry.name) + ", margin " + std::to_string(margin));
            std::mt19937 random(41);
            const auto place = [&](int cells) {
                return static_cast<float>(random() % static_cast<unsigned>(cells)) * 0x1p-4f;
            };
            std::vector<Box> boxes(n), widened;
            const auto put = [&](Box& box) {
                box.min = {place(160), place(160), place(80)};
                box.max = box.min + Vec3<float>{place(12), place(12), place(12)};
            };
            std::ranges::for_each(boxes, put);
            const auto updater = entry.make({});
            detail::widen_boxes(boxes, margin, widened, serial());
            updater->start(widened, serial());
            for (int frame = 0; frame < 20; ++frame) {
                std::vector<std::uint32_t> moved;
                for (std::uint32_t i = 0; i < n; ++i) {
                    if (random() % 3 == 0) {
                        const Vec3<float> by{place(3) - 0x1p-4f, place(3) - 0x1p-4f, 0};
                        boxes[i] = {boxes[i].min + by, boxes[i].max + by};
                    } else if (random() % 40 == 0) {
                        put(boxes[i]);
                    } else {
                        continue;
                    }
                    moved.push_back(i);
                }
                detail::widen_boxes(boxes, margin, widened, serial());
                updater->update(widened, moved, serial());
                std::vector<Pair> pairs;
                AppendPairs sink(pairs);
                updater->self_pairs(serial(), sink);
                std::ranges::sort(pairs);
                for (std::uint32_t a = 0; a < n; ++a)
                    for (std::uint32_t b = a + 1; b < n; ++b)
                        if (within(boxes[a], boxes[b], 2 * margin)) {
                            ASSERT_TRUE(std::ranges::binary_search(pairs, Pair{a, b}))
                                << a << ", " << b << ", frame " << frame;
                        }
                ASSERT_EQ(pairs, brute_force(widened)) << "frame " << frame;
            }
        }
}

} // namespace
} // namespace boxwood
