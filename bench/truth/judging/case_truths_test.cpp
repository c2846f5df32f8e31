/// Answers that are right and wrong in known ways, and what they are judged to be worth.

#include "bench/truth/judging/case_truths.h"

#include "bench/testing/judged.h"
#include "bench/truth/judging/distance_truth.h"
#include "bench/truth/judging/tally.h"
#include "kernels/continuous/continuous_kernel.h"
#include "kernels/triangle_distance/distance_kernel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The unit right triangle at height z.
Triangle<double> at(double z) { return {{0, 0, z}, {1, 0, z}, {0, 1, z}}; }

Scene pairs_of_triangles(std::vector<TrianglePairCase> cases) {
    Scene scene;
    scene.name = "made_scale3";
    scene.spec.generator = "made";
    scene.spec.k = 7;
    scene.spec.scale = 3;
    scene.cases = std::move(cases);
    return scene;
}

AnswerList<Decision> verdicts(std::vector<Decision> list) { return answers_of(std::move(list)); }

AnswerList<Distance> distances(const std::vector<std::array<double, 3>>& list) {
    AnswerList<Distance> answers;
    for (const auto& [lo, distance, hi] : list) {
        Distance& d = answers.list.emplace_back();
        d.lo = lo;
        d.distance = distance;
        d.hi = hi;
    }
    return answers;
}

/// Of pairs of triangles at two heights, with right witnesses.
Judgement judged_distances(const Scene& scene, const std::vector<std::array<double, 3>>& said,
                           const ContenderEntry& contender) {
    AnswerList<Distance> answers = distances(said);
    for (std::size_t i = 0; i < said.size(); ++i) {
        const auto& pair = std::get<std::vector<TrianglePairCase>>(scene.cases)[i];
        answers.list[i].point_a = pair.a.a;
        answers.list[i].point_b = pair.b.a;
    }
    return judged(scene, "triangle_distance", answers, contender);
}

TEST(Tally, EveryPromiseAllowsItsOwnErrors) {
    struct Row {
        Promise promise;
        Worth false_yes, false_no, maybe;
    };
    using enum Worth;
    for (const Row& row : {Row{Promise::none, wrong, wrong, conservative},
                           Row{Promise::never_miss, conservative, broken_promise, conservative},
                           Row{Promise::never_false, broken_promise, conservative, conservative},
                           Row{Promise::certified, broken_promise, broken_promise, conservative},
                           Row{Promise::exact, broken_promise, broken_promise, broken_promise}}) {
        SCOPED_TRACE(to_string(row.promise));
        EXPECT_EQ(worth_of(row.promise, Answer::yes, false), row.false_yes);
        EXPECT_EQ(worth_of(row.promise, Answer::no, true), row.false_no);
        EXPECT_EQ(worth_of(row.promise, Answer::maybe, true), row.maybe);
        EXPECT_EQ(worth_of(row.promise, Answer::maybe, false), row.maybe);
        EXPECT_EQ(worth_of(row.promise, Answer::yes, true), exact);
        EXPECT_EQ(worth_of(row.promise, Answer::no, false), exact);
    }
}

TEST(CaseTruth, CountsFalseAnswersAndTiers) {
    // Touching by the oracle; apart, known; apart by the oracle; not finite.
    const Scene scene = pairs_of_triangles({{at(0), at(0), Known::unknown},
                                            {at(0), at(1), Known::no},
                                            {at(0), at(1), Known::unknown},
                                            {at(0), at(nan), Known::unknown}});
    const AnswerList<Decision> answers =
        verdicts({{Answer::no, 0}, {Answer::yes, 2}, {Answer::maybe, 5}, {Answer::yes, 0}});
    const Judgement none = judged(scene, "triangle_triangle", answers, named(Promise::none));
    EXPECT_EQ(none.kernel->n, 3u);
    EXPECT_EQ(none.kernel->false_neg, 1u);
    EXPECT_EQ(none.kernel->false_pos, 1u);
    EXPECT_EQ(none.kernel->maybe, 1u);
    EXPECT_EQ(none.kernel->tier_0, 1u);
    EXPECT_EQ(none.kernel->tier_2, 1u);
    EXPECT_EQ(none.kernel->tier_3, 1u);
    EXPECT_NEAR(none.kernel->escalation_rate, 2. / 3, 1e-15);
    EXPECT_EQ(none.status, Status::wrong);
    EXPECT_FALSE(is_broken(none));
    EXPECT_EQ(none.kernel->family, "typical"); // `made` is in no registry
    EXPECT_EQ(none.kernel->task, "triangle_triangle");
    EXPECT_EQ(none.kernel->kernel, "made_up");

    // never-miss reads maybe as yes: two false yes. Its miss is what the witness shows.
    const Judgement miss = judged(scene, "triangle_triangle", answers, named(Promise::never_miss));
    EXPECT_EQ(miss.kernel->false_pos, 2u);
    EXPECT_TRUE(is_broken(miss));
    EXPECT_THAT(miss.kernel->witness, HasSubstr("case 0: said no, truth yes; 0,0,0,1,0,0,0,1,0,"));
    EXPECT_THAT(miss.kernel->witness,
                HasSubstr("boxwood check --only '^made/triangle_triangle/made_up$' --k 7 --scale 3 "
                          "--n 1000 --seed 1 --case 0"));

    const Judgement sure = judged(
        scene, "triangle_triangle",
        verdicts({{Answer::yes, 0}, {Answer::no, 0}, {Answer::maybe, 0}, {Answer::maybe, 0}}),
        named(Promise::certified));
    EXPECT_EQ(sure.status, Status::conservative);
    EXPECT_EQ(sure.kernel->witness, "");
    EXPECT_FALSE(is_broken(sure));
}

TEST(CaseTruth, AKernelOfFloatsIsJudgedOnWhatItReads) {
    const double h = 0x1p-60; // a float, but not beside 1
    Triangle<double> tilted{{0, 0, 1}, {1, 0, 1}, {0, 1, 1 + 0x1p-40}};
    const Scene scene =
        pairs_of_triangles({{at(0), at(h), Known::no}, {tilted, at(1 + 0x1p-41), Known::unknown}});
    const AnswerList<Decision> rounded = verdicts({{Answer::no, 0}, {Answer::yes, 0}});
    EXPECT_EQ(judged(scene, "triangle_triangle", rounded, named(Promise::exact, "f32")).status,
              Status::exact);
    const Scene apart = pairs_of_triangles({{at(1), at(1 + 0x1p-40), Known::no}});
    const AnswerList<Decision> touch = verdicts({{Answer::yes, 0}});
    EXPECT_FALSE(
        is_broken(judged(apart, "triangle_triangle", touch, named(Promise::exact, "f32"))));
    EXPECT_TRUE(is_broken(judged(apart, "triangle_triangle", touch, named(Promise::exact, "f64"))));
}

TEST(CaseTruth, DistancesWithoutABoundMayRound) {
    const Scene scene = pairs_of_triangles({{at(0), at(2)}, {at(0), at(0)}, {at(0), at(1)}});
    const auto status = [&](double a, double b, double c, const char* precision = "f64") {
        return judged(scene, "triangle_distance", distances({{a, a, a}, {b, b, b}, {c, c, c}}),
                      named(Promise::none, precision));
    };
    EXPECT_EQ(status(2, 0, 1).status, Status::exact);
    EXPECT_EQ(status(2, 0, 1).kernel->max_ulp, 0);
    EXPECT_EQ(status(2 + 0x1p-50, 0x1p-50, 1).status, Status::within_bound);
    EXPECT_EQ(status(2 + 0x1p-50, 0, 1).kernel->max_ulp, 2);
    EXPECT_EQ(status(2 + 0x1p-30, 0, 1).kernel->false_neg, 1u); // too large
    EXPECT_EQ(status(2 - 0x1p-30, 0, 1).kernel->false_pos, 1u); // too small
    EXPECT_EQ(status(2 - 0x1p-30, 0, 1).status, Status::wrong);
    EXPECT_EQ(status(2 - 0x1p-30, 0, 1, "f32").status, Status::within_bound);
    EXPECT_EQ(status(2, 0, nan).kernel->maybe, 1u);
    EXPECT_EQ(status(2, 0, nan).status, Status::conservative);
    EXPECT_NEAR(status(2, 0, 1.25).kernel->max_rel_err, 0.25, 1e-15);
}

TEST(CaseTruth, CertifiedDistancesMustEnclose) {
    const Scene scene = pairs_of_triangles({{at(0), at(2)}, {at(0), at(0)}});
    const auto judge = [&](std::array<double, 3> a, std::array<double, 3> b, Promise promise) {
        return judged_distances(scene, {a, b}, named(promise));
    };
    const std::array<double, 3> zero{0, 0, 0}, wide{1.5, 2.125, 2.25};
    const Judgement held = judge(wide, zero, Promise::certified);
    EXPECT_FALSE(is_broken(held));
    EXPECT_EQ(held.status, Status::within_bound);
    ASSERT_EQ(held.conditions.size(), 1u);
    EXPECT_EQ(held.conditions[0].log10_condition, 0); // L = d = 2
    EXPECT_EQ(held.conditions[0].n, 1u);
    EXPECT_EQ(held.conditions[0].bound, 0.375);
    EXPECT_EQ(held.conditions[0].max_rel_err, 0.0625);
    EXPECT_TRUE(is_broken(judge(wide, zero, Promise::exact))); // not rounded to nearest

    const double above = std::nextafter(2, 3);
    for (const auto& [a, b] : {std::pair{std::array{above, above, above}, zero}, // lo > d
                               {std::array{1., 1.5, 1.75}, zero},                // hi < d
                               {std::array{1., 3., 2.5}, zero},                  // outside
                               {std::array{nan, nan, nan}, zero},                // not a number
                               {std::array{-1., 2., 2.}, zero},                  // lo < 0
                               {wide, std::array{0., 1e-300, 1e-300}},           // touch, not 0
                               {std::array{0., 0., 3.}, zero}}) {                // 0, no touch
        const Judgement broken = judge(a, b, Promise::certified);
        EXPECT_TRUE(is_broken(broken)) << a[0] << " " << a[1] << " " << a[2];
        EXPECT_EQ(broken.kernel->bound_violations, 1u);
        EXPECT_THAT(broken.kernel->witness, HasSubstr("truth 0x"));
    }
}

TEST(CaseTruth, CertifiedDistancesMustBeAsNarrowAsPromised) {
    const Scene scene = pairs_of_triangles({{at(0), at(1)}});
    const auto breaks = [&](double lo, double hi, Promise promise, double relative_width) {
        ContenderEntry contender = named(promise);
        contender.relative_width = relative_width;
        return is_broken(judged_distances(scene, {{lo, 1, hi}}, contender));
    };
    const double u = 0x1p-53, huge = 1e300, inf = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(breaks(1 - 0x1p-33, 1 + 0x1p-34, Promise::certified, 0x1p-32));
    EXPECT_TRUE(breaks(1 - 0x1p-33, 1 + 0x1p-32, Promise::certified, 0x1p-32));
    for (const double hi : {huge, inf}) {
        EXPECT_TRUE(breaks(0, hi, Promise::certified, 0x1p-32)) << hi;
        EXPECT_FALSE(breaks(0, hi, Promise::certified, 0)) << hi; // no width is promised
        EXPECT_TRUE(breaks(0, hi, Promise::exact, 0)) << hi;
    }
    EXPECT_TRUE(breaks(0, 1, Promise::certified, 0x1p-32)); // lo = 0
    EXPECT_FALSE(breaks(1 - u, 1, Promise::exact, 0));
    EXPECT_TRUE(breaks(1 - u, 1 + 2 * u, Promise::exact, 0));
}

TEST(CaseTruth, WidthsOfTinyAndHugeDistances) {
    const double tiny = 0x1p-1073, max = std::numeric_limits<double>::max();
    const double inf = std::numeric_limits<double>::infinity();
    ContenderEntry contender = named(Promise::certified);
    contender.relative_width = 0x1p-32;
    const auto breaks = [&](double gap, std::array<double, 3> said) {
        const Scene scene = pairs_of_triangles({{at(-gap / 2), at(gap / 2)}});
        return is_broken(judged_distances(scene, {said}, contender));
    };
    EXPECT_FALSE(breaks(tiny, {tiny / 2, tiny, 1.5 * tiny}));
    EXPECT_TRUE(breaks(2 * tiny, {tiny / 2, 2 * tiny, 3 * tiny}));
    Scene far = pairs_of_triangles({{at(-max), at(max)}});
    const auto beyond = [&](double lo) {
        return is_broken(judged_distances(far, {{lo, inf, inf}}, contender));
    };
    EXPECT_FALSE(beyond(max));
    EXPECT_TRUE(beyond(max * (1 - 0x1p-31)));
}

TEST(CaseTruth, TheOtherDistancesTakePartsOfThePair) {
    // a.a = (0,0,0), a.a a.b along x; b.b b.a along x at height 3, b.c at height 1 over a.a.
    const Triangle<double> a{{0, 0, 0}, {1, 0, 0}, {0, -9, 0}}, b{{5, 0, 3}, {4, 0, 3}, {0, 0, 1}};
    const Scene scene = pairs_of_triangles({{a, b}});
    const std::array<std::pair<const char*, double>, 4> known{{{"triangle_distance", 1},
                                                               {"segment_segment", std::sqrt(18)},
                                                               {"point_triangle", 1},
                                                               {"point_segment", 5}}};
    for (const auto& [task, d] : known) {
        const Judgement right = judged(scene, task, distances({{d, d, d}}), named(Promise::none));
        EXPECT_EQ(right.status, Status::exact) << task;
        EXPECT_EQ(right.kernel->task, task);
    }
}

TEST(CaseTruth, RaysAtFansMustHitOneOfThem) {
    Scene scene;
    RayCases cases;
    cases.triangles = {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}};
    RayCase hit;
    hit.ray = {{.25f, .25f, 0}, {0, 0, 1}};
    hit.count = 2;
    RayCase miss = hit;
    miss.ray.origin.x = 5;
    cases.rays = {hit, miss};
    scene.cases = cases;
    AnswerList<RayHit> answers;
    answers.list = {{1, 0, 0, 0}, {}};
    EXPECT_EQ(judged(scene, "ray_triangle", answers, named(Promise::none)).status, Status::exact);
    answers.list[0].t = std::nextafter(1.f, 2.f);
    EXPECT_EQ(judged(scene, "ray_triangle", answers, named(Promise::none)).kernel->max_ulp, 1);
    answers.list = {{}, {3, 0, 0, 1}};
    const Judgement wrong = judged(scene, "ray_triangle", answers, named(Promise::exact));
    EXPECT_EQ(wrong.kernel->false_neg, 1u);
    EXPECT_EQ(wrong.kernel->false_pos, 1u);
    EXPECT_TRUE(is_broken(wrong));
}

TEST(CaseTruth, NumbersOfExactRaysAreHeldToTheirBounds) {
    Scene scene;
    RayCases cases;
    cases.triangles = {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}};
    RayCase ray;
    ray.ray = {{.25f, .25f, 0}, {0, 0, 1}};
    ray.count = 2;
    cases.rays = {ray};
    scene.cases = cases;
    const auto breaks = [&](RayHit said, std::string_view task = "ray_triangle",
                            Promise promise = Promise::exact) {
        const auto answers = answers_of<RayHit>({said});
        const Judgement judgement = judged(scene, task, answers, named(promise));
        EXPECT_EQ(judgement.check.bound_violations > 0, is_broken(judgement));
        return is_broken(judgement);
    };
    const float up = std::nextafter(1.f, 2.f), down = 1 - 0x1p-23f;
    EXPECT_FALSE(breaks({1, .25f, .25f, 0}));
    EXPECT_FALSE(breaks({1, .25f + 0x1p-23f, .25f - 0x1p-23f, 0}));
    EXPECT_TRUE(breaks({up, .25f, .25f, 0}));
    EXPECT_TRUE(breaks({down, .25f, .25f, 0}));
    EXPECT_TRUE(breaks({1, .25f + 0x1p-22f, .25f, 0}));
    EXPECT_TRUE(breaks({1, .25f, .25f - 0x1p-22f, 0}));
    EXPECT_TRUE(breaks({1, std::nanf(""), .25f, 0}));
    EXPECT_TRUE(breaks({1, .25f, .25f, 1})); // the other triangle
    EXPECT_TRUE(breaks({1, .25f, .25f, 7})); // none
    EXPECT_TRUE(breaks({2, .25f, .25f, 1})); // not the nearest
    EXPECT_FALSE(breaks({2, .25f, .25f, 1}, "rays_any"));
    EXPECT_FALSE(breaks({up, .25f, .25f, 0}, "ray_triangle", Promise::never_leaks));
}

TEST(CaseTruth, AClosedMeshMustNotLeak) {
    // Of a triangle on its own never-leaks says nothing.
    Scene scene;
    RayCases cases;
    cases.triangles = {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{1, 1, 1}, {1, 0, 1}, {0, 1, 1}}};
    RayCase ray;
    ray.ray = {{.5f, .5f, 0}, {0, 0, 1}};
    ray.hit = Known::yes;
    const auto judge = [&](std::uint32_t triangles, RayHit said, Promise promise) {
        ray.count = triangles;
        cases.rays = {ray};
        scene.cases = cases;
        return judged(scene, "ray_triangle", answers_of<RayHit>({said}), named(promise));
    };
    EXPECT_FALSE(is_broken(judge(2, {1, .5f, .5f, 1}, Promise::never_leaks)));
    const Judgement leak = judge(2, {}, Promise::never_leaks);
    EXPECT_TRUE(is_broken(leak));
    EXPECT_EQ(leak.kernel->bound_violations, 1u);
    EXPECT_EQ(leak.kernel->false_neg, 0u);
    const Judgement alone = judge(1, {}, Promise::never_leaks);
    EXPECT_EQ(alone.status, Status::wrong);
    EXPECT_FALSE(is_broken(alone));
    EXPECT_FALSE(is_broken(judge(2, {}, Promise::none)));
    EXPECT_TRUE(is_broken(judge(2, {}, Promise::exact)));
}

TEST(CaseTruth, NothingIsJudgedWhereOraclesDiffer) {
    EXPECT_EQ(true_distance(4, {{0, 0, 0}}, {{1, 1, 2}, {-1, -1, 2}}).nearest, 2);
    try {
        true_distance(mpq_class(4) + mpq_class(1, 1'000'000'007), {{0, 0, 0}}, {{0, 0, 2}});
        ADD_FAILURE() << "a wrong squared distance passed";
    } catch (const std::logic_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("its second opinion differ on 0,0,0,0,0,2"));
    }
    // What is known by construction has a say too.
    Scene scene;
    MotionCases cases;
    cases.motions = {{LinearMotion{}, Known::no}}; // all is one point
    scene.cases = cases;
    EXPECT_THROW(judged(scene, "vertex_face", answers_of<Impact>({Impact{}}), named(Promise::none)),
                 std::logic_error);
}

TEST(CaseTruth, AFittedBoxMustHoldTheExactOne) {
    Scene scene;
    scene.cases = std::vector<FitCase>{{RigidTransform<double>{}, {{0, 0, 0}, {1, 2, 4}}}};
    const auto judge = [&](Aabb<double> box, Promise promise) {
        return judged(scene, "box_fit", answers_of<Aabb<double>>({box}), named(promise));
    };
    EXPECT_EQ(judge({{0, 0, 0}, {1, 2, 4}}, Promise::never_miss).status, Status::exact);
    const Judgement larger = judge({{-.25, 0, 0}, {1, 2, 5}}, Promise::never_miss);
    EXPECT_EQ(larger.status, Status::conservative);
    EXPECT_EQ(larger.kernel->max_rel_err, .25);
    EXPECT_TRUE(is_broken(judge({{0, 0, 0}, {1, 2, std::nextafter(4, 0)}}, Promise::never_miss)));
    EXPECT_EQ(judge({{0, 0, 0}, {1, nan, 4}}, Promise::none).status, Status::wrong);
}

TEST(CaseTruth, ObbsAndRayBoxesHaveTheirOracles) {
    Scene scene;
    Obb<double> box{{0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {1, 1, 1}}, other = box;
    other.centre.x = 2;
    scene.cases = std::vector<ObbPairCase>{{box, other}};
    EXPECT_EQ(judged(scene, "obb_obb", verdicts({{Answer::yes, 0}}), named(Promise::exact)).status,
              Status::exact);
    scene.cases = std::vector<RayBoxCase>{{{{0, 0, 0}, {1, 0, 0}}, {{2, 0, 0}, {3, 1, 1}}},
                                          {{{0, 0, 0}, {1, 0, 0}}, {}}};
    EXPECT_EQ(judged(scene, "ray_box", verdicts({{Answer::yes, 0}, {Answer::no, 0}}),
                     named(Promise::exact))
                  .status,
              Status::exact);
}

TEST(CaseTruth, ShapesAreAsFarApartAsTheyWerePut) {
    Scene scene;
    ShapePairCase pair{{convex::Sphere{1}, {}}, {convex::Sphere{2}, {}}, .999, 1.001};
    pair.b.pose.translation = {4, 0, 0};
    scene.cases = std::vector<ShapePairCase>{pair};
    const auto judge = [&](double distance, double lo, double hi, Promise promise,
                           const char* task = "signed_shape_distance") {
        return judged(scene, task, answers_of<Distance>({{distance, lo, hi}}), named(promise));
    };
    EXPECT_FALSE(is_broken(judge(1, 1, 1, Promise::certified)));
    EXPECT_EQ(judge(1, 1, 1, Promise::certified).check.oracle, "construction");
    EXPECT_FALSE(is_broken(judge(1, 1, 1, Promise::certified, "shape_distance")));
    EXPECT_FALSE(is_broken(judge(1, .9999999, 1, Promise::certified)));
    EXPECT_TRUE(is_broken(judge(1.1, 1.1, 1.1, Promise::certified)));
    EXPECT_TRUE(is_broken(judge(.99, .98, .99, Promise::certified)));
    EXPECT_TRUE(is_broken(judge(1.01, .9, 1, Promise::certified))); // not between its bounds
    EXPECT_TRUE(is_broken(judge(nan, nan, nan, Promise::certified)));
    EXPECT_EQ(judge(1.00102, 1, 1, Promise::none).status, Status::within_bound); // 1e-5 of 1 + 2
    EXPECT_EQ(judge(1.00104, 1, 1, Promise::none).status, Status::wrong);
    EXPECT_EQ(judge(.9, .9, .9, Promise::none).kernel->false_pos, 1u);
    EXPECT_EQ(judge(-1, -1, -1, Promise::none).status, Status::wrong);
    EXPECT_EQ(judge(nan, nan, nan, Promise::none).status, Status::conservative);
    const auto touch = [&](Answer answer) {
        return judged(scene, "shape_collide", verdicts({{answer, 0}}), named(Promise::certified))
            .status;
    };
    EXPECT_EQ(touch(Answer::no), Status::exact);
    EXPECT_EQ(touch(Answer::yes), Status::wrong);
    // What promises nothing may take 3e-5 for a touch (of 1 + 2, in doubles), not twice that.
    const auto of_gap = [&](double gap, const char* precision) {
        Scene near = scene;
        std::get<std::vector<ShapePairCase>>(near.cases)[0].lo = gap;
        std::get<std::vector<ShapePairCase>>(near.cases)[0].hi = gap + 1e-9;
        return judged(near, "shape_collide", verdicts({{Answer::yes, 0}}),
                      named(Promise::none, precision));
    };
    EXPECT_EQ(of_gap(2e-5, "f64").status, Status::within_bound);
    EXPECT_EQ(of_gap(2e-5, "f64").kernel->false_pos, 0u);
    EXPECT_NEAR(of_gap(2e-5, "f64").kernel->max_rel_err, 2e-5 / 3, 1e-7);
    EXPECT_EQ(of_gap(6e-5, "f64").status, Status::wrong);
    EXPECT_EQ(of_gap(5e-3, "f32").status, Status::within_bound);
    EXPECT_EQ(of_gap(7e-3, "f32").status, Status::wrong);

    std::get<std::vector<ShapePairCase>>(scene.cases)[0].lo = -.5;
    std::get<std::vector<ShapePairCase>>(scene.cases)[0].hi = -.25;
    EXPECT_FALSE(is_broken(judge(-.3, -.3, -.3, Promise::certified)));
    EXPECT_TRUE(is_broken(judge(-.2, -.2, -.2, Promise::certified)));
    EXPECT_FALSE(is_broken(judge(0, 0, 0, Promise::certified, "shape_distance")));
    EXPECT_TRUE(is_broken(judge(.1, .1, .1, Promise::certified, "shape_distance")));
    EXPECT_EQ(touch(Answer::yes), Status::exact);

    // Floats may move the two by more than their gap: then nobody is judged.
    std::get<std::vector<ShapePairCase>>(scene.cases)[0].lo = 1e-9;
    std::get<std::vector<ShapePairCase>>(scene.cases)[0].hi = 2e-9;
    const auto of_floats =
        judged(scene, "shape_collide", verdicts({{Answer::yes, 0}}), named(Promise::none, "f32"));
    EXPECT_EQ(of_floats.kernel->n, 0u);
    EXPECT_EQ(touch(Answer::yes), Status::wrong);
}

TEST(CaseTruth, RefusesWhatDoesNotFit) {
    const Scene scene = pairs_of_triangles({{at(0), at(1)}});
    EXPECT_THROW(find_task("ray_box")->make_truth(scene, 1), std::invalid_argument);
    EXPECT_THROW(judged(scene, "triangle_triangle", verdicts({}), named(Promise::none)),
                 std::runtime_error);
}

TEST(OnlyCase, KeepsTheOneThatIsWanted) {
    const Scene scene = pairs_of_triangles({{at(0), at(1)}, {at(0), at(2)}});
    const Cases one = only_case(scene.cases, 1);
    ASSERT_EQ(n_cases(one), 1u);
    EXPECT_EQ(std::get<std::vector<TrianglePairCase>>(one)[0].b, at(2));
    EXPECT_THROW(only_case(scene.cases, 2), std::out_of_range);
}

} // namespace
} // namespace boxwood::bench
