#include "scenes/sampling/scatter.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood {
namespace {

/// Counts all pairs by a sweep along x: no formula and no tree.
double mean_overlaps(std::vector<Aabb<float>> boxes) {
    std::ranges::sort(boxes, {}, [](const Aabb<float>& box) { return box.min.x; });
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = i + 1; j < boxes.size() && boxes[j].min.x <= boxes[i].max.x; ++j)
            pairs += overlaps(boxes[i], boxes[j]);
    return 2.0 * static_cast<double>(pairs) / static_cast<double>(boxes.size());
}

struct Wanted {
    const char* generator;
    double overlaps, tolerance; ///< relative
};

class Overlaps : public testing::TestWithParam<Wanted> {};

TEST_P(Overlaps, AreAsManyAsWanted) {
    const auto [generator, wanted, tolerance] = GetParam();
    const Scene scene =
        make_scene({.generator = generator, .n = 10000, .seed = 5, .overlaps = wanted});
    EXPECT_NEAR(mean_overlaps(scene.boxes) / wanted, 1, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Scatter, Overlaps,
                         testing::Values(Wanted{"uniform", 10, 0.05}, Wanted{"uniform", 1, 0.08},
                                         Wanted{"uniform", 500, 0.05}, Wanted{"clusters", 10, 0.08},
                                         Wanted{"clusters", 1, 0.1}, Wanted{"bars", 10, 0.08},
                                         Wanted{"bars", 1, 0.1}, Wanted{"planks", 10, 0.08},
                                         Wanted{"planks", 1, 0.1}, Wanted{"needles", 10, 0.08},
                                         Wanted{"needles", 1, 0.1},
                                         Wanted{"triangle_soup", 10, 0.05},
                                         Wanted{"sliver_mesh", 10, 0.08}),
                         [](const auto& test) {
                             return std::string(test.param.generator) + "_" +
                                    std::to_string(static_cast<int>(test.param.overlaps));
                         });

TEST(Scatter, FewBoxesOverlapHalfOfTheOthers) {
    double sum = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed)
        sum += mean_overlaps(make_scene({.generator = "uniform", .n = 9, .seed = seed}).boxes);
    EXPECT_NEAR(sum / 200, 4, 0.4);
}

// Two cubes of half size h with centres uniform in the unit cube: (2t - t^2)^3 with t = 2h.
TEST(Scatter, TheScaleSolvesAClosedForm) {
    const PlacementPair pair{{.half = {1, 1, 1}}, {.half = {1, 1, 1}}, 1};
    for (const double probability : {1e-12, 1e-6, 1e-3, 0.5}) {
        const double t = 2 * scale_of({&pair, 1}, probability);
        EXPECT_NEAR(std::pow(2 * t - t * t, 3) / probability, 1, 1e-4);
    }
}

// Centres in [0, 1] and in [2, 2.5], on x alone: they come within t with probability
// (t - 1)^2 / (2 * 0.5) for 1 <= t <= 1.5.
TEST(Scatter, TheScaleKnowsBoxesThatLieApart) {
    const PlacementPair pair{
        {.half = {1, 9, 9}}, {.low = {2, 0, 0}, .side = {0.5, 1, 1}, .half = {0, 9, 9}}, 1};
    EXPECT_NEAR(scale_of({&pair, 1}, 0.09), 1.3, 1e-4);
}

TEST(Scatter, RefusesWhatMakesNoSense) {
    for (const char* generator : {"uniform", "clusters", "bars", "triangle_soup"}) {
        EXPECT_THROW(make_scene({.generator = generator, .n = 0}), std::invalid_argument);
        for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL})
            EXPECT_THROW(make_scene({.generator = generator, .n = 10, .overlaps = bad}),
                         std::invalid_argument);
    }
}

} // namespace
} // namespace boxwood
