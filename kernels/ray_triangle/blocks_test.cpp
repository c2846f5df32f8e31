#include "kernels/ray_triangle/blocks.h"

#include "kernels/registry.h"
#include "kernels/testing/every_target.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace boxwood {
namespace {

using Point = Vec3<float>;

/// Triangles that a ray meets, misses narrowly, or whose vertex or edge it meets, small integers
/// among them, and at times NaN or infinity.
template <std::size_t lanes> struct Input {
    std::vector<Ray<float>> rays;
    std::vector<TriangleBlock<lanes>> blocks;

    explicit Input(std::size_t n) : rays(n), blocks(n) {
        std::mt19937 random(12);
        std::uniform_real_distribution<float> place(-1, 1);
        for (std::size_t i = 0; i < n; ++i) {
            const auto point = [&] {
                const Point p{place(random), place(random), place(random)};
                return i % 4 != 0
                           ? p
                           : Point{std::round(2 * p.x), std::round(2 * p.y), std::round(2 * p.z)};
            };
            rays[i] = {point(), point()};
            if (i % 5 == 0)
                rays[i].t_max = .5f + std::abs(place(random));
            if (i % 7 == 0)
                rays[i].t_min = .25f;
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                const Point at = rays[i].origin + (1 + .8f * place(random)) * rays[i].direction;
                Triangle<float> t{at + point(), at + point(), at + point()};
                const auto kind = random() % 6;
                if (kind == 0)
                    t.c = at;
                if (kind == 1)
                    t.c = at + (at - t.b);
                if (random() % 200 == 0)
                    t.b.y = std::numeric_limits<float>::quiet_NaN();
                if (random() % 200 == 0)
                    t.a.z = std::numeric_limits<float>::infinity();
                blocks[i].set(lane, t, static_cast<std::uint32_t>(random() % 16));
            }
        }
    }
};

template <RayKernel K, std::size_t lanes>
RayHit one_by_one(const Ray<float>& ray, const TriangleBlock<lanes>& block) {
    RayHit best;
    const auto per_ray = K::prepare(ray);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        RayHit hit;
        if (!K::intersect(per_ray, ray, block.triangle(lane), ray.t_max, hit))
            continue;
        hit.triangle = block.id[lane];
        if (!best.hit() || hit.t < best.t || (hit.t == best.t && hit.triangle < best.triangle))
            best = hit;
    }
    return best;
}

template <std::size_t lanes> void compare() {
    const Input<lanes> input(6000);
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    on_every_target([&] {
        for (const KernelInfo& info : ray_kernels())
            with_kernel<RayKernels>(info.name, [&]<RayKernel K>(std::type_identity<K>) {
                std::vector<RayHit> hits(input.rays.size());
                ASSERT_TRUE(nearest_in_blocks(K::name, input.rays, std::span(input.blocks), hits));
                int n_hits = 0;
                for (std::size_t i = 0; i < hits.size(); ++i) {
                    const RayHit expected = one_by_one<K>(input.rays[i], input.blocks[i]);
                    const bool same = hits[i].triangle == expected.triangle &&
                                      bits(hits[i].t) == bits(expected.t) &&
                                      bits(hits[i].u) == bits(expected.u) &&
                                      bits(hits[i].v) == bits(expected.v);
                    ASSERT_TRUE(same) << K::name << ' ' << i;
                    n_hits += hits[i].hit();
                }
                EXPECT_GT(n_hits, 2000) << K::name;
                EXPECT_LT(n_hits, 5900) << K::name;
            });
    });
}

TEST(RayBlocks, OfFourAnswerAsOneByOneOnEveryInstructionSet) { compare<4>(); }
TEST(RayBlocks, OfEightAnswerAsOneByOneOnEveryInstructionSet) { compare<8>(); }

TEST(RayBlocks, RefuseAnUnknownKernel) {
    const std::vector<Ray<float>> rays(1);
    const std::vector<TriangleBlock<4>> blocks(1);
    std::vector<RayHit> hits(1);
    EXPECT_FALSE(nearest_in_blocks("watertigth", rays, std::span(blocks), hits));
}

} // namespace
} // namespace boxwood
