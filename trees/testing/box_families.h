#pragma once

#include "trees/testing/brute_force.h"
#include "trees/tree.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace boxwood {

/// Boxes to try a tree on.
struct BoxFamily {
    std::string name;
    std::vector<Box> boxes;
};

/// n boxes with their lower corners in the unit cube and sides of up to `size`.
inline std::vector<Box> random_boxes(std::size_t n, float size, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(0, 1), extent(0, size);
    std::vector<Box> boxes(n);
    for (Box& box : boxes) {
        box.min = {place(random), place(random), place(random)};
        box.max = box.min + Vec3<float>{extent(random), extent(random), extent(random)};
    }
    return boxes;
}

/// The hard families of boxes: flat, points, identical, nested, touching, sorted, huge, tiny.
inline std::vector<BoxFamily> box_families() {
    std::vector<BoxFamily> all;
    for (const std::size_t n : {0u, 1u, 2u, 3u, 7u, 8u, 9u, 17u, 100u, 1000u})
        all.push_back({"random " + std::to_string(n), random_boxes(n, .2f, 7)});
    all.push_back({"random, few overlaps", random_boxes(6000, .02f, 8)});
    BoxFamily f{"lattice of touching unit cubes", {}};
    for (int i = 0; i < 512; ++i) {
        const Vec3<float> p{static_cast<float>(i % 8), static_cast<float>(i / 8 % 8),
                            static_cast<float>(i / 64)};
        f.boxes.push_back({p, p + Vec3<float>{1, 1, 1}});
    }
    all.push_back(f);
    f = {"identical boxes", std::vector<Box>(300, Box{{-1, -1, -1}, {1, 1, 1}})};
    all.push_back(f);
    f = {"identical points", std::vector<Box>(300, Box{{1, 2, 3}, {1, 2, 3}})};
    all.push_back(f);
    f = {"nested boxes", {}};
    for (int i = 0; i < 200; ++i) {
        const float r = static_cast<float>(i);
        f.boxes.push_back({{-r, -r, -r}, {r, r, r}});
    }
    all.push_back(f);
    f = {"flat, along a line", {}};
    for (int i = 0; i < 500; ++i) {
        const float x = static_cast<float>(i);
        f.boxes.push_back({{x, 0, 0}, {x + 1, 0, 0}});
    }
    all.push_back(f);
    f = {"geometric, sorted", {}};
    for (int i = -120; i < 120; ++i) {
        const float x = std::ldexp(1.0f, i);
        f.boxes.push_back({{x, x, x}, {1.5f * x, 2 * x, 2 * x}});
    }
    all.push_back(f);
    constexpr float max_float = std::numeric_limits<float>::max();
    f = {"whole space and corners", random_boxes(50, .5f, 9)};
    f.boxes.push_back({{-max_float, -max_float, -max_float}, {max_float, max_float, max_float}});
    f.boxes.push_back({{max_float, max_float, max_float}, {max_float, max_float, max_float}});
    f.boxes.push_back({{-max_float, -max_float, -max_float}, {-max_float, -max_float, -max_float}});
    all.push_back(f);
    constexpr float tiny = std::numeric_limits<float>::denorm_min();
    f = {"denormal", {}};
    for (int i = 0; i < 64; ++i) {
        const float x = static_cast<float>(i) * tiny;
        f.boxes.push_back({{x, -x, 0}, {x + tiny, -x, tiny}});
    }
    all.push_back(f);
    return all;
}

} // namespace boxwood
