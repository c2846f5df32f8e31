#include "trees/world/continuous.h"

#include "kernels/oracle/rational.h"
#include "kernels/primitives/rotation.h"
#include "trees/testing/shapes_at_random.h"
#include "trees/testing/test_meshes.h"
#include "trees/world/mesh_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace boxwood {
namespace {

Pose moved(double x, double y = 0, double z = 0) {
    Pose pose;
    pose.translation = {x, y, z};
    return pose;
}

TEST(Motions, BeginAndEndWhereTheyShould) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-3, 3);
    for (int k = 0; k < 50; ++k) {
        const Pose from = random_pose(random, {place(random), place(random), place(random)});
        Pose to = random_pose(random, {place(random), place(random), place(random)});
        if (k % 5 == 0)
            to.rotation = from.rotation;
        for (const MotionPath kind : {MotionPath::linear, MotionPath::screw}) {
            const Motion motion(from, to, kind);
            const Vec3<double> p{.3, -.7, .2};
            EXPECT_LT(length(motion.at(0)(p) - from(p)), 1e-13);
            EXPECT_LT(length(motion.at(1)(p) - to(p)), 1e-12);
            // Nobody is faster than the longest way says.
            Aabb<float> box;
            box.extend(Vec3<float>{-.5f, -.75f, -.25f});
            box.extend(Vec3<float>{.5f, .25f, .75f});
            const double way = motion.longest_way(box);
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3<double> at{corner & 1 ? .5 : -.5, corner & 2 ? .25 : -.75,
                                      corner & 4 ? .75 : -.25};
                for (double t = 0; t < 1; t += .125)
                    EXPECT_LE(length(motion.at(t + .125)(at) - motion.at(t)(at)),
                              .125 * way * (1 + 1e-9));
            }
        }
    }
    EXPECT_EQ(Motion(moved(1, 2, 3)).longest_way(Aabb<float>{{-1, -1, -1}, {1, 1, 1}}), 0);
}

TEST(Motions, RelativeSpeedIsNoLessThanWhatPointsShow) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-3, 3);
    const auto pose = [&] {
        return random_pose(random, {place(random), place(random), place(random)});
    };
    const Aabb<float> box{{-.5f, -.75f, -.25f}, {.5f, .25f, .75f}};
    for (int k = 0; k < 200; ++k) {
        Pose from_a = pose(), to_a = pose(), from_b = pose(), to_b = pose();
        if (k % 4 == 0)
            to_a.rotation = from_a.rotation;
        if (k % 2 == 0) { // they go much the same way
            to_b.rotation = from_b.rotation;
            to_b.translation = from_b.translation + (to_a.translation - from_a.translation);
        }
        const Motion a(from_a, to_a, k % 3 ? MotionPath::linear : MotionPath::screw),
            b(from_b, to_b, k % 5 ? MotionPath::linear : MotionPath::screw);
        const double speed = relative_speed(a, box, b, box);
        EXPECT_LE(speed, a.longest_way(box) + b.longest_way(box));
        for (int corner = 0; corner < 64; ++corner) {
            const auto of = [&](int bits) {
                return Vec3<double>{bits & 1 ? .5 : -.5, bits & 2 ? .25 : -.75,
                                    bits & 4 ? .75 : -.25};
            };
            const auto between = [&](double t) {
                return b.at(t)(of(corner % 8)) - a.at(t)(of(corner / 8));
            };
            for (double t = 0; t < 1; t += .125)
                EXPECT_LE(length(between(t + .125) - between(t)), .125 * speed + 1e-12);
        }
    }
    const Motion together(moved(0, 0, 0), moved(5, 6, 7));
    EXPECT_LT(relative_speed(together, box, together, box), 1e-13);
}

TEST(Motions, OfHalfATurnAreNoTrap) {
    Pose turned;
    turned.rotation = {{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};
    const Motion motion(Pose{}, turned);
    EXPECT_LT(std::abs(motion.at(.5)(Vec3<double>{1, 0, 0}).x), 1e-15);
    EXPECT_LT(length(motion.at(1)(Vec3<double>{1, 2, 3}) - Vec3<double>{-1, -2, 3}), 1e-14);
}

TEST(Motions, OfSmallAnglesAreNoLongerThanTheySay) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> exponent(-12, -1);
    for (int k = 0; k < 2000; ++k) {
        const double angle = std::pow(10, exponent(random));
        Pose from = random_pose(random, {}), to = from;
        // Turned about its own z axis: corners go sqrt 2 times the angle.
        const double c = std::cos(angle), s = std::sin(angle);
        for (std::size_t row = 0; row < 3; ++row) {
            const Vec3<double> r = from.rotation[row];
            to.rotation[row] = {r.x * c + r.y * s, r.y * c - r.x * s, r.z};
        }
        Aabb<float> box;
        box.extend(Vec3<float>{-1, -1, -1});
        box.extend(Vec3<float>{1, 1, 1});
        EXPECT_GE(Motion(from, to).longest_way(box), std::sqrt(2.) * angle) << angle;
    }
}

TEST(Motions, OfSmallAnglesAreNoTrap) {
    for (const double angle : {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 3.0, std::acos(-1.0) - 1e-9}) {
        Pose from, to;
        from.translation = {.5, -1, 2};
        to.rotation = {{{std::cos(angle), -std::sin(angle), 0},
                        {std::sin(angle), std::cos(angle), 0},
                        {0, 0, 1}}};
        to.translation = {1, 2, 3};
        const Motion motion(from, to, MotionPath::screw);
        Aabb<float> box;
        box.extend(Vec3<float>{-1, -1, -1});
        box.extend(Vec3<float>{1, 1, 1});
        const double way = motion.longest_way(box);
        for (const Vec3<double>& p : {Vec3<double>{}, Vec3<double>{1, -1, 1}}) {
            EXPECT_LT(length(motion.at(0)(p) - from(p)), 1e-14) << angle;
            EXPECT_LT(length(motion.at(1)(p) - to(p)), 1e-13) << angle;
            for (double t = 0; t < 1; t += .125)
                EXPECT_LE(length(motion.at(t + .125)(p) - motion.at(t)(p)),
                          .125 * way * (1 + 1e-12));
        }
    }
}

TEST(FirstContact, OfMeshesThatGoTogetherTakesAStep) {
    const MeshTree ball(noisy_sphere(16, 16, 0, 1, .05)), thin(plate(1, 0));
    const FirstContact none = first_contact(ball, Motion(moved(.5, .5, .051), moved(90, 9, .051)),
                                            thin, Motion(Pose{}, moved(89.5, 8.5, 0)));
    EXPECT_EQ(none.hit, Answer::no);
    EXPECT_LE(none.steps, 3u);
}

TEST(FirstContact, OfAThinPlateIsNotMissed) {
    const MeshTree ball(noisy_sphere(16, 16, 0, 1, .05)), thin(plate(1, 0));
    // The plate stands at z = 0; the ball flies through its middle.
    const Motion flight(moved(.5, .5, -10), moved(.5, .5, 10));
    const FirstContact hit = first_contact(ball, flight, thin, Motion());
    EXPECT_EQ(hit.hit, Answer::yes);
    EXPECT_NEAR(hit.t_free, (10 - .05) / 20, 1e-8);
    EXPECT_NEAR(hit.t_hit, hit.t_free, 1e-8);
    EXPECT_LT(hit.steps, 100u);
    const FirstContact beside =
        first_contact(ball, Motion(moved(2, .5, -10), moved(2, .5, 10)), thin, Motion());
    EXPECT_EQ(beside.hit, Answer::no);
    EXPECT_EQ(beside.t_free, 1);
    EXPECT_EQ(first_contact(ball, Motion(moved(.5, .5, 0)), thin, Motion()).t_hit, 0);
}

/// Whatever a fine sampling of the motion finds touching, the answer is not later; and at its time
/// they are as good as in touch.
TEST(FirstContact, IsNotAfterWhatSamplesFind) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-2.5, 2.5);
    const MeshTree a(noisy_sphere(6, 7, .3, 1)), b(noisy_sphere(5, 8, .2, 2));
    std::size_t hits = 0;
    for (int k = 0; k < 60; ++k) {
        const MotionPath kind = k % 2 == 0 ? MotionPath::linear : MotionPath::screw;
        const auto somewhere = [&] {
            return random_pose(random, {place(random), place(random), place(random)});
        };
        const Motion motion_a(somewhere(), somewhere(), kind);
        const Motion motion_b(somewhere(), somewhere(), kind);
        const FirstContact first = first_contact(a, motion_a, b, motion_b);
        const auto touch = [&](double t) {
            return collide(a, b, relative_pose(motion_a.at(t), motion_b.at(t)));
        };
        constexpr int samples = 400;
        for (int i = 0; i <= samples; ++i) {
            const double t = static_cast<double>(i) / samples;
            if (t < first.t_free || first.hit == Answer::no) {
                EXPECT_FALSE(touch(t)) << t;
            }
        }
        EXPECT_NE(first.hit, Answer::maybe);
        if (first.hit == Answer::yes) {
            ++hits;
            const Pose there = relative_pose(motion_a.at(first.t_hit), motion_b.at(first.t_hit));
            EXPECT_LT(distance(a, b, there).hi, 1e-9);
        }
    }
    EXPECT_GT(hits, 10u);
    EXPECT_LT(hits, 55u);
}

TEST(FirstContact, IsTheSameWhereBothAreMovedSwappedOrScaled) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-3, 3);
    const TriangleMesh mesh_a = noisy_sphere(7, 9, .2, 1), mesh_b = noisy_sphere(8, 6, .3, 2);
    const auto scaled = [](TriangleMesh mesh) {
        for (Vec3<float>& v : mesh.vertices)
            v = 1024.f * v;
        return MeshTree(std::move(mesh));
    };
    const MeshTree a(mesh_a), b(mesh_b), large_a = scaled(mesh_a), large_b = scaled(mesh_b);
    const auto pose = [&] {
        return random_pose(random, {place(random), place(random), place(random)});
    };
    const auto larger = [](Pose of) {
        of.translation = 1024. * of.translation;
        return of;
    };
    std::size_t hits = 0;
    for (int k = 0; k < 60; ++k) {
        const auto path = k % 2 == 0 ? MotionPath::linear : MotionPath::screw;
        const Pose from_a = pose(), to_a = pose(), from_b = pose(), to_b = pose(), moved = pose();
        const Motion way_a(from_a, to_a, path), way_b(from_b, to_b, path);
        const FirstContact before = first_contact(a, way_a, b, way_b);
        for (const FirstContact& after :
             {first_contact(b, way_b, a, way_a),
              first_contact(a, Motion(compose(moved, from_a), compose(moved, to_a), path), b,
                            Motion(compose(moved, from_b), compose(moved, to_b), path)),
              first_contact(large_a, Motion(larger(from_a), larger(to_a), path), large_b,
                            Motion(larger(from_b), larger(to_b), path))}) {
            EXPECT_EQ(before.hit, after.hit);
            EXPECT_LE(before.t_free, after.t_hit + 1e-9);
            EXPECT_LE(after.t_free, before.t_hit + 1e-9);
        }
        hits += before.hit == Answer::yes;
    }
    EXPECT_GT(hits, 15u);
    EXPECT_LT(hits, 55u);
}

/// Along a floor, just above it: a step of the distance is a millionth of the way.
TEST(FirstContact, OfWhatSlidesJustAboveIsDecided) {
    const MeshTree cube(cube_mesh(.5f)), floor(plate(4, 0)), ball(noisy_sphere(24, 24, 0, 1, .5)),
        bumpy(plate(24, 0, .01));
    for (const double gap : {1e-3, 1e-6, 1e-9}) {
        const Motion slide(moved(-3, .5, .5 + gap), moved(3, .5, .5 + gap));
        for (const MeshTree* body : {&cube, &ball}) {
            const FirstContact none = first_contact(*body, slide, floor, Motion());
            EXPECT_EQ(none.hit, Answer::no) << gap;
            EXPECT_EQ(none.t_free, 1);
            EXPECT_LT(none.steps, 1000u) << gap;
        }
        // It turns about the upright meanwhile.
        Pose turned = moved(3, .5, .5 + gap);
        turned.rotation = rotation_about({0, 0, 1}, 1);
        const FirstContact turning =
            first_contact(cube, Motion(moved(-3, .5, .5 + gap), turned), floor, Motion());
        EXPECT_EQ(turning.hit, Answer::no) << gap;
        // It sinks a little more than the gap.
        const Motion sinking(moved(-3, .5, .5 + gap), moved(3, .5, .5 - gap / 8));
        const FirstContact late = first_contact(cube, sinking, floor, Motion());
        EXPECT_EQ(late.hit, Answer::no) << gap; // by then it is past the floor
        const Motion sunk(moved(-3, .5, .5 + gap), moved(3, .5, .5 - gap));
        const FirstContact hit = first_contact(cube, sunk, floor, Motion());
        EXPECT_EQ(hit.hit, Answer::yes);
        EXPECT_NEAR(hit.t_hit, .5, 5e-2); // nearer than the tolerance before
        EXPECT_LT(hit.steps, 200u) << gap;
    }
    EXPECT_EQ(first_contact(ball, Motion(moved(-3, .5, .5), moved(3, .5, .5)), bumpy, Motion()).hit,
              Answer::yes);
}

/// The first touch of the features of two meshes that do not turn, exact for whole coordinates.
Impact exact_first_touch(const TriangleMesh& a, Vec3<double> from_a, Vec3<double> to_a,
                         const TriangleMesh& b, Vec3<double> from_b, Vec3<double> to_b) {
    const auto corners = [](const TriangleMesh& mesh, std::size_t t) {
        const Triangle<float> triangle = mesh.triangle(static_cast<std::uint32_t>(t));
        return std::array{Vec3<double>(triangle.a), Vec3<double>(triangle.b),
                          Vec3<double>(triangle.c)};
    };
    Impact first;
    const auto note = [&](const Impact& impact) {
        if (impact.answer == Answer::yes && impact.t_hit < first.t_hit)
            first = impact;
    };
    const oracle::ExactContinuous kernel;
    for (std::size_t i = 0; i < a.triangles.size(); ++i)
        for (std::size_t j = 0; j < b.triangles.size(); ++j) {
            const auto of_a = corners(a, i), of_b = corners(b, j);
            for (std::size_t k = 0; k < 3; ++k) {
                LinearMotion of_vertex_a{{of_a[k] + from_a}, {of_a[k] + to_a}},
                    of_vertex_b{{of_b[k] + from_b}, {of_b[k] + to_b}};
                for (std::size_t l = 0; l < 3; ++l) {
                    of_vertex_a.start[l + 1] = of_b[l] + from_b;
                    of_vertex_a.end[l + 1] = of_b[l] + to_b;
                    of_vertex_b.start[l + 1] = of_a[l] + from_a;
                    of_vertex_b.end[l + 1] = of_a[l] + to_a;
                    const std::size_t next_k = (k + 1) % 3, next_l = (l + 1) % 3;
                    note(kernel.edge_edge({{of_a[k] + from_a, of_a[next_k] + from_a,
                                            of_b[l] + from_b, of_b[next_l] + from_b},
                                           {of_a[k] + to_a, of_a[next_k] + to_a, of_b[l] + to_b,
                                            of_b[next_l] + to_b}}));
                }
                note(kernel.vertex_face(of_vertex_a));
                note(kernel.vertex_face(of_vertex_b));
            }
        }
    return first;
}

/// Whole coordinates, so that corners meet corners and faces slide on faces.
TEST(FirstContact, OfWhatDoesNotTurnIsThatOfExactFeatures) {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> place(-4, 4), corner(-2, 2);
    const auto tetrahedron = [&] {
        TriangleMesh mesh;
        mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
        for (int i = 0; i < 4; ++i)
            mesh.vertices.push_back({static_cast<float>(corner(random)),
                                     static_cast<float>(corner(random)),
                                     static_cast<float>(corner(random))});
        return mesh;
    };
    const auto somewhere = [&] {
        return Vec3<double>{double(place(random)), double(place(random)), double(place(random))};
    };
    int hits = 0, misses = 0;
    for (int k = 0; k < 1500; ++k) {
        const TriangleMesh a = tetrahedron(), b = tetrahedron();
        const Vec3<double> from_a = somewhere(), to_a = somewhere(), from_b = somewhere(),
                           to_b = somewhere();
        const auto motion = [](Vec3<double> from, Vec3<double> to) {
            return Motion(moved(from.x, from.y, from.z), moved(to.x, to.y, to.z));
        };
        const MeshTree tree_a(a), tree_b(b);
        const Motion motion_a = motion(from_a, to_a), motion_b = motion(from_b, to_b);
        const FirstContact found = first_contact(tree_a, motion_a, tree_b, motion_b);
        // One inside the other at the start, surfaces apart, is a start like any.
        const bool at_once = collide(tree_a, tree_b, relative_pose(motion_a.at(0), motion_b.at(0)));
        const Impact truth = exact_first_touch(a, from_a, to_a, b, from_b, to_b);
        if (at_once) {
            EXPECT_EQ(found.hit, Answer::yes) << k;
            EXPECT_EQ(found.t_free, 0) << k;
        } else if (truth.answer == Answer::yes) {
            ++hits;
            EXPECT_EQ(found.hit, Answer::yes) << k;
            EXPECT_LE(found.t_free, truth.t_hit) << k;
            EXPECT_GE(found.t_hit, truth.t_free - 1e-4) << k;
        } else {
            ++misses;
            EXPECT_EQ(found.hit, Answer::no) << k;
        }
    }
    EXPECT_GT(hits, 300);
    EXPECT_GT(misses, 300);
}

TEST(FirstContact, OfNothingNever) {
    const MeshTree cube(cube_mesh(1));
    EXPECT_EQ(first_contact(MeshTree(), Motion(), cube, Motion()).hit, Answer::no);
    EXPECT_THROW(first_contact(cube, Motion(), cube, Motion(), {.tolerance = -1}),
                 std::invalid_argument);
}

TEST(FirstContactWithAShape, OfAThinPlateIsNotMissed) {
    const MeshTree thin(plate(3, 0));
    for (const convex::Shape& shape :
         {convex::Shape(convex::Sphere{.05}), convex::Shape(convex::Box{{.05, .05, .05}}),
          convex::Shape(convex::Cylinder{.01, .05})}) {
        const Motion flight(moved(.5, .5, -10), moved(.5, .5, 10));
        const FirstContact hit = first_contact(thin, Motion(), shape, flight);
        EXPECT_EQ(hit.hit, Answer::yes);
        EXPECT_NEAR(hit.t_free, (10 - .05) / 20, 1e-8);
        EXPECT_NEAR(hit.t_hit, hit.t_free, 1e-8);
        const FirstContact beside =
            first_contact(thin, Motion(), shape, Motion(moved(2, .5, -10), moved(2, .5, 10)));
        EXPECT_EQ(beside.hit, Answer::no);
        EXPECT_EQ(beside.t_free, 1);
    }
}

TEST(FirstContactWithAShape, OfAFloorThatRisesOrTurns) {
    const MeshTree cube(cube_mesh(1));
    const convex::HalfSpace floor{{0, 0, 1}, 0};
    const FirstContact rising =
        first_contact(cube, Motion(), floor, Motion(moved(50, 9, -5), moved(50, 9, 0)));
    EXPECT_EQ(rising.hit, Answer::yes);
    EXPECT_NEAR(rising.t_hit, .8, 1e-9);
    // About an axis at x = 4: the far edge, 5 away, is met when it has risen by 1.
    Pose turned = moved(4, 0, -1);
    const double angle = std::acos(-1.0) / 4;
    turned.rotation = rotation_about({0, 1, 0}, angle);
    const FirstContact turning = first_contact(cube, Motion(), convex::Plane{{0, 0, 1}, -1},
                                               Motion(moved(4, 0, -1), turned));
    EXPECT_EQ(turning.hit, Answer::yes);
    EXPECT_NEAR(turning.t_hit, std::asin(.2) / angle, 1e-9);
}

/// A cylinder comes to graze the top edge of a cube: the bound by the triangles of the step before
/// is 0 where they are still apart, which is no contact.
TEST(FirstContactWithAShape, IsNotSaidWhereTheyAreApart) {
    const MeshTree cube(cube_mesh(1));
    const convex::Cylinder can{.5, .5};
    const Motion flight(moved(5, 1.5, 0), moved(-5, 1.5, 0));
    const FirstContact first = first_contact(cube, Motion(), can, flight);
    EXPECT_NE(first.hit, Answer::no);
    EXPECT_GT(first.t_free, .3999);
    EXPECT_LE(first.t_free, .4);
    if (first.hit == Answer::yes) {
        EXPECT_LT(distance(cube, can, flight.at(first.t_hit)).lo, 1e-9);
    }
}

/// Whatever a fine sampling of the motion finds touching, the answer is not later; and at its time
/// they are as good as in touch.
TEST(FirstContactWithAShape, IsNotAfterWhatSamplesFind) {
    ShapesAtRandom shapes(9);
    const MeshTree tree(noisy_sphere(6, 7, .3, 1));
    std::size_t hits = 0, misses = 0;
    for (const convex::ShapeKind kind : all_shape_kinds())
        for (int k = 0; k < 4; ++k) {
            SCOPED_TRACE(std::string(to_string(kind)));
            const convex::Shape shape = shapes.shape(kind);
            const MotionPath path = k % 2 == 0 ? MotionPath::linear : MotionPath::screw;
            const Motion motion(shapes.pose(2), shapes.pose(2), path);
            const Motion of_shape(shapes.pose(4), shapes.pose(4), path);
            const FirstContact first = first_contact(tree, motion, shape, of_shape);
            EXPECT_NE(first.hit, Answer::maybe);
            (first.hit == Answer::yes ? hits : misses)++;
            for (int i = 0; i <= 200; ++i) {
                const double t = i / 200.0;
                if (t < first.t_free || first.hit == Answer::no) {
                    EXPECT_NE(
                        collide(tree, shape, relative_pose(motion.at(t), of_shape.at(t))).answer,
                        Answer::yes)
                        << t;
                }
            }
            if (first.hit == Answer::yes) {
                const Pose there = relative_pose(motion.at(first.t_hit), of_shape.at(first.t_hit));
                EXPECT_LT(distance(tree, shape, there).lo, 1e-9);
            }
        }
    EXPECT_GT(hits, 10u);
    EXPECT_GT(misses, 3u);
}

} // namespace
} // namespace boxwood
