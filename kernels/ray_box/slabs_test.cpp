#include "kernels/ray_box/slabs.h"

#include "kernels/oracle/oracle.h"
#include "kernels/ray_box/plain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

namespace boxwood {
namespace {

using Box = Aabb<float>;
using Ray3 = Ray<float>;
__extension__ using Wide = __int128;
constexpr float inf_f = std::numeric_limits<float>::infinity();

static_assert(RayBoxKernel<RaySlabs> && RayBoxKernel<PlainSlabs>);

bool meets_plain(const Ray3& ray, const Box& box) {
    return clip(PlainSlabs(ray), box, ray.t_min, ray.t_max).hit();
}

bool meets(const Ray3& ray, const Box& box) {
    return clip(RaySlabs(ray), box, ray.t_min, ray.t_max).hit();
}

/// Exact truth for integer coordinates up to 2^61 and directions up to 2^31, t_min = 0, t_max =
/// inf: entry and exit as fractions num/den with den > 0, compared by cross multiplication.
bool truth(const Ray3& ray, const Box& box) {
    Wide entry = 0, entry_den = 1, exit = 1, exit_den = 0; // exit = 1/0: none yet
    for (int k = 0; k < 3; ++k) {
        const Wide o = static_cast<std::int64_t>(ray.origin[k]);
        const Wide d = static_cast<std::int64_t>(ray.direction[k]);
        Wide low = static_cast<std::int64_t>(box.min[k]) - o;
        Wide high = static_cast<std::int64_t>(box.max[k]) - o;
        if (d == 0) {
            if (low > 0 || high < 0)
                return false;
            continue;
        }
        if (d < 0)
            std::tie(low, high) = std::pair(-high, -low);
        const Wide den = d < 0 ? -d : d;
        if (low * entry_den > entry * den)
            std::tie(entry, entry_den) = std::pair(low, den);
        if (high * exit_den < exit * den)
            std::tie(exit, exit_den) = std::pair(high, den);
    }
    return entry * exit_den <= exit * entry_den;
}

TEST(RayBox, ExactOnSmallIntegers) {
    // Faces, edges, corners, +-0 components, flat boxes and points, the box behind: 200k of each.
    std::mt19937 random(3);
    const auto integer = [&](int low, int high) {
        return static_cast<float>(std::uniform_int_distribution(low, high)(random));
    };
    int hits = 0, zero_directions = 0, flat = 0;
    for (int i = 0; i < 200000; ++i) {
        Ray3 ray;
        Box box;
        for (int k = 0; k < 3; ++k) {
            ray.origin[k] = integer(-2, 2);
            ray.direction[k] = integer(-2, 2);
            if (ray.direction[k] == 0 && integer(0, 1) == 0)
                ray.direction[k] = -0.0f;
            box.min[k] = integer(-2, 2);
            box.max[k] = std::max(box.min[k], integer(-2, 2));
        }
        if (ray.direction == Vec3<float>{})
            continue;
        const bool hit = truth(ray, box);
        ASSERT_EQ(meets(ray, box), hit) << i;
        hits += hit;
        zero_directions += dot(ray.direction, ray.direction) <= 4;
        flat += box.half_area() == 0;
    }
    EXPECT_GT(hits, 10000);
    EXPECT_GT(zero_directions, 10000);
    EXPECT_GT(flat, 10000);
}

TEST(RayBox, TheLatticeOfSignedZerosFacesAndFlatBoxes) {
    // Per axis four directions and ten places of the origin to the box: 56 x 10^3 cases.
    struct Place {
        float origin, min, max;
    };
    const std::array<float, 4> components{0.0f, -0.0f, 1.0f, -1.0f};
    const std::array<Place, 10> places{{{-1, 0, 2},
                                        {0, 0, 2},
                                        {0, -0.0f, 2},
                                        {-0.0f, 0, 2},
                                        {1, 0, 2},
                                        {2, 0, 2},
                                        {3, 0, 2},
                                        {0, 1, 1},
                                        {1, 1, 1},
                                        {2, 1, 1}}};
    int cases = 0, hits = 0, plain_wrong = 0;
    for (std::size_t i = 0; i < 64; ++i)
        for (std::size_t j = 0; j < 1000; ++j) {
            const std::size_t d[3] = {i % 4, i / 4 % 4, i / 16},
                              p[3] = {j % 10, j / 10 % 10, j / 100};
            Ray3 ray;
            Box box;
            for (int k = 0; k < 3; ++k) {
                ray.direction[k] = components[d[k]];
                ray.origin[k] = places[p[k]].origin;
                box.min[k] = places[p[k]].min;
                box.max[k] = places[p[k]].max;
            }
            if (ray.direction == Vec3<float>{})
                continue;
            ++cases;
            const bool hit = oracle::ray_box(ray, box);
            ASSERT_EQ(hit, truth(ray, box)) << i << ' ' << j;
            ASSERT_EQ(meets(ray, box), hit) << i << ' ' << j;
            hits += hit;
            plain_wrong += meets_plain(ray, box) != hit;
        }
    EXPECT_EQ(cases, 56000);
    EXPECT_GT(hits, 5000);
    EXPECT_GT(plain_wrong, 100); // 0 * inf along a face
}

/// A ray and a box that touch in one point of the box's edge: entry through x, exit through y at
/// the same real t.
struct Corner {
    float cx, ox, dx, cy, oy, dy;

    Ray3 ray() const { return {{ox, oy, 0}, {dx, dy, 0}}; }
    Box box() const { return {{cx, -2 * cy, -1}, {2 * cx, cy, 1}}; }

    bool is_tie() const {
        const auto integer = [](float x) { return Wide{static_cast<std::int64_t>(x)}; };
        return (integer(cx) - integer(ox)) * integer(dy) ==
               (integer(cy) - integer(oy)) * integer(dx);
    }
    /// The plain slab test with the reciprocal of its exit raised by some ulp.
    bool survives_padding(int ulps) const {
        float exit_rdir = 1.0f / dy;
        for (int i = 0; i < ulps; ++i)
            exit_rdir = std::nextafter(exit_rdir, inf_f);
        return (cx - ox) * (1.0f / dx) <= (cy - oy) * exit_rdir;
    }
};

/// Mirrors the axes named in `mask`, then swaps x and z if bit 3 is set: still the same problem.
void mirror(Ray3& ray, Box& box, unsigned mask) {
    for (int k = 0; k < 3; ++k)
        if (mask >> k & 1u) {
            ray.origin[k] = -ray.origin[k];
            ray.direction[k] = -ray.direction[k];
            std::tie(box.min[k], box.max[k]) = std::pair(-box.max[k], -box.min[k]);
        }
    if (mask >> 3 & 1u) {
        std::swap(ray.origin.x, ray.origin.z);
        std::swap(ray.direction.x, ray.direction.z);
        std::swap(box.min.x, box.min.z);
        std::swap(box.max.x, box.max.z);
    }
}

/// c = o + m d with c and o both floats: c a multiple of 2^23, o what is left of it.
class CornerTies {
  public:
    float m = 0; ///< the t of the touch
    Corner next() {
        for (;;) {
            const std::int64_t dx = draw(1 << 23, (1 << 24) - 1), dy = draw(1 << 22, (1 << 24) - 1);
            const std::int64_t cx = draw(1 << 23, (1 << 24) - 1) << 23, steps = cx / dx;
            const std::int64_t cy = (steps * dy) >> 23 << 23;
            const auto f = [](std::int64_t i) { return static_cast<float>(i); };
            const Corner c{f(cx), f(cx - steps * dx), f(dx), f(cy), f(cy - steps * dy), f(dy)};
            m = f(steps);
            if (cy > 0 && c.is_tie())
                return c;
        }
    }

  private:
    std::int64_t draw(std::int64_t min_value, std::int64_t max_value) {
        return std::uniform_int_distribution<std::int64_t>(min_value, max_value)(random_);
    }
    std::mt19937_64 random_{4};
};

TEST(RayBox, TwoUlpOfPaddingAreRefuted) {
    const Corner witness{0x1.cd3ce8p+46f, -0x1.b83e5p+22f,  0x1.8c6eb8p+23f,
                         0x1.39460cp+46f, -0x1.df1e88p+21f, 0x1.0d41f6p+23f};
    ASSERT_TRUE(witness.is_tie());
    EXPECT_FALSE(witness.survives_padding(2));
    EXPECT_TRUE(truth(witness.ray(), witness.box()));
    EXPECT_TRUE(oracle::ray_box(witness.ray(), witness.box()));
    EXPECT_TRUE(meets(witness.ray(), witness.box()));
}

TEST(RayBox, NoCornerTouchIsLost) {
    CornerTies ties;
    int lost_unpadded = 0, lost_by_one_ulp = 0, lost_by_a_step = 0;
    for (unsigned i = 0; i < 100000; ++i) {
        const Corner c = ties.next();
        lost_unpadded += !meets_plain(c.ray(), c.box());
        lost_by_one_ulp += !c.survives_padding(1);
        Ray3 ray = c.ray();
        Box box = c.box();
        mirror(ray, box, i % 16);
        ASSERT_TRUE(meets(ray, box)) << std::hexfloat << c.cx << ' ' << c.ox << ' ' << c.dx;
        // The touch as the only point of the span, and the span ending or starting just short of
        // it.
        const RaySlabs slabs(ray);
        ASSERT_TRUE(clip(slabs, box, ties.m, ties.m).hit());
        ASSERT_FALSE(clip(slabs, box, 0, ties.m * (1 - 8 * FLT_EPSILON)).hit());
        ASSERT_FALSE(clip(slabs, box, ties.m * (1 + 8 * FLT_EPSILON), inf_f).hit());
        // The padding is a few ulp: a corner moved by 16 of them is missed.
        box = c.box();
        box.min.x *= 1 + 16 * FLT_EPSILON;
        lost_by_a_step += !meets(c.ray(), box);
    }
    EXPECT_GT(lost_unpadded, 10000);
    EXPECT_GT(lost_by_one_ulp, 100);
    EXPECT_EQ(lost_by_a_step, 100000);
}

TEST(RayBox, NoHitIsLostAtAnyScale) {
    // Powers of two keep the truth: geometry from denormals to overflow of 2c, directions from
    // denormals (1 / d overflows) to the largest (1 / d is denormal).
    CornerTies ties;
    for (unsigned i = 0; i < 20000; ++i) {
        const Corner c = ties.next();
        for (const int geometry : {-149, -140, -100, 0, 60, 80})
            for (const int direction : {-149, -146, -140, -100, 0, 60, 103, 104}) {
                const auto g = [&](float x) { return std::ldexp(x, geometry); };
                const auto d = [&](float x) { return std::ldexp(x, direction); };
                const Corner s{g(c.cx), g(c.ox), d(c.dx), g(c.cy), g(c.oy), d(c.dy)};
                Ray3 ray = s.ray();
                Box box = s.box();
                mirror(ray, box, i % 16);
                ASSERT_TRUE(meets(ray, box)) << i << ' ' << geometry << ' ' << direction;
            }
    }
}

TEST(RayBox, NoHitIsLostWhereDistancesOverflow) {
    const Box far{{FLT_MAX / 2, -1, -1}, {FLT_MAX, 1, 1}};
    for (unsigned mask = 0; mask < 16; ++mask) {
        Ray3 ray{{-FLT_MAX, 0, 0}, {FLT_MAX / 4, 0, 0}};
        Box box = far;
        mirror(ray, box, mask);
        ray.t_max = 6; // the touch
        EXPECT_TRUE(meets(ray, box)) << mask;
    }
}

TEST(RayBox, LosesNothingThatTheOracleFinds) {
    // Boxes with faces through a point of the ray's span, or an ulp from it, at all scales.
    std::mt19937_64 random(6);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto draw = [&](int spread) {
        const int e = static_cast<int>(random() % static_cast<unsigned>(2 * spread + 1)) - spread;
        return std::ldexp(unit(random), e);
    };
    int hits = 0, misses = 0, false_hits = 0, plain_lost = 0;
    for (int i = 0; i < 60000; ++i) {
        const int spread = i % 3 == 0 ? 0 : i % 3 == 1 ? 20 : 60;
        Ray3 ray;
        Box box;
        const float t = std::abs(draw(spread));
        for (int k = 0; k < 3; ++k) {
            ray.origin[k] = draw(spread);
            ray.direction[k] = random() % 8 == 0 ? 0.0f : draw(spread);
            const float p = ray.origin[k] + t * ray.direction[k];
            float at = random() % 4 == 0 ? std::nextafter(p, inf_f * unit(random)) : p;
            const float other = at + draw(spread);
            box.min[k] = std::min(at, other);
            box.max[k] = std::max(at, other);
        }
        ray.t_min = random() % 4 == 0 ? t : 0;
        ray.t_max = random() % 4 == 0 ? t : inf_f;
        const bool hit = oracle::ray_box(ray, box), got = meets(ray, box);
        ASSERT_GE(got, hit) << i;
        hits += hit;
        misses += !hit;
        false_hits += got && !hit;
        plain_lost += hit && !meets_plain(ray, box);
    }
    EXPECT_GT(hits, 5000);
    EXPECT_GT(misses, 20000);
    EXPECT_GT(false_hits, 0);
    EXPECT_GT(plain_lost, 0);
}

TEST(RayBox, EntryAndExitLeanOutward) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<float> place(-3, 3);
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const auto point = [&] { return Vec3<float>{place(random), place(random), place(random)}; };
        const Ray3 ray{point(), point()};
        Box box;
        box.extend(point());
        box.extend(point());
        const RaySpan span = clip(RaySlabs(ray), box, ray.t_min, ray.t_max);
        // long double: 64 bits, a relative error of 2^-62 against the 2^-24 at stake
        long double entry = 0, exit = std::numeric_limits<long double>::infinity();
        for (int k = 0; k < 3; ++k) {
            using Long = long double;
            const Long o = static_cast<Long>(ray.origin[k]),
                       d = static_cast<Long>(ray.direction[k]);
            const Long s = (static_cast<Long>(box.min[k]) - o) / d,
                       t = (static_cast<Long>(box.max[k]) - o) / d;
            entry = std::max(entry, std::min(s, t));
            exit = std::min(exit, std::max(s, t));
        }
        if (entry > exit) {
            ASSERT_GE(entry, exit);
            continue;
        }
        ++hits;
        ASSERT_TRUE(span.hit());
        ASSERT_LE(span.entry, static_cast<float>(entry));
        ASSERT_GE(span.exit, static_cast<float>(exit));
        ASSERT_GE(span.entry, entry * (1 - 0x1p-20L));
        ASSERT_LE(span.exit, exit * (1 + 0x1p-20L));
    }
    EXPECT_GT(hits, 1000);
}

TEST(RayBox, OddBoxes) {
    const Ray3 along_x{{-1, 0, 0}, {1, 0, 0}};
    for (unsigned mask = 0; mask < 16; ++mask) {
        Ray3 ray = along_x;
        Box empty, point{{2, 0, 0}, {2, 0, 0}}, beside{{0, FLT_MIN, -1}, {1, 1, 1}};
        mirror(ray, point, mask);
        EXPECT_TRUE(meets(ray, point)) << mask;
        ray = along_x;
        mirror(ray, beside, mask);
        EXPECT_FALSE(meets(ray, beside)) << mask;
        EXPECT_FALSE(meets(ray, empty)) << mask;
        ray.origin = {0x1p110f, -FLT_MAX, 0};
        EXPECT_FALSE(meets(ray, empty)) << mask;
        Box everything{{-inf_f, -inf_f, -inf_f}, {inf_f, inf_f, inf_f}};
        EXPECT_TRUE(meets(ray, everything)) << mask;
    }
}

} // namespace
} // namespace boxwood
