#include "trees/world/bodies/shape_pairs.h"

#include "kernels/triangle_distance/certified.h"
#include "trees/testing/test_bodies.h"
#include "trees/world/bodies/detail/swept_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Some two of all kinds, one after the other, with poses near each other.
template <class F> void for_pairs_of_shapes(std::uint32_t seed, int times, double reach, F f) {
    std::vector<BodyShape> shapes = shapes_of_all_kinds();
    shapes.emplace_back(convex::HalfSpace{{1, 2, 2}, -.3});
    shapes.emplace_back(convex::Plane{{0, -1, 2}, .2});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-reach, reach);
    const auto pose = [&] {
        return random_pose(random, {place(random), place(random), place(random)});
    };
    for (const BodyShape& a : shapes)
        for (const BodyShape& b : shapes)
            for (int i = 0; i < times; ++i) {
                const Pose pose_a = pose(), pose_b = pose();
                f(PosedShape{a, pose_a}, PosedShape{b, pose_b});
            }
}

TEST(ShapePairs, AgreeWithEachOther) {
    std::size_t apart = 0, touching = 0;
    for_pairs_of_shapes(1, 3, .8, [&](const PosedShape& a, const PosedShape& b) {
        const Answer hit = collide(a, b);
        EXPECT_EQ(collide(b, a), hit);
        const BodyDistance d = distance(a, b), back = distance(b, a);
        EXPECT_LE(d.lo, d.distance);
        EXPECT_LE(d.distance, d.hi);
        EXPECT_LE(d.lo, back.hi);
        EXPECT_LE(back.lo, d.hi);
        EXPECT_TRUE(hit != Answer::no || d.hi > 0);
        EXPECT_TRUE(hit != Answer::yes || d.lo == 0);
        const std::vector<BodyContact> all = contacts(a, b), other = contacts(b, a);
        EXPECT_EQ(hit == Answer::no, all.empty());
        EXPECT_EQ(all.size(), other.size());
        if (!all.empty()) {
            EXPECT_NEAR(length(all.front().normal), 1, 1e-12);
        }
        if (d.lo > 0) {
            ++apart;
            EXPECT_NEAR(length(d.point_b - d.point_a),
                        d.distance + a.shape.radius() + b.shape.radius(), 1e-6);
            EXPECT_EQ(within(a, b, d.hi * 1.0001), Answer::yes);
            EXPECT_EQ(within(a, b, d.lo * .9999), Answer::no);
            DistanceOptions options;
            options.limit = d.lo * .99;
            const BodyDistance none = distance(a, b, options);
            EXPECT_TRUE(none.lo >= options.limit);
        } else {
            ++touching;
        }
    });
    EXPECT_GT(apart, 150u);
    EXPECT_GT(touching, 150u);
}

TEST(ShapePairs, DistancesAreAsRoughAsIsAllowed) {
    std::size_t wide = 0, wide_of_convex = 0;
    for_pairs_of_shapes(12, 2, 3, [&](const PosedShape& a, const PosedShape& b) {
        const BodyDistance d = distance(a, b);
        for (const auto& [relative, absolute] : {std::pair{.5, 0.}, {0., .2}, {.2, .1}}) {
            DistanceOptions options;
            options.relative = relative;
            options.absolute = absolute;
            const BodyDistance rough = distance(a, b, options);
            EXPECT_LE(rough.lo, d.hi);
            EXPECT_GE(rough.hi, d.lo);
            const double radius = a.shape.radius() + b.shape.radius();
            const double allowed = relative * (rough.hi + radius) + absolute;
            EXPECT_LE(rough.hi - rough.lo, allowed * (1 + 1e-6) + 1e-9);
            if (rough.hi - rough.lo > 1e-4) {
                ++wide;
                wide_of_convex += a.shape.shape_class() == ShapeClass::convex &&
                                  b.shape.shape_class() == ShapeClass::convex;
            }
        }
    });
    EXPECT_GT(wide, 100u);
    EXPECT_GT(wide_of_convex, 30u);
    const BodyShape ball = convex::Sphere{1};
    for (const double relative : {-.1, 1., std::nan("")})
        EXPECT_THROW(distance(PosedShape{ball}, PosedShape{ball}, {.relative = relative}),
                     std::invalid_argument);
}

TEST(ShapePairs, ReachAsFarAsTheirMargins) {
    std::size_t seen = 0;
    for_pairs_of_shapes(2, 2, 1.5, [&](const PosedShape& a, const PosedShape& b) {
        const BodyDistance d = distance(a, b);
        if (!(d.lo > .01))
            return;
        ++seen;
        const double most = d.distance;
        for (const double part : {0.0, .25, .7}) {
            for (const double factor : {1 - 1e-5, 1 + 1e-5, .3, 2.0}) {
                const PosedShape wide_a{a.shape, a.pose, part * factor * most},
                    wide_b{b.shape, b.pose, (1 - part) * factor * most};
                EXPECT_EQ(collide(wide_a, wide_b) == Answer::yes, factor > 1);
                const BodyDistance left = distance(wide_a, wide_b);
                const double expected = std::max(0.0, (1 - factor) * most);
                EXPECT_NEAR(left.distance, expected, 1e-9 * most);
                EXPECT_TRUE(left.lo <= left.distance && left.distance <= left.hi);
                EXPECT_EQ(within(wide_a, wide_b, expected + 1e-6 * most), Answer::yes);
                const auto meeting = contacts(wide_a, wide_b);
                EXPECT_EQ(meeting.empty(), factor < 1);
                if (!meeting.empty()) {
                    const BodyContact& deepest = meeting.front();
                    EXPECT_NEAR(deepest.depth, (factor - 1) * most, 1e-9 * most);
                    EXPECT_GT(dot(deepest.normal, d.point_b - d.point_a), .999 * most);
                }
            }
        }
        // A box around the grown shape holds its nearest point, pushed out by the margin.
        if (a.shape.is_bounded() && b.shape.is_bounded()) {
            const Aabb<double> box_a = a.shape.bounds_at(a.pose), box_b = b.shape.bounds_at(b.pose);
            EXPECT_TRUE(box_a.contains(d.point_a) && box_b.contains(d.point_b));
        }
    });
    EXPECT_GT(seen, 100u);
}

TEST(ShapePairs, MarginsMakeAllThatIsNearMeet) {
    const BodyShape ball = BodyShape::surface(noisy_sphere(12, 13, 0, 1)),
                    solid = BodyShape::solid(noisy_sphere(12, 13, 0, 1));
    const std::vector<BodyContact> near = contacts({ball, {}, .1}, {ball, pose_at(2.05), .1});
    EXPECT_GT(near.size(), 10u);
    for (const BodyContact& contact : near)
        EXPECT_TRUE(contact.depth > -1e-12 && contact.depth < .2 && contact.normal.x > 0);
    ContactOptions few; // the nearest is one of them
    few.max_pairs = 3;
    const std::vector<BodyContact> some = contacts({ball, {}, .1}, {ball, pose_at(2.05), .1}, few);
    EXPECT_LE(some.size(), 4u);
    EXPECT_NEAR(some.front().depth, near.front().depth, 1e-12);
    few.max_contacts = 1;
    EXPECT_EQ(contacts({ball, {}, .1}, {ball, pose_at(2.05), .1}, few).size(), 1u);
    // Where some touch, those alone: others are near on this side of the surface and on that.
    const std::size_t touching = contacts({ball}, {ball, pose_at(1.9)}).size();
    EXPECT_GT(touching, 0u);
    EXPECT_EQ(contacts({ball, {}, .1}, {ball, pose_at(1.9), .1}).size(), touching);
    // Near the surface of a solid, and within it: out of it is the way.
    const BodyShape small = BodyShape::solid(cube_mesh(.1f));
    const std::vector<BodyContact> in = contacts({solid, {}, .1}, {small, pose_at(.8)});
    ASSERT_EQ(in.size(), 1u);
    EXPECT_GT(in.front().depth, .1);
    EXPECT_LT(in.front().normal.x, 1.01);
    EXPECT_GT(dot(in.front().normal, Vec3<double>{1, 0, 0}), .5);
}

TEST(ShapePairs, SignedDistancesGoBelowZero) {
    std::size_t deep = 0, apart = 0, refused = 0;
    for_pairs_of_shapes(3, 3, .8, [&](const PosedShape& a, const PosedShape& b) {
        const ShapeClass kind = a.shape.shape_class();
        if (kind == ShapeClass::surface || b.shape.shape_class() == ShapeClass::surface) {
            ++refused;
            EXPECT_THROW(signed_distance(a, b), std::invalid_argument);
            return;
        }
        if (kind != b.shape.shape_class())
            return; // detail/deepest_test.cpp
        const BodyDistance s = signed_distance(a, b), back = signed_distance(b, a);
        const BodyDistance d = distance(a, b);
        if (!std::isfinite(s.lo)) // two flats that cross everywhere
            return;
        EXPECT_TRUE(s.lo <= s.distance && s.distance <= s.hi);
        EXPECT_TRUE(s.lo <= back.hi && back.lo <= s.hi);
        EXPECT_TRUE(std::max(0.0, s.lo) <= d.hi && d.lo <= std::max(0.0, s.hi));
        const BodyDistance grown =
            signed_distance(PosedShape{a.shape, a.pose, .25}, PosedShape{b.shape, b.pose, .125});
        EXPECT_NEAR(grown.distance, s.distance - .375, 1e-12);
        EXPECT_TRUE(grown.lo <= s.lo - .375 && s.hi - .375 <= grown.hi);
        deep += s.hi < 0;
        apart += s.lo > 0;
        if (kind == ShapeClass::convex && s.hi < 0) { // the least way that parts them does
            Pose parted = b.pose;
            parted.translation = parted.translation + (s.point_a - s.point_b);
            EXPECT_NEAR(signed_distance(a, {b.shape, parted}).distance, 0, 1e-5);
        }
    });
    EXPECT_GT(deep, 40u);
    EXPECT_GT(apart, 20u);
    EXPECT_GT(refused, 100u);

    const BodyShape cube = BodyShape::solid(cube_mesh(1));
    const BodyDistance half = signed_distance({cube}, {cube, pose_at(1.5)}, .01);
    EXPECT_NEAR(half.distance, -.5, .01);
    EXPECT_LE(half.hi - half.lo, .0101);
    EXPECT_NEAR(signed_distance({cube}, {cube, pose_at(3)}).distance, 1, 1e-9);
    EXPECT_THROW(signed_distance({cube}, {cube}, -1), std::invalid_argument);
    const BodyShape none = BodyShape::solid(TriangleMesh{});
    EXPECT_EQ(signed_distance({cube, {}, 1}, {none}).lo, std::numeric_limits<double>::infinity());
}

TEST(ShapePairs, SolidsHoldWhatLiesInside) {
    const BodyShape solid = BodyShape::solid(cube_mesh(2)),
                    shell = BodyShape::surface(cube_mesh(2));
    for (const BodyShape& small : shapes_of_all_kinds())
        for (const double x : {.5, 4.5}) {
            const PosedShape outer{solid}, inner{small, pose_at(x)};
            const bool is_in = x < 1;
            EXPECT_EQ(collide(outer, inner), is_in ? Answer::yes : Answer::no);
            EXPECT_EQ(collide(inner, outer), is_in ? Answer::yes : Answer::no);
            EXPECT_EQ(collide(PosedShape{shell}, inner), Answer::no);
            EXPECT_EQ(within(outer, inner, .1), is_in ? Answer::yes : Answer::no);
            EXPECT_EQ(distance(outer, inner).hi == 0, is_in);
            DistanceOptions near;
            near.limit = .01;
            EXPECT_EQ(distance(inner, outer, near).hi == 0, is_in);
            const auto found = contacts(outer, inner), back = contacts(inner, outer);
            EXPECT_EQ(found.size(), is_in ? 1u : 0u);
            if (is_in) {
                // Out by the nearest way.
                EXPECT_NEAR(found[0].depth,
                            distance(PosedShape{shell}, inner).distance + 2 * small.radius(),
                            1e-12);
                EXPECT_NEAR(found[0].normal.x, 1, 1e-4);
                EXPECT_NEAR(back.at(0).normal.x, -1, 1e-4);
            }
            const FirstContact first = first_contact({solid}, {small, pose_at(x), pose_at(x + 1)});
            EXPECT_EQ(first.hit, is_in ? Answer::yes : Answer::no);
            EXPECT_EQ(first.t_hit, is_in ? 0 : 1);
        }
}

TEST(ShapePairs, PointsAreBallsAndNeverMissed) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> place(-1, 1);
    std::vector<Vec3<float>> points;
    for (int i = 0; i < 60; ++i)
        points.push_back({place(random), place(random), place(random)});
    const double radius = .15;
    const BodyShape cloud = BodyShape::points(points, radius);
    const TriangleMesh mesh = noisy_sphere(6, 7, .3, 3, .5);
    const BodyShape surface = BodyShape::surface(mesh);
    std::size_t hits = 0;
    for (int k = 0; k < 60; ++k) {
        const Pose at = random_pose(random, {2.0 * static_cast<double>(place(random)), 1, 0});
        double least = std::numeric_limits<double>::infinity();
        std::uint32_t nearest = 0;
        for (std::uint32_t i = 0; i < points.size(); ++i)
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
                const Vec3<double> p(points[i]);
                const double d =
                    CertifiedDistance::distance({p, p, p}, triangle_at(mesh, t, at)).distance;
                if (d < least) {
                    least = d;
                    nearest = i;
                }
            }
        const BodyDistance got = distance(PosedShape{cloud}, PosedShape{surface, at});
        EXPECT_NEAR(got.distance, std::max(0.0, least - radius), 1e-12);
        EXPECT_EQ(got.parts.a, nearest);
        EXPECT_EQ(collide(PosedShape{cloud}, PosedShape{surface, at}) != Answer::no,
                  least <= radius);
        const convex::Shape sphere = convex::Sphere{.2};
        for (std::uint32_t i = 0; i < points.size(); i += 20) {
            const Pose beside =
                pose_at(double{points[i].x} + .34, double{points[i].y}, double{points[i].z});
            EXPECT_EQ(collide(PosedShape{cloud}, PosedShape{sphere, beside}), Answer::yes);
        }
        hits += least <= radius;
    }
    EXPECT_GT(hits, 10u);
    EXPECT_LT(hits, 55u);
}

TEST(ShapePairs, FirstContactsKeepTheirTimes) {
    std::size_t hits = 0, kept = 0;
    std::mt19937 random(9);
    std::uniform_real_distribution<double> place(-2, 2);
    for_pairs_of_shapes(6, 1, 1.5, [&](const PosedShape& a, const PosedShape& b) {
        for (const double margin : {0.0, .1}) {
            const MotionPath path = random() % 2 ? MotionPath::screw : MotionPath::linear;
            const auto to = [&](const PosedShape& of, const PosedShape& other) {
                Pose pose = random_pose(random, {place(random), place(random), place(random)});
                if (!of.shape.is_bounded() && other.shape.shape_class() == ShapeClass::convex)
                    pose.rotation = of.pose.rotation;
                return pose;
            };
            const MovingShape first{a.shape, a.pose, to(a, b), path, margin},
                second{b.shape, b.pose, to(b, a), path};
            const FirstContact found = first_contact(first, second);
            EXPECT_LE(found.t_free, found.t_hit);
            const Motion motion_a(first.from, first.to, path),
                motion_b(second.from, second.to, path);
            const auto gap_at = [&](double t) {
                return distance(PosedShape{a.shape, motion_a.at(t), margin},
                                PosedShape{b.shape, motion_b.at(t)});
            };
            for (int i = 0; i < 12; ++i) // strictly before
                if (found.t_free > 0) {
                    EXPECT_GT(gap_at(found.t_free * i / 12).hi, 0);
                }
            if (found.hit == Answer::yes) {
                ++hits;
                EXPECT_LT(gap_at(found.t_hit).lo, 1e-8);
            }
            kept += found.hit == Answer::no;
            for (const MovingShape* of : {&first, &second})
                if (of->shape.is_bounded()) {
                    Aabb<double> swept = detail::swept_box(*of);
                    swept.min = swept.min - Vec3<double>{1e-12, 1e-12, 1e-12};
                    swept.max = swept.max + Vec3<double>{1e-12, 1e-12, 1e-12};
                    const Motion motion(of->from, of->to, path);
                    for (int i = 0; i <= 20; ++i) {
                        const Aabb<double> box = of->shape.bounds_at(motion.at(i / 20.0));
                        EXPECT_TRUE(swept.contains(box));
                    }
                }
        }
    });
    EXPECT_GT(hits, 100u);
    EXPECT_GT(kept, 50u);
}

TEST(ShapePairs, MarginsAreNotTunnelledThrough) {
    // One cube passes the other at a distance of .2, within a few thousandths of the time.
    const BodyShape cube = BodyShape::surface(cube_mesh(.1f)),
                    small = BodyShape::surface(cube_mesh(.1f));
    const MovingShape passing{cube, pose_at(-100, .4), pose_at(100, .4)};
    EXPECT_EQ(first_contact(passing, {small}).hit, Answer::no);
    for (const double margin : {.19, .21}) {
        const FirstContact found =
            first_contact(passing, {small, {}, {}, MotionPath::linear, margin});
        EXPECT_EQ(found.hit, margin > .2 ? Answer::yes : Answer::no);
        if (margin > .2) {
            const double expected = .5 - (.2 + std::sqrt(margin * margin - .04)) / 200;
            EXPECT_NEAR(found.t_hit, expected, 1e-6);
        }
    }
}

TEST(BodyShapes, SayWhatIsWrong) {
    const auto says = [](const char* words) {
        return ThrowsMessage<std::invalid_argument>(HasSubstr(words));
    };
    EXPECT_THAT([] { BodyShape shape(convex::Sphere{-1}); }, says("sphere"));
    EXPECT_THAT([] { BodyShape shape(convex::Box{{1, std::nan(""), 1}}); }, says("box"));
    EXPECT_THAT([] { BodyShape shape(convex::Capsule{1, 1e30}); }, says("capsule"));
    EXPECT_THAT([] { BodyShape::hull({}); }, says("no point"));
    EXPECT_THAT([] { BodyShape shape(convex::Plane{{0, 0, 0}, 1}); }, says("normal"));
    EXPECT_THAT([] { BodyShape::points({}, -1); }, says("radius"));
    const std::vector<float> heights{1, 2, 3, 4, 5};
    EXPECT_THAT([&] { BodyShape::height_field(2, heights, 1, 1); }, says("5 heights"));
    TriangleMesh open = cube_mesh(1);
    open.triangles.pop_back();
    EXPECT_THAT([&] { BodyShape::solid(open); }, says("no solid"));
    open.triangles.front()[1] = 99;
    EXPECT_THAT([&] { BodyShape::surface(open); }, says("vertex 99"));
    open = cube_mesh(1);
    open.vertices[3].y = std::numeric_limits<float>::infinity();
    EXPECT_THROW(BodyShape::surface(open), InvalidBox);
}

TEST(BodyShapes, ShareTheirTree) {
    const BodyShape shape = BodyShape::surface(noisy_sphere(6, 7, .1, 1)), copy = shape;
    EXPECT_FALSE(shape.is_built());
    EXPECT_EQ(&shape.tree(), &copy.tree());
    EXPECT_TRUE(copy.is_built() && copy == shape && !copy.build());
    const auto tree = std::make_shared<const MeshTree>(noisy_sphere(6, 7, .1, 1));
    const BodyShape given = BodyShape::surface(tree);
    EXPECT_TRUE(given.is_built() && &given.tree() == tree.get());
    EXPECT_EQ(given.bounds(), shape.bounds());
    const BodyShape none = BodyShape::surface(TriangleMesh{});
    EXPECT_TRUE(none.empty() && none.bounds_at({}).is_empty());
    EXPECT_EQ(collide(PosedShape{none}, PosedShape{shape}), Answer::no);
    EXPECT_FALSE(distance(PosedShape{none}, PosedShape{shape}).found());
}

TEST(BodyShapes, ATreeThatFailsToBeBuiltIsBuiltWhenNextAskedFor) {
    for (const bool is_solid : {false, true}) {
        int calls = 0;
        MeshTreeOptions options;
        options.builder.build = [&, build = options.builder.build](Boxes boxes,
                                                                   const Executor& executor) {
            if (++calls == 1)
                throw std::bad_alloc();
            return build(boxes, executor);
        };
        options.builder.build_of_mesh = {};
        const BodyShape shape = is_solid ? BodyShape::solid(cube_mesh(1), options)
                                         : BodyShape::surface(cube_mesh(1), options);
        EXPECT_THROW(shape.build(), std::bad_alloc);
        EXPECT_FALSE(shape.is_built());
        EXPECT_EQ(collide(PosedShape{shape}, PosedShape{BodyShape(convex::Box{{2, 2, .5}})}),
                  Answer::yes);
        EXPECT_EQ(calls, 2);
    }
}

TEST(BodyShapes, OfHeightsAreTriangulatedInOrder) {
    const std::vector<float> heights{0, 1, 2, 3, 4, 5};
    const BodyShape field = BodyShape::height_field(3, heights, .5f, 2);
    const TriangleMesh& mesh = field.tree().mesh();
    ASSERT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(mesh.vertices[4], (Vec3<float>{.5f, 2, 4}));
    // A needle down onto the second cell.
    const BodyShape needle = convex::Box{{.01, .01, 10}};
    const auto found = distance(PosedShape{field}, PosedShape{needle, pose_at(.9, .2)});
    EXPECT_EQ(found.hi, 0);
    EXPECT_EQ(found.parts.a, 2u);
}

/// With a margin, too, a mesh that slides just beyond it is not left open.
TEST(ShapePairs, OfMeshesWithAMarginThatSlideAreDecided) {
    const BodyShape cube = BodyShape::surface(cube_mesh(.5f)),
                    floor = BodyShape::surface(plate(4, 0));
    const auto slide = [&](double gap) {
        Pose from, to;
        from.translation = {-3, .5, .5 + gap};
        to.translation = {3, .5, .5 + gap};
        return first_contact({cube, from, to, MotionPath::linear, .1},
                             {floor, {}, {}, MotionPath::linear, .05});
    };
    for (const double beyond : {1e-3, 1e-6, 1e-8}) {
        const FirstContact none = slide(.15 + beyond);
        EXPECT_EQ(none.hit, Answer::no) << beyond;
        EXPECT_LT(none.steps, 1000u) << beyond;
        EXPECT_EQ(slide(.15 - beyond).hit, Answer::yes) << beyond;
    }
}

} // namespace
} // namespace boxwood
