#include "kernels/registry.h"
#include "kernels/testing/every_target.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/testing/brute_force_rays.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/ray_scenes.h"
#include "trees/testing/triangle_soup.h"
#include "trees/traversals/rays/coherent_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace boxwood {
namespace {

using detail::are_coherent, detail::packet_size;

/// Rays from an eye in tiles of 4 x 4, over `slope` to each side of the axis that leads to `at`.
std::vector<Ray<float>> picture(Vec3<float> eye, Vec3<float> at, float slope, int side) {
    const Vec3<float> ahead = (at - eye) * (1 / length(at - eye));
    const Vec3<float> other = std::abs(ahead.y) < .9f ? Vec3<float>{0, 1, 0} : Vec3<float>{1, 0, 0};
    const Vec3<float> across = cross(ahead, other), right = across * (1 / length(across));
    const Vec3<float> up = cross(right, ahead);
    std::vector<Ray<float>> rays;
    for (int tile = 0; tile < side * side / 16; ++tile)
        for (int i = 0; i < 16; ++i) {
            const int x = tile % (side / 4) * 4 + i % 4, y = tile / (side / 4) * 4 + i / 4;
            const auto at_pixel = [&](int k) {
                return (2 * (static_cast<float>(k) + .5f) / static_cast<float>(side) - 1) * slope;
            };
            rays.push_back({eye, ahead + right * at_pixel(x) + up * at_pixel(y)});
        }
    return rays;
}

Box bounds_of(const TriangleMesh& mesh) {
    Box all;
    for (const Box& box : triangle_boxes(mesh))
        all.extend(box);
    return all;
}

std::size_t coherent_packets(std::span<const Ray<float>> rays, const Box& bounds) {
    std::size_t n = 0;
    for (std::size_t i = 0; i + packet_size <= rays.size(); i += packet_size)
        n += are_coherent(rays.subspan(i, packet_size), SlabBounds(bounds));
    return n;
}

TriangleMesh moved(TriangleMesh mesh, float scale, Vec3<float> by) {
    for (Vec3<float>& v : mesh.vertices)
        v = v * scale + by;
    return mesh;
}

/// Closest and any hits of all rays, for every kernel, in every layout of lanes, on every
/// instruction set. Kernels whose hits may lie beside a triangle are held to rays that hit it well
/// inside, which these are.
template <RayKernel K>
void expect_right(const TriangleMesh& mesh, std::span<const Ray<float>> rays) {
    const std::vector<RayHit> expected = brute_force<K>(mesh, rays);
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        SCOPED_TRACE(std::string(K::name) + "." + std::string(entry.name));
        const auto layout =
            entry.make(make_builder("binned_sah")(triangle_boxes(mesh), serial()), serial());
        const TriangleBlocks triangles = layout->triangles(mesh);
        on_every_target([&] {
            std::vector<RayHit> hits(rays.size()), any(rays.size());
            layout->rays(rays, RayQuery::closest, K::name, triangles, serial(), hits);
            layout->rays(rays, RayQuery::any, K::name, triangles, serial(), any);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(hits[i], expected[i]) << i;
                ASSERT_EQ(any[i].hit(), expected[i].hit()) << i;
            }
        });
    }
}

TEST(RayPackets, OfPicturesAgreeWithBruteForceForEveryKernel) {
    const TriangleMesh mesh = sphere(16);
    // From outside, along an axis, so that directions have both signs, and from inside.
    for (const Vec3<float> eye :
         {Vec3<float>{1.6f, 2, 2.6f}, Vec3<float>{0, 0, -3}, Vec3<float>{.1f, .2f, .15f}}) {
        const std::vector<Ray<float>> rays = picture(eye, {.01f, .02f, 0}, .15f, 32);
        ASSERT_EQ(coherent_packets(rays, bounds_of(mesh)), rays.size() / packet_size);
        for (const KernelInfo& info : ray_kernels())
            with_kernel<RayKernels>(info.name, [&]<RayKernel K>(std::type_identity<K>) {
                expect_right<K>(mesh, rays);
            });
    }
}

TEST(RayPackets, OfEveryScaleAndPlaceAgreeWithBruteForce) {
    const TriangleMesh mesh = triangle_soup(600);
    const std::vector<Ray<float>> rays = picture({2, 2.5f, 3}, {.5f, .5f, .5f}, .1f, 16);
    for (const float scale : {0x1p-70f, 1.f, 0x1p70f})
        for (const Vec3<float> by : {Vec3<float>{}, Vec3<float>{300, -5000, 40000} * scale}) {
            const TriangleMesh other = moved(mesh, scale, by);
            std::vector<Ray<float>> rays_there = rays;
            for (Ray<float>& ray : rays_there)
                ray = {ray.origin * scale + by, ray.direction};
            ASSERT_EQ(coherent_packets(rays_there, bounds_of(other)), rays.size() / packet_size);
            expect_right<Watertight>(other, rays_there);
        }
}

TEST(RayPackets, OfParallelRaysAndOfRaysWithEndsAgreeWithBruteForce) {
    const TriangleMesh mesh = sphere(16);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> part(0, 1);
    std::vector<Ray<float>> rays;
    // Along an axis, zeros of both signs, through vertices too; origins within a 32nd of the size.
    for (int i = 0; i < 512; ++i) {
        const float tile = static_cast<float>(i / 16) / 16 - 1;
        Ray<float> ray{{tile + .03f * part(random), tile / 2 + .03f * part(random), -2},
                       {i & 1 ? 0.f : -0.f, i & 2 ? 0.f : -0.f, 1}};
        if (i % 64 == 0)
            ray.origin = {tile, tile / 2, -2};
        ray.t_min = i % 5 == 0 ? 1.5f : 0;
        ray.t_max = i % 3 == 0 ? 1 + 2 * part(random) : i % 7 == 0 ? 0 : ray.t_max;
        rays.push_back(ray);
    }
    ASSERT_EQ(coherent_packets(rays, bounds_of(mesh)), rays.size() / packet_size);
    expect_right<Watertight>(mesh, rays);
    expect_right<ExactRayTriangle>(mesh, rays);
}

/// A packet in between is not coherent, the last one not full.
TEST(RayPackets, AmongOtherRaysAgreeWithBruteForce) {
    const TriangleMesh mesh = sphere(16);
    std::vector<Ray<float>> rays = picture({1.6f, 2, 2.6f}, {}, .2f, 32);
    const std::vector<Ray<float>> others = test_rays();
    std::copy(others.begin(), others.begin() + 40, rays.begin() + 40);
    rays[5].direction.y = std::numeric_limits<float>::quiet_NaN();
    rays[100].origin.x = std::numeric_limits<float>::infinity();
    rays.resize(rays.size() - 3);
    const std::size_t packets = coherent_packets(rays, bounds_of(mesh));
    EXPECT_GT(packets, 50u);
    EXPECT_LT(packets, rays.size() / packet_size - 4);
    expect_right<Watertight>(mesh, rays);
}

TEST(RayPackets, ARayWithAnEndThatIsNoNumberMissesAlone) {
    const std::vector<Ray<float>> tile = picture({1.6f, 2, 2.6f}, {}, .02f, 4);
    std::vector<Ray<float>> rays;
    for (std::size_t place = 0; place < packet_size; ++place)
        for (const auto end : {&Ray<float>::t_min, &Ray<float>::t_max}) {
            rays.insert(rays.end(), tile.begin(), tile.end());
            rays[rays.size() - packet_size + place].*end = std::numeric_limits<float>::quiet_NaN();
        }
    expect_right<Watertight>(sphere(16), rays);
}

TEST(RayPackets, AreCoherentWhereRaysBeginAndGoAlike) {
    const Box unit{{-1, -1, -1}, {1, 1, 1}};
    const SlabBounds bounds(unit);
    std::vector<Ray<float>> rays(packet_size, Ray<float>{{0, 0, 3}, {0, 0, -1}});
    EXPECT_TRUE(are_coherent(rays, bounds));
    rays[7].direction.x = .06f;
    rays[9].origin.y = .06f;
    EXPECT_TRUE(are_coherent(rays, bounds));
    rays[9].origin.y = .07f;
    EXPECT_FALSE(are_coherent(rays, bounds));
    rays[9].origin.y = 0;
    rays[15].direction.z = 1;
    EXPECT_FALSE(are_coherent(rays, bounds));
    for (const float bad :
         {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
        for (const std::size_t r : {std::size_t{0}, std::size_t{15}}) {
            rays.assign(packet_size, {{0, 0, 3}, {0, 0, -1}});
            rays[r].direction.x = bad;
            EXPECT_FALSE(are_coherent(rays, bounds));
            rays.assign(packet_size, {{0, 0, 3}, {0, 0, -1}});
            rays[r].origin.x = bad;
            EXPECT_FALSE(are_coherent(rays, bounds));
        }
}

/// In floats, fused or not, whatever the lines: none is passed.
TEST(RayPackets, BoundingLinesAreBounds) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> exponent(-40, 40), part(-1, 1);
    std::size_t tight = 0, n = 0;
    for (int i = 0; i < 20'000; ++i) {
        const float scale = std::exp2(exponent(random)), place = i % 3 ? 0 : part(random) * 1e4f;
        float low = (place + part(random)) * scale, high = (place + part(random)) * scale;
        if (low > high)
            std::swap(low, high);
        if (i % 17 == 0)
            high = low;
        const float sign = i & 1 ? 1 : -1, rate = std::exp2(exponent(random));
        std::vector<float> r, s;
        for (std::size_t k = 0; k < packet_size; ++k) {
            r.push_back(sign * rate * (1 + part(random) / 8));
            s.push_back(r.back() * (low + scale * part(random)));
        }
        const float infinity = std::numeric_limits<float>::infinity();
        const float widest = std::max(std::abs(low), std::abs(high));
        detail::LineEnds least{low, high, infinity, infinity, 0, r[0]}, greatest = least;
        greatest.at_low = greatest.at_high = -infinity;
        for (std::size_t k = 0; k < packet_size; ++k) {
            least.size = std::max(least.size, std::abs(r[k]) * widest + std::abs(s[k]));
            for (const bool fused : {false, true}) {
                const auto at = [&](float p) {
                    return fused ? std::fma(p, r[k], -s[k]) : p * r[k] - s[k];
                };
                if (fused != (i % 2 == 0))
                    continue;
                least.at_low = std::min(least.at_low, at(low));
                least.at_high = std::min(least.at_high, at(high));
                greatest.at_low = std::max(greatest.at_low, at(low));
                greatest.at_high = std::max(greatest.at_high, at(high));
            }
        }
        greatest.size = least.size;
        const detail::BoundingLine below = line_below(least), above = line_above(greatest);
        ASSERT_EQ(std::signbit(below.rdir), std::signbit(r[0]));
        ASSERT_NE(below.rdir, 0);
        ASSERT_EQ(std::signbit(above.rdir), std::signbit(r[0]));
        for (int at = 0; at <= 8; ++at) {
            const float p = std::clamp(low + (high - low) * static_cast<float>(at) / 8, low, high);
            float lines_least = infinity, lines_greatest = -infinity;
            for (std::size_t k = 0; k < packet_size; ++k)
                for (const float value : {p * r[k] - s[k], std::fma(p, r[k], -s[k])}) {
                    lines_least = std::min(lines_least, value);
                    lines_greatest = std::max(lines_greatest, value);
                }
            for (const float value :
                 {p * below.rdir - below.shift, std::fma(p, below.rdir, -below.shift)}) {
                ASSERT_LE(value, lines_least) << i;
                tight += value > lines_least - least.size / 2;
            }
            for (const float value :
                 {p * above.rdir - above.shift, std::fma(p, above.rdir, -above.shift)})
                ASSERT_GE(value, lines_greatest) << i;
            n += 2;
        }
    }
    EXPECT_GT(tight, n / 2);
}

} // namespace
} // namespace boxwood
