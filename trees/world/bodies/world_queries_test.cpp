#include "trees/testing/test_bodies.h"
#include "trees/testing/world_questions.h"
#include "trees/world/bodies/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>

namespace boxwood {
namespace {

double least_hi(const MirroredWorld& mirror, const std::vector<Pair>& pairs) {
    double least = std::numeric_limits<double>::infinity();
    for (const Pair p : pairs)
        least = std::min(least, distance(mirror.posed(p.a), mirror.posed(p.b)).hi);
    return least;
}

TEST(World, AnswersAsAllPairsDo) {
    std::size_t collisions = 0;
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        MirroredWorld mirror(with_unbounded());
        fill(mirror, seed, 50, 1.5 + seed);
        expect_all_questions_right(mirror);
        collisions += mirror.collisions().size();
    }
    EXPECT_GT(collisions, 200u);
}

TEST(World, FindsTheNearestOfAllPairs) {
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        MirroredWorld mirror(seed % 2 == 0 ? with_unbounded() : shapes_of_all_kinds());
        if (seed % 2 == 0) {
            fill(mirror, seed, 12, 20);
            mirror.remove(12); // the half-space, which holds half of them
        } else {
            RandomBodies random(seed, mirror.shapes.size(), 12);
            for (int i = 0; i < 25; ++i)
                mirror.insert(random.body());
        }
        const World& world = mirror.world;
        const double truth = least_hi(mirror, mirror.may_meet());
        const auto nearest = world.least_distance();
        ASSERT_TRUE(nearest);
        EXPECT_LE(nearest->lo, truth * (1 + 1e-9));
        EXPECT_GE(nearest->hi, truth * (1 - 1e-9));
        EXPECT_LE(nearest->hi, truth * (1 + 1e-8) + 1e-12);
        const Pair p = nearest->bodies;
        EXPECT_NEAR(nearest->distance, distance(mirror.posed(p.a), mirror.posed(p.b)).distance,
                    1e-9);
        EXPECT_FALSE(world.least_distance(truth * .99));
        EXPECT_TRUE(truth == 0 || world.least_distance(truth * 1.01));
        for (const std::uint32_t body : world.bodies()) {
            std::vector<Pair> with_body = mirror.may_meet();
            std::erase_if(with_body, [&](Pair q) { return q.a != body && q.b != body; });
            const auto near = world.least_distance_of(body);
            ASSERT_EQ(near.has_value(), !with_body.empty());
            if (near) {
                EXPECT_NEAR(near->hi, least_hi(mirror, with_body), 1e-8);
            }
        }
    }
}

/// Roughly: lo <= truth <= hi and no wider than is allowed; and less is done for it.
TEST(World, FindsTheNearestAsRoughlyAsIsAllowed) {
    Work fine_work, rough_work;
    std::size_t wide = 0;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        MirroredWorld mirror(shapes_of_all_kinds());
        RandomBodies random(seed, mirror.shapes.size(), 20);
        for (int i = 0; i < 25; ++i)
            mirror.insert(random.body());
        const World& world = mirror.world;
        const auto fine = world.least_distance(DistanceOptions{}, &fine_work);
        const double truth = least_hi(mirror, mirror.may_meet());
        ASSERT_TRUE(fine);
        EXPECT_NEAR(fine->hi, truth, 1e-8);
        for (const auto& [relative, absolute] : {std::pair{.5, 0.}, {0., .3}, {.3, .1}}) {
            const DistanceOptions options{.relative = relative, .absolute = absolute};
            Work work;
            const auto rough = world.least_distance(options, &work);
            ASSERT_TRUE(rough);
            EXPECT_LE(rough->lo, truth * (1 + 1e-9));
            EXPECT_GE(rough->hi, truth * (1 - 1e-9));
            const Pair p = rough->bodies;
            const double margins = mirror.posed(p.a).margin + mirror.posed(p.b).margin + .2;
            EXPECT_LE(rough->hi - rough->lo,
                      relative * (rough->hi + margins) + absolute + 1e-6 * (1 + truth));
            wide += rough->hi - rough->lo > 1e-3;
            EXPECT_LE(work.node_visits, fine_work.node_visits);
            if (relative == .5)
                rough_work += work;
            const std::uint32_t body = p.a;
            const auto near = world.least_distance_of(body, options);
            const auto exactly = world.least_distance_of(body);
            ASSERT_TRUE(near && exactly);
            EXPECT_LE(near->lo, exactly->hi);
            EXPECT_GE(near->hi, exactly->lo);
        }
    }
    EXPECT_GT(wide, 5u);
    EXPECT_GT(rough_work.node_visits, 0u);
    EXPECT_LT(rough_work.node_visits, fine_work.node_visits * 4 / 5);
    EXPECT_THROW(World().least_distance({.relative = 1}), std::invalid_argument);
}

/// How many pairs meet, which are those that all pairs tested one by one give.
std::size_t expect_first_contacts_of_all_pairs(const MirroredWorld& mirror,
                                               const std::vector<BodyMotion>& motions,
                                               const ContinuousOptions& options = {}) {
    const auto motion_of = [&](std::uint32_t body) {
        return std::ranges::find(motions, body, &BodyMotion::body);
    };
    const auto moves = [&](std::uint32_t body) { return motion_of(body) != motions.end(); };
    const auto moved = [&](std::uint32_t body) -> MovingShape {
        const PosedShape now = mirror.posed(body);
        if (!moves(body))
            return {now.shape, now.pose, now.pose, MotionPath::linear, now.margin};
        return {now.shape, now.pose, checked_pose(motion_of(body)->to), motion_of(body)->path,
                now.margin};
    };
    std::vector<Pair> expected;
    for (const Pair p : mirror.may_meet())
        if ((moves(p.a) || moves(p.b)) &&
            first_contact(moved(p.a), moved(p.b), options).hit != Answer::no)
            expected.push_back(p);
    std::vector<Pair> pairs;
    double before = 0;
    for (const BodyFirstContact& one : mirror.world.first_contacts(motions, options)) {
        pairs.push_back(one.bodies);
        EXPECT_LE(before, one.contact.t_hit);
        before = one.contact.t_hit;
    }
    EXPECT_EQ(sorted(pairs), expected);
    return expected.size();
}

TEST(World, SaysHowDeepTwoAre) {
    World world;
    const std::uint32_t ball = world.insert(convex::Sphere{.5}, pose_at(3));
    const std::uint32_t box = world.insert(convex::Box{{1, 1, 1}}, pose_at(1.75), {.margin = .125});
    const BodyDistance deep = world.signed_distance(box, ball);
    EXPECT_NEAR(deep.distance, -.375, 1e-12);
    EXPECT_EQ(deep.bodies, (Pair{box, ball}));
    EXPECT_NEAR(deep.point_a.x, 2.75, 1e-9); // on the box, without its margin
    EXPECT_NEAR(deep.point_b.x, 2.5, 1e-9);
    EXPECT_NEAR(world.signed_distance(ball, box).point_a.x, 2.5, 1e-9);
    const std::uint32_t shell = world.insert(BodyShape::surface(cube_mesh(1)));
    EXPECT_THROW(world.signed_distance(ball, shell), std::invalid_argument);
}

TEST(World, FindsFirstContactsAsAllPairsDo) {
    std::size_t hits = 0, hits_of_few = 0, hits_of_near = 0;
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
        MirroredWorld mirror(with_unbounded());
        fill(mirror, seed, 30, 4);
        RandomBodies random(seed + 20, mirror.shapes.size(), 4);
        std::vector<BodyMotion> motions;
        for (std::uint32_t body = 0; body < 32; ++body) {
            BodyMotion motion{body, random.pose(),
                              random.below(2) ? MotionPath::screw : MotionPath::linear};
            if (!mirror.world.shape(body).is_bounded())
                motion.to.rotation = mirror.world.pose(body).rotation;
            motions.push_back(motion);
        }
        // One or two of 32 are few, for which the world's own tree is asked.
        for (std::size_t i = 0; i + 1 < motions.size(); i += 2) {
            hits_of_few += expect_first_contacts_of_all_pairs(mirror, {motions[i]});
            hits_of_few += expect_first_contacts_of_all_pairs(mirror, {motions[i], motions[i + 1]});
        }
        std::erase_if(motions, [&](const BodyMotion&) { return random.below(2) == 0; });
        ASSERT_GT(motions.size(), 4u);
        hits += expect_first_contacts_of_all_pairs(mirror, motions);
        hits_of_near += expect_first_contacts_of_all_pairs(mirror, motions, {.tolerance = .5});
        hits_of_few += expect_first_contacts_of_all_pairs(mirror, {motions[0]}, {.tolerance = .5});
    }
    EXPECT_GT(hits, 50u);
    EXPECT_GT(hits_of_near, hits);
    EXPECT_GT(hits_of_few, 50u);
}

TEST(World, GroupsSaveTheWayDownTheTree) {
    constexpr std::uint32_t n = 4000;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(0, 30);
    World all, grouped;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Pose pose = pose_at(place(random), place(random), place(random));
        all.insert(convex::Sphere{1}, pose);
        // One in fifty moves; the others never meet each other.
        const bool moves = i % 50 == 0;
        grouped.insert(convex::Sphere{1}, pose,
                       {.group = moves ? 1u : 2u, .mask = moves ? 3u : 1u});
    }
    const auto counted = [](const World& world, std::vector<Pair>& found) {
        Work work;
        AppendPairs sink(found);
        world.candidates(sink, .001, &work);
        return work.box_tests;
    };
    std::vector<Pair> of_all, of_grouped;
    const std::uint64_t tests = counted(all, of_all), fewer = counted(grouped, of_grouped);
    std::erase_if(of_all, [](Pair p) { return p.a % 50 != 0 && p.b % 50 != 0; });
    EXPECT_EQ(sorted(of_all), sorted(of_grouped));
    EXPECT_LT(2 * fewer, tests);
    // Of boxes that overlap, too; and where groups keep few apart, by another search.
    const auto of_movers = [](std::vector<Pair> pairs) {
        std::erase_if(pairs, [](Pair p) { return p.a % 50 != 0 && p.b % 50 != 0; });
        return pairs;
    };
    EXPECT_EQ(grouped.candidates(), of_movers(all.candidates()));
    for (std::uint32_t i = 0; i < n; ++i)
        all.set_groups(i, i % 50 == 0 ? 1 : 2, i % 50 == 0 || i % 3 != 0 ? 3 : 1);
    std::vector<Pair> expected = grouped.candidates();
    for (std::uint32_t i = 0; i < n; ++i)
        grouped.set_groups(i, 1, ~0u);
    for (const Pair p : grouped.candidates())
        if (p.a % 50 != 0 && p.b % 50 != 0 && p.a % 3 != 0 && p.b % 3 != 0)
            expected.push_back(p);
    EXPECT_EQ(all.candidates(), sorted(expected));
}

TEST(World, GivesTheSameAnswersOnAnyNumberOfThreads) {
    MirroredWorld one(with_unbounded());
    fill(one, 3, 60, 2);
    const auto contact_points = [](const World& world) {
        std::vector<double> numbers;
        for (const BodyContact& c : world.contacts({.max_contacts = 4}))
            numbers.insert(numbers.end(), {c.point.x, c.point.y, c.point.z, c.depth});
        return numbers;
    };
    for (const unsigned threads : {2u, 4u}) {
        MirroredWorld many(with_unbounded(), {.threads = threads});
        fill(many, 3, 60, 2);
        EXPECT_EQ(many.world.collisions(), one.world.collisions());
        EXPECT_EQ(many.world.within(.2), one.world.within(.2));
        EXPECT_EQ(contact_points(many.world), contact_points(one.world));
    }
}

TEST(World, MayBeAskedByManyThreadsAtOnce) {
    MirroredWorld mirror(with_unbounded());
    fill(mirror, 9, 60, 2);
    const std::vector<Pair> expected = mirror.collisions();
    // Another one, whose tree and meshes are not there yet.
    MirroredWorld fresh(with_unbounded());
    fill(fresh, 9, 60, 2);
    const World& world = fresh.world;
    std::vector<std::vector<Pair>> found(4);
    std::vector<double> least(4);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < found.size(); ++i)
        threads.emplace_back([&, i] {
            found[i] = world.collisions();
            least[i] = world.least_distance()->hi;
            (void)world.ledger();
        });
    for (std::thread& thread : threads)
        thread.join();
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i], expected);
        EXPECT_EQ(least[i], least[0]);
    }
}

} // namespace
} // namespace boxwood
