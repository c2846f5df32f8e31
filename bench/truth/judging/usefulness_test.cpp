/// Answers that are not false and yet no use: witnesses that lie anywhere, never a decision, the
/// neighbours of the interval that holds a root.

#include "bench/tasks/task.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/hits_alone.h"
#include "kernels/triangle_distance/distance_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace boxwood::bench {
namespace {

template <class Answer>
bool keeps_promise(const Scene& scene, std::string_view task, std::vector<Answer> said,
                   Promise promise, ContenderEntry contender = {}) {
    contender.name = "made_up";
    contender.precision = "f64";
    contender.promise = promise;
    AnswerList<Answer> answers;
    answers.list = std::move(said);
    const Judgement judgement = find_task(task)->make_truth(scene, 1)->judge(answers, contender);
    results::KernelRow row = judgement.kernel.value();
    row.status = judgement.status;
    return !breaks_promise(row);
}

TEST(Witnesses, LieOnTheTrianglesThatFarApart) {
    const Triangle<double> low{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
        high{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    Scene apart, touching;
    apart.cases = std::vector<TrianglePairCase>{{low, high}};
    touching.cases = std::vector<TrianglePairCase>{{low, low}};
    const auto is_kept = [](const Scene& scene, double d, Vec3<double> a, Vec3<double> b) {
        return keeps_promise<Distance>(scene, "triangle_distance", {{d, d, d, a, b}},
                                       Promise::certified);
    };
    EXPECT_TRUE(is_kept(apart, 1, {.25, .25, 0}, {.25, .25, 1}));
    EXPECT_TRUE(is_kept(apart, 1, {.25, .25, 0x1p-46}, {.25, .25, 1}));
    EXPECT_FALSE(is_kept(apart, 1, {.25, .25, 0x1p-43}, {.25, .25, 1}));
    EXPECT_FALSE(is_kept(apart, 1, {1e9, .25, 0}, {1e9, .25, 1}));
    EXPECT_FALSE(is_kept(apart, 1, {.75, .75, 0}, {.75, .75, 1}));
    EXPECT_FALSE(is_kept(apart, 1, {.25, .25, 0}, {.5, .25, 1})); // too far apart
    EXPECT_FALSE(is_kept(apart, 1, {.25, .25, 0}, {.25, .25, 0}));
    EXPECT_FALSE(is_kept(apart, 1, {.25, .25, 0}, {.25, .25, std::nan("")}));
    EXPECT_TRUE(is_kept(touching, 0, {.25, .25, 0}, {.25, .25, 0}));
    EXPECT_TRUE(is_kept(touching, 0, {.25, .25, 0}, {.25 + 0x1p-23, .25, 0}));
    EXPECT_FALSE(is_kept(touching, 0, {.25, .25, 0}, {.25 + 0x1p-21, .25, 0}));
}

template <class Answer>
bool is_useful(std::string_view family, std::string_view task, Answer said, Promise promise) {
    const Scene scene = make_scene({.generator = std::string(family), .n = 100});
    return keeps_promise(scene, task, std::vector<Answer>(100, said), promise);
}

TEST(GenericInput, IsNotLeftUndecided) {
    const double inf = std::numeric_limits<double>::infinity();
    const Impact maybe{Answer::maybe, 0, 1, 0};
    EXPECT_FALSE(is_useful("generic_vertex_face", "vertex_face", maybe, Promise::never_miss));
    EXPECT_FALSE(is_useful("generic_edge_edge", "edge_edge", maybe, Promise::never_miss));
    EXPECT_TRUE(is_useful("tangential_edge_edge", "edge_edge", maybe, Promise::never_miss));
    const Decision undecided{Answer::maybe, 0}, yes{Answer::yes, 0};
    EXPECT_FALSE(is_useful("generic_obbs", "obb_obb", undecided, Promise::certified));
    EXPECT_FALSE(
        is_useful("generic_triangles", "triangle_triangle", undecided, Promise::certified));
    EXPECT_FALSE(is_useful("generic_ray_boxes", "ray_box", yes, Promise::never_miss));
    EXPECT_FALSE(is_useful("sphere_and_box", "shape_collide", undecided, Promise::certified));
    const Distance anything{0, -inf, inf};
    EXPECT_FALSE(is_useful("sphere_and_box", "shape_distance", anything, Promise::certified));
    const Aabb<double> all{{-inf, -inf, -inf}, {inf, inf, inf}};
    EXPECT_FALSE(is_useful("rotated_boxes", "box_fit", all, Promise::never_miss));
}

TEST(GenericInput, TimesOfTouchAreNarrow) {
    const Scene scene = make_scene({.generator = "generic_vertex_face", .n = 100});
    const auto task = find_task("vertex_face");
    const auto contenders = task->contenders_on_cases();
    AnswerList<Impact> right;
    for (const ContenderEntry& contender : contenders)
        if (contender.name == "exact") {
            const auto instance = contender.make({&scene, task, "serial", 1});
            instance->build();
            instance->query(right);
        }
    ASSERT_EQ(right.list.size(), 100u);
    EXPECT_TRUE(keeps_promise(scene, "vertex_face", right.list, Promise::never_miss));
    for (Impact& impact : right.list)
        if (impact.answer == Answer::yes)
            impact.t_free = 0;
    EXPECT_FALSE(keeps_promise(scene, "vertex_face", right.list, Promise::never_miss));
}

TEST(ProvenYes, IsTrue) {
    LinearMotion apart;
    apart.start = apart.end = {{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    MotionCases cases;
    cases.motions = {{apart, Known::no}};
    Scene scene;
    scene.cases = cases;
    ContenderEntry contender;
    const auto is_kept = [&](Answer answer) {
        return keeps_promise<Impact>(scene, "vertex_face", {{answer, 0, 1, 0}}, Promise::never_miss,
                                     contender);
    };
    EXPECT_TRUE(is_kept(Answer::yes));
    contender.yes_is_proven = true;
    EXPECT_FALSE(is_kept(Answer::yes));
    EXPECT_TRUE(is_kept(Answer::maybe));
}

TEST(ClosestHits, AreInATreeThoseWithoutOne) {
    RayCases cases;
    cases.triangles = {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{1, 1, 1}, {1, 0, 1}, {0, 1, 1}}};
    RayCase c;
    c.ray = {{.5f, .5f, 0}, {0, 0, 1}}; // at the edge that they share
    c.count = 2;
    cases.rays = {c};
    Scene scene;
    scene.cases = cases;
    const std::vector<RayHit> alone = hits_alone("watertight", c, cases.triangles);
    ASSERT_EQ(alone.size(), 2u);
    ContenderEntry contender;
    contender.kernel = "watertight";
    const auto is_kept = [&](const RayHit& said, std::string_view task = "rays_closest") {
        return keeps_promise<RayHit>(scene, task, {said}, Promise::never_leaks, contender);
    };
    EXPECT_TRUE(is_kept(alone[1]));
    contender.layout = "wide8";
    EXPECT_TRUE(is_kept(alone[0]));
    EXPECT_FALSE(is_kept(alone[1]));
    EXPECT_TRUE(is_kept(alone[1], "rays_any"));
    RayHit other = alone[0];
    other.u = std::nextafter(other.u, 1.f);
    EXPECT_FALSE(is_kept(other));
}

/// At t = 1/3, which is no double: below it is the one double, above it the next.
TEST(ExactTimes, AreThoseAroundTheRoot) {
    LinearMotion motion;
    motion.start = {{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    motion.end = motion.start;
    motion.end[0].z = -2;
    MotionCases cases;
    cases.motions = {{motion, Known::yes}};
    Scene scene;
    scene.cases = cases;
    const double below = 1. / 3, above = std::nextafter(below, 1);
    const auto is_kept = [&](double t_free, double t_hit) {
        return keeps_promise<Impact>(scene, "vertex_face", {{Answer::yes, t_free, t_hit, 0}},
                                     Promise::exact);
    };
    EXPECT_TRUE(is_kept(below, above));
    EXPECT_FALSE(is_kept(above, above));
    EXPECT_FALSE(is_kept(below, below));
    EXPECT_FALSE(is_kept(above, std::nextafter(above, 1)));
    EXPECT_FALSE(is_kept(std::nextafter(below, 0), below));
}

} // namespace
} // namespace boxwood::bench
