#pragma once

#include "kernels/primitives/sphere.h"
#include "trees/tree.h"

#include <initializer_list>
#include <limits>
#include <random>
#include <vector>

namespace boxwood {

/// Points, boxes and balls to query a family with: at corners of items, around them, anywhere, and
/// such as hold nothing or everything.
struct QueriesOfRegions {
    std::vector<Vec3<float>> points;
    std::vector<Box> boxes;
    std::vector<Sphere<float>> balls;
};

inline QueriesOfRegions queries_for(Boxes items) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    std::mt19937 random(31);
    std::uniform_real_distribution<float> unit(0, 1);
    QueriesOfRegions q;
    q.points = {{0, 0, 0}, {nan, 0, 0}, {0, inf, 0}, {1e30f, -1e30f, 1e-30f}, {.5f, .5f, .5f}};
    for (int i = 0; i < 40 && !items.empty(); ++i) {
        const Box& item = items[random() % items.size()];
        const Box& other = items[random() % items.size()];
        q.points.push_back(i % 4 == 0 ? item.min : i % 4 == 1 ? item.max : other.min);
        if (i % 4 == 3)
            for (int axis = 0; axis < 3; ++axis)
                q.points.back()[axis] =
                    item.min[axis] * (1 - unit(random)) + other.max[axis] * unit(random);
    }
    for (const Vec3<float> p : q.points) {
        const Vec3<float> half{unit(random) * .1f, unit(random) * .1f, unit(random) * .1f};
        q.boxes.push_back({p - half, p + half});
        q.balls.push_back({p, half.x});
        const Vec3<float> other = q.points[random() % q.points.size()];
        q.boxes.push_back({min(p, other), max(p, other)});
        q.balls.push_back({p, length(p - other)});
    }
    for (const Box& box : std::initializer_list<Box>{{{-inf, -inf, -inf}, {inf, inf, inf}},
                                                     {{-inf, 0, 0}, {.3f, inf, .7f}},
                                                     {{inf, 0, 0}, {inf, inf, 1}},
                                                     {{1, 1, 1}, {0, 0, 0}},
                                                     {{0, nan, 0}, {1, 1, 1}},
                                                     {{0, 0, 0}, {1, 1, nan}}})
        q.boxes.push_back(box);
    for (const Sphere<float>& ball : std::initializer_list<Sphere<float>>{
             {{0, 0, 0}, inf}, {{0, 0, 0}, 0}, {{0, 0, 0}, -1}, {{0, 0, 0}, nan}, {{nan, 0, 0}, 1}})
        q.balls.push_back(ball);
    return q;
}

} // namespace boxwood
