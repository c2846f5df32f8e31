#include "bench/truth/judging/moved_corners.h"

#include "bench/tasks/task.h"
#include "bench/truth/judging/case_truths.h"
#include "kernels/ray_triangle/watertight.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::bench {
namespace {

const Triangle<float> wall{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};

Ray<float> towards(float x, float y) { return {{x, y, 0}, {0, 0, 1}}; }

TEST(MovedCorners, HoldAHitToItsPlace) {
    const MovedCorners moved(towards(.25f, .5f), wall);
    EXPECT_TRUE(moved.allow_a_hit());
    EXPECT_NEAR(moved.surely_hit_by().value(), 2, 1e-5);
    EXPECT_TRUE(moved.allow({2, .25f, .5f, 0}));
    EXPECT_TRUE(moved.allow({std::nextafter(2.f, 3.f), .25f, .5f, 0}));
    for (const RayHit& wrong :
         {RayHit{6, .25f, .5f, 0}, RayHit{2.001f, .25f, .5f, 0}, RayHit{1.999f, .25f, .5f, 0},
          RayHit{2, .5f, .5f, 0}, RayHit{2, .25f, .25f, 0}, RayHit{2, std::nanf(""), .5f, 0},
          RayHit{std::nanf(""), .25f, .5f, 0}})
        EXPECT_FALSE(moved.allow(wrong)) << wrong.t << " " << wrong.u << " " << wrong.v;
}

TEST(MovedCorners, NoHitOfAnotherPlaceOrBeyondTheLimits) {
    const MovedCorners aside(towards(-.25f, .5f), wall);
    EXPECT_FALSE(aside.allow_a_hit());
    EXPECT_FALSE(aside.surely_hit_by());
    EXPECT_FALSE(aside.allow({2, -.25f, .5f, 0})); // u < 0
    EXPECT_FALSE(aside.allow({2, 0, .5f, 0}));
    const MovedCorners on_edge(towards(0, .5f), wall);
    EXPECT_TRUE(on_edge.allow_a_hit());
    EXPECT_FALSE(on_edge.surely_hit_by());
    EXPECT_TRUE(on_edge.allow({2, 0, .5f, 0}));
    Ray<float> ray = towards(.25f, .5f);
    ray.t_max = 1.9f;
    EXPECT_FALSE(MovedCorners(ray, wall).allow_a_hit());
    EXPECT_FALSE(MovedCorners(ray, wall).surely_hit_by());
    EXPECT_FALSE(MovedCorners(ray, wall).allow({2, .25f, .5f, 0}));
    ray = towards(.25f, .5f);
    ray.t_min = 2.1f;
    EXPECT_FALSE(MovedCorners(ray, wall).allow_a_hit());
    EXPECT_FALSE(MovedCorners(ray, wall).surely_hit_by());
}

/// What the kernel says, faults aside, and each of some faults of it.
TEST(NeverLeaks, IsHeldToItsErrorOnSingleTriangles) {
    ContenderEntry contender;
    contender.name = "made_up";
    contender.precision = "f32";
    contender.promise = Promise::never_leaks;
    const auto breaks = [&](std::string_view family, const auto& change) {
        const Scene scene = make_scene({.generator = std::string(family), .n = 300});
        const auto& cases = std::get<RayCases>(scene.cases);
        AnswerList<RayHit> answers;
        for (const RayCase& c : cases.rays) {
            RayHit& best = answers.list.emplace_back();
            const auto per_ray = Watertight::prepare(c.ray);
            for (std::uint32_t k = c.first; k < c.first + c.count; ++k)
                if (RayHit hit; Watertight::intersect(per_ray, c.ray, cases.triangles[k],
                                                      std::min(best.t, c.ray.t_max), hit)) {
                    best = hit;
                    best.triangle = k;
                }
            change(c, best);
        }
        const Judgement judgement =
            find_task("ray_triangle")->make_truth(scene, 1)->judge(answers, contender);
        results::KernelRow row = judgement.kernel.value();
        row.status = judgement.status;
        return breaks_promise(row);
    };
    for (const char* family :
         {"generic_rays", "ray_grazing", "ray_limits", "ray_in_mesh", "ray_at_small_triangle"}) {
        SCOPED_TRACE(family);
        EXPECT_FALSE(breaks(family, [](const RayCase&, RayHit&) {}));
        EXPECT_TRUE(breaks(family, [](const RayCase&, RayHit& hit) { hit = {}; }));
        EXPECT_TRUE(breaks(family, [](const RayCase&, RayHit& hit) { hit.t *= 3; }));
        EXPECT_TRUE(breaks(family, [](const RayCase&, RayHit& hit) { hit.u = hit.v; }));
        EXPECT_TRUE(breaks(family, [](const RayCase&, RayHit& hit) { ++hit.triangle; }));
    }
    for (const char* family : {"generic_rays", "ray_grazing", "ray_limits"})
        EXPECT_TRUE(breaks(family, [](const RayCase& c, RayHit& hit) {
            if (!hit.hit())
                hit = {1, .25f, .25f, c.first};
        })) << family;
}

} // namespace
} // namespace boxwood::bench
