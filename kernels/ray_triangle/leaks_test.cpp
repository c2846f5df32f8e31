#include "kernels/ray_box/fused_slabs.h"
#include "kernels/registry.h"
#include "kernels/testing/closed_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <random>

namespace boxwood {
namespace {

using Point = Vec3<float>;

/// As trees do it: each triangle behind its box, by both tests, with the margin for all of them or
/// without.
template <RayKernel K>
bool hits_any(const Ray<float>& ray, const std::vector<Triangle<float>>& mesh,
              bool with_margin = true) {
    Aabb<float> bounds;
    for (const Triangle<float>& t : mesh)
        bounds.extend(t.bounds());
    const auto per_ray = K::prepare(ray);
    const RaySlabs slabs = with_margin ? RaySlabs(ray, bounds) : RaySlabs(ray);
    const FusedSlabs fused(ray, SlabBounds(bounds));
    RayHit hit;
    return std::any_of(mesh.begin(), mesh.end(), [&](const Triangle<float>& t) {
        return clip(slabs, t.bounds(), ray.t_min, ray.t_max).hit() &&
               clip(fused, t.bounds(), ray.t_min, ray.t_max).hit() &&
               K::intersect(per_ray, ray, t, ray.t_max, hit);
    });
}

template <class K>
constexpr bool never_leaks =
    K::info.promise == Promise::never_leaks || K::info.promise == Promise::exact;
static_assert(never_leaks<Watertight> && never_leaks<ExactRayTriangle>);

template <class K> class Leaks : public ::testing::Test {
  protected:
    void shoot(const Ray<float>& ray, const std::vector<Triangle<float>>& mesh) {
        ++rays_;
        leaks_ += !hits_any<K>(ray, mesh);
    }
    /// Prints and checks what leaked since the last report.
    void report(std::string_view what) {
        std::cout << K::name << ", " << what << ": " << leaks_ << " of " << rays_ << " leak, "
                  << 1e6 * static_cast<double>(leaks_) / static_cast<double>(rays_)
                  << " per million\n";
        if (never_leaks<K>) {
            EXPECT_EQ(leaks_, 0) << what;
        }
        all_leaks_ += leaks_;
        rays_ = leaks_ = 0;
    }
    /// The float kernels must be seen to leak, or nothing was tested.
    void expect_that_floats_leak() const {
        if (!never_leaks<K> && K::name != MollerTrumbore<double>::name) {
            EXPECT_GT(all_leaks_, 0);
        }
    }

  private:
    std::int64_t rays_ = 0, leaks_ = 0, all_leaks_ = 0;
};

template <class Kernels> struct TypesOf;
template <class... K> struct TypesOf<std::tuple<K...>> { using Types = ::testing::Types<K...>; };
struct KernelName {
    template <class K> static std::string GetName(int) { return std::string(K::name); }
};
TYPED_TEST_SUITE(Leaks, TypesOf<RayKernels>::Types, KernelName);

TYPED_TEST(Leaks, AtVerticesAndEdgesOfASphere) {
    const TriangleMesh mesh = uv_sphere(24, 12);
    const std::vector<Triangle<float>> triangles = triangles_of(mesh);
    std::mt19937 random(8);
    std::uniform_real_distribution<float> place(-.5f, .5f);
    for (int round = 0; round < 4; ++round) {
        const Point o = round == 0 ? Point{} : Point{place(random), place(random), place(random)};
        for (const Point& vertex : mesh.vertices)
            this->shoot({o, vertex - o}, triangles);
        for (const Triangle<float>& t : triangles)
            for (const float s : {.5f, .25f, .7f})
                this->shoot({o, t.a + s * (t.b - t.a) - o}, triangles);
    }
    this->report("sphere");
}

TYPED_TEST(Leaks, ThroughFans) {
    // The tip, and points of the inner edges close enough to it not to leave the fan by rounding;
    // every other ray a few ulp beside.
    std::mt19937 random(9);
    std::uniform_real_distribution<float> place(-1, 1), along(0, .8f);
    struct Kind {
        const char* name;
        float needle, distance, sideways; ///< width to length; where the origin is
    };
    const std::vector<Kind> kinds{{"fans from 3", 1, 3, .1f},
                                  {"fans from 100", 1, 100, .1f},
                                  {"slanted fans from 100", 1, 100, 100},
                                  {"needles 1:100 from 3", 1e-2f, 3, 1e-3f},
                                  {"needles 1:1000 from 3", 1e-3f, 3, 1e-4f}};
    for (const Kind& kind : kinds) {
        auto beside = [&, i = 0](Point d) mutable {
            const auto about_one = [&] {
                return 1 + static_cast<float>(static_cast<int>(random() % 9) - 4) * 0x1p-23f;
            };
            return ++i % 2 ? d : Point{d.x * about_one(), d.y * about_one(), d.z};
        };
        std::vector<std::pair<Fan, Point>> fans;
        for (int i = 0; i < 10000; ++i) {
            Fan fan = random_fan(random, kind.needle);
            const Point aside{kind.sideways * place(random), .1f * place(random), kind.distance};
            const Point origin = fan.tip + aside;
            fans.emplace_back(std::move(fan), origin);
        }
        for (const auto& [fan, origin] : fans)
            this->shoot({origin, beside(fan.tip - origin)}, fan.triangles);
        this->report(std::string("vertices of ") + kind.name);
        for (const auto& [fan, origin] : fans)
            for (std::size_t k = 0; k < 3; ++k)
                this->shoot(
                    {origin, beside(fan.tip + along(random) * (fan.rim[k] - fan.tip) - origin)},
                    fan.triangles);
        this->report(std::string("edges of ") + kind.name);
    }
    this->expect_that_floats_leak();
}

/// Rays from the middle of a corridor at its long edges, off by what long triangles are sheared by;
/// all walls are farther from the origin than that.
template <class Shoot> void shoot_at_corridors(const Shoot& shoot) {
    std::mt19937 random(14);
    std::uniform_real_distribution<float> place(-.9f, .9f), along(-3, 3);
    for (const float half_length : {1.0f, 10.0f, 100.0f, 1e4f, 1e5f})
        for (int turn = 0; turn < 3; ++turn) {
            const std::vector<Triangle<float>> mesh = triangles_of(corridor(half_length, turn));
            for (int i = 0; i < 10000; ++i) {
                const float off = std::min(3e-7f * half_length, .01f);
                Point o{place(random), place(random), place(random)};
                Point target{(random() % 2 ? 1.0f : -1.0f) + off * place(random),
                             (random() % 2 ? 1.0f : -1.0f) + off * place(random), along(random)};
                target.z = std::clamp(target.z, -half_length, half_length);
                for (int k = 0; k < turn; ++k) {
                    o = {o.y, o.z, o.x};
                    target = {target.y, target.z, target.x};
                }
                shoot(Ray<float>{o, target - o}, mesh);
            }
        }
}

TYPED_TEST(Leaks, AlongCorridors) {
    shoot_at_corridors([&](const Ray<float>& ray, const auto& mesh) { this->shoot(ray, mesh); });
    this->report("corridors");
}

TYPED_TEST(Leaks, WhereTheShearUnderflows) {
    // A sphere stretched so that what is not along the ray is denormal or 0 for the kernel.
    std::mt19937 random(17);
    std::uniform_real_distribution<float> place(-.5f, .5f);
    for (const Point stretch : {Point{1e30f, 1e-30f, 1},
                                {1e-20f, 1e25f, 1e-20f},
                                {1, 1e-38f, 1},
                                {0x1p-140f, 0x1p-119f, 0x1p-140f}}) {
        const float speed = stretch.x < 1e-38f ? 0x1p60f : 1; // no denormal direction
        const auto stretched = [&](Point p) {
            return Point{p.x * stretch.x, p.y * stretch.y, p.z * stretch.z};
        };
        TriangleMesh mesh = uv_sphere(24, 12);
        for (Point& vertex : mesh.vertices)
            vertex = stretched(vertex);
        const std::vector<Triangle<float>> triangles = triangles_of(mesh);
        for (int i = 0; i < 20000; ++i) {
            const Point o = stretched({place(random), place(random), place(random)});
            const Triangle<float>& t = triangles[random() % triangles.size()];
            // At a corner, on an edge, or beside it by as much as denormals are off.
            const Point beside = stretched({place(random), place(random), place(random)});
            const Point target = i % 3 == 0   ? t.a
                                 : i % 3 == 1 ? t.a + place(random) * (t.b - t.a)
                                              : .5f * (t.a + t.b) + 0x1p-9f * beside;
            this->shoot({o, speed * (target - o)}, triangles);
        }
    }
    this->report("stretched spheres");
}

TEST(Leaks, WithoutTheMarginWatertightLosesItsHitsToTheBoxes) {
    int leaks = 0, leaks_of_the_exact = 0;
    shoot_at_corridors([&](const Ray<float>& ray, const auto& mesh) {
        leaks += !hits_any<Watertight>(ray, mesh, false);
        leaks_of_the_exact += !hits_any<ExactRayTriangle>(ray, mesh, false);
    });
    EXPECT_GT(leaks, 100);
    EXPECT_EQ(leaks_of_the_exact, 0);
}

/// How often the box of a triangle is lost that is hit: rays at an edge of the triangle that is one
/// of the box, by rounding beside it. Every other triangle reaches far behind and beyond.
template <class K> int lost_to_boxes(bool with_margin, int& n_hits) {
    std::mt19937 random(13);
    std::uniform_real_distribution<float> place(-1, 1), along(0, 1);
    int lost = 0;
    n_hits = 0;
    for (int i = 0; i < 200000; ++i) {
        const float half_length = i % 2 ? 1 : std::ldexp(1.0f, static_cast<int>(random() % 16));
        const Point foot{place(random), place(random), 0};
        const Triangle<float> t{foot - Point{0, 0, half_length}, foot + Point{0, 0, half_length},
                                foot + Point{place(random), place(random), along(random)}};
        const float off = std::min(1e-6f * half_length, 1e-2f);
        const Point origin{place(random), place(random), .5f * place(random)};
        const Point target = foot + Point{off * place(random), off * place(random), along(random)};
        const Ray<float> ray{origin, target - origin};
        RayHit hit;
        if (!K::intersect(K::prepare(ray), ray, t, ray.t_max, hit))
            continue;
        ++n_hits;
        const RaySlabs slabs = with_margin ? RaySlabs(ray, t.bounds()) : RaySlabs(ray);
        // As the best hit so far, which another triangle in the box may equal.
        lost += !clip(slabs, t.bounds(), hit.t, hit.t).hit();
    }
    return lost;
}

TYPED_TEST(Leaks, WhatIsHitTheBoxDoesNotLose) {
    int n_hits;
    const int lost_without = lost_to_boxes<TypeParam>(false, n_hits);
    const int lost = lost_to_boxes<TypeParam>(true, n_hits);
    std::cout << TypeParam::name << ": boxes lose " << lost << " hits, without margin "
              << lost_without << ", of " << n_hits << '\n';
    EXPECT_GT(n_hits, 20000);
    if (never_leaks<TypeParam> || TypeParam::name == MollerTrumbore<double>::name) {
        EXPECT_EQ(lost, 0);
    }
    if (TypeParam::name == Watertight::name) {
        EXPECT_GT(lost_without, 100);
    }
}

} // namespace
} // namespace boxwood
