#include "trees/world/bodies/world.h"

#include "trees/testing/test_bodies.h"
#include "trees/testing/world_questions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

TEST(World, FollowsAnyHistory) {
    MirroredWorld mirror(with_unbounded());
    RandomBodies random(7, mirror.shapes.size(), 2.5);
    World& world = mirror.world;
    std::size_t collisions = 0, most = 0;
    for (int step = 0; step < 10'000; ++step) {
        const std::vector<std::uint32_t> bodies = world.bodies();
        const auto any = [&] { return bodies[random.below(bodies.size())]; };
        const std::uint32_t what = random.below(16);
        if (bodies.size() < 2 || (what < 2 && bodies.size() < 45)) {
            mirror.insert(random.body());
        } else if (what < 3) {
            const std::uint32_t gone = any();
            mirror.remove(gone);
            EXPECT_FALSE(world.contains(gone));
        } else if (what < 4) {
            const std::uint32_t body = any();
            mirror.bodies[body]->margin = random.below(2) * .1;
            world.set_margin(body, mirror.bodies[body]->margin);
        } else if (what < 6) {
            const std::uint32_t body = any();
            mirror.bodies[body]->group = 1u << random.below(4);
            mirror.bodies[body]->mask = random.below(16);
            world.set_groups(body, mirror.bodies[body]->group, mirror.bodies[body]->mask);
        } else if (what < 9) {
            const std::uint32_t a = any(), b = any();
            if (a != b)
                random.below(3) ? mirror.allow(a, b) : mirror.disallow(a, b);
        } else if (what < 10) {
            std::vector<Pose> poses;
            for (const std::uint32_t body : bodies)
                poses.push_back((mirror.bodies[body]->pose = random.pose()));
            world.set_poses(bodies, poses);
        } else {
            const std::uint32_t body = any();
            mirror.bodies[body]->pose = random.pose();
            world.set_pose(body, mirror.bodies[body]->pose);
        }
        most = std::max(most, world.size());
        if (step % 100 == 99) {
            std::vector<Pair> may_meet = mirror.may_meet();
            for (std::uint32_t a = 0; a < mirror.bodies.size(); ++a)
                for (std::uint32_t b = 0; b < mirror.bodies.size(); ++b)
                    if (mirror.contains(a) && mirror.contains(b)) {
                        const bool expected = std::ranges::binary_search(
                            may_meet, Pair{std::min(a, b), std::max(a, b)});
                        EXPECT_EQ(world.may_meet(a, b), expected) << a << ' ' << b;
                    }
            const std::vector<Pair> expected = mirror.collisions();
            collisions += expected.size();
            ASSERT_EQ(world.collisions(), expected) << "step " << step;
        }
        if (step % 2000 == 1999)
            expect_all_questions_right(mirror);
    }
    EXPECT_GT(collisions, 1000u);
    EXPECT_GT(most, 30u);
}

TEST(World, ForgetsWhatIsRemoved) {
    World world;
    const std::uint32_t a = world.insert(convex::Sphere{1}, {}, {.name = "a"});
    const std::uint32_t b = world.insert(convex::Sphere{1}, pose_at(1), {.name = "b"});
    world.allow(a, b, AllowedReason::adjacent, "a joint");
    EXPECT_THAT(world.collisions(), IsEmpty());
    EXPECT_EQ(world.allowed(b, a), AllowedReason::adjacent);
    EXPECT_THAT(world.allowed_pairs(),
                ElementsAre(AllowedPair{a, b, AllowedReason::adjacent, "a joint"}));
    world.remove(b);
    EXPECT_THAT(world.allowed_pairs(), IsEmpty());
    EXPECT_THROW(world.find("b"), std::invalid_argument);
    EXPECT_THROW(world.pose(b), std::invalid_argument);
    const std::uint32_t c = world.insert(convex::Sphere{1}, pose_at(1.5), {.name = "b"});
    EXPECT_EQ(c, b); // its number comes back, not what it was allowed
    EXPECT_EQ(world.find("b"), c);
    EXPECT_THAT(world.collisions(), ElementsAre(Pair{a, c}));
    world.clear();
    EXPECT_TRUE(world.empty());
    EXPECT_THAT(world.collisions(), IsEmpty());
    EXPECT_FALSE(world.least_distance());
}

TEST(World, TakesAMatrixByItsNames) {
    World world;
    const std::uint32_t cup = world.insert(convex::Sphere{1}, {}, {.name = "cup"});
    const std::uint32_t hand = world.insert(convex::Sphere{1}, {}, {.name = "hand"});
    const std::uint32_t table = world.insert(convex::Sphere{1}, {}, {.name = "table"});
    AllowedPairs matrix({"hand", "base", "cup"});
    matrix.allow("hand", "cup", AllowedReason::never);
    world.allow(matrix);
    EXPECT_EQ(world.allowed(cup, hand), AllowedReason::never);
    EXPECT_THAT(world.collisions(), ElementsAre(Pair{cup, table}, Pair{hand, table}));
    world.disallow(hand, cup);
    EXPECT_EQ(world.collisions().size(), 3u);
    matrix.allow("hand", "base", AllowedReason::user);
    EXPECT_THAT([&] { world.allow(matrix); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("base")));
    EXPECT_EQ(world.collisions().size(), 3u); // nothing was changed
}

TEST(World, BuildsATreeWhenAPairNeedsItAndOnce) {
    const BodyShape mesh = BodyShape::surface(noisy_sphere(20, 20, .1, 1));
    const BodyShape solid = BodyShape::solid(noisy_sphere(9, 9, .1, 2));
    World world;
    const std::uint32_t first = world.insert(mesh);
    for (int i = 1; i < 10; ++i)
        world.insert(mesh, pose_at(5 * i));
    world.insert(solid, pose_at(0, 5));
    const auto builds = [&] { return world.ledger().row("mesh_trees").items; };
    EXPECT_THAT(world.collisions(), IsEmpty());
    EXPECT_THAT(world.within(.5), IsEmpty());
    EXPECT_FALSE(mesh.is_built());
    world.insert(convex::Sphere{1}, pose_at(0, 0, 40));
    world.set_pose(first, pose_at(0, 0, 1.9));
    EXPECT_THAT(world.collisions(), IsEmpty());
    EXPECT_FALSE(mesh.is_built());
    EXPECT_EQ(builds(), 0u);
    world.set_pose(first, pose_at(4, 0, .2));
    EXPECT_THAT(world.candidates(), ElementsAre(Pair{0, 1}));
    EXPECT_FALSE(mesh.is_built());
    EXPECT_THAT(world.collisions(), ElementsAre(Pair{0, 1}));
    EXPECT_TRUE(mesh.is_built());
    EXPECT_FALSE(solid.is_built());
    EXPECT_EQ(builds(), 1u);
    EXPECT_TRUE(world.least_distance());
    EXPECT_EQ(builds(), 1u); // they overlap: nothing else is looked at
}

TEST(World, ATreeThatAQueryBuildsIsNotInTheTimeOfTheQuery) {
    World world({.is_timed = true});
    const BodyShape mesh = BodyShape::surface(noisy_sphere(100, 100, .1, 1));
    world.insert(mesh);
    world.insert(mesh, pose_at(.5));
    EXPECT_TRUE(world.any_collision());
    const Ledger ledger = world.ledger();
    EXPECT_GT(ledger.row("mesh_trees").ns, 0);
    EXPECT_LT(ledger.row("collide").ns, ledger.row("mesh_trees").ns);
}

TEST(World, MakesOnlyTheStagesThatQueriesRequire) {
    World world({.is_timed = true});
    for (int i = 0; i < 8; ++i)
        world.insert(i % 2 ? BodyShape(convex::Sphere{.6}) : BodyShape::surface(cube_mesh(.5f)),
                     pose_at(i));
    const std::vector<WorldQuery> all{WorldQuery::candidates, WorldQuery::collide,
                                      WorldQuery::distance,   WorldQuery::within,
                                      WorldQuery::contacts,   WorldQuery::first_contact};
    for (const bool has_groups : {false, true})
        for (const WorldQuery query : all) {
            if (has_groups)
                world.set_groups(1, 2, 1);
            world.clear_ledger();
            const auto plan = world.plan({&query, 1});
            world.set_pose(0, pose_at(.1)); // fit, update
            switch (query) {
            case WorldQuery::candidates:
                world.candidates();
                break;
            case WorldQuery::collide:
                world.collisions();
                world.any_collision();
                world.collisions_of(3);
                break;
            case WorldQuery::distance:
                world.least_distance();
                world.least_distance_of(3);
                world.distances(.1);
                break;
            case WorldQuery::within:
                world.within(.1);
                break;
            case WorldQuery::contacts:
                world.contacts();
                break;
            case WorldQuery::first_contact: {
                const BodyMotion motion{0, pose_at(3, 1), MotionPath::screw};
                world.first_contacts({&motion, 1});
            }
            }
            const Ledger ledger = world.ledger({&query, 1});
            const auto rows = ledger.rows();
            ASSERT_EQ(rows.size(), plan.size());
            for (std::size_t i = 0; i < plan.size(); ++i) {
                EXPECT_EQ(rows[i].stage, plan[i].name);
                EXPECT_FALSE(plan[i].why.empty());
                EXPECT_EQ(rows[i].calls > 0, plan[i].is_required)
                    << plan[i].name << " of query " << static_cast<int>(query);
                EXPECT_EQ(rows[i].ns > 0, plan[i].is_required) << plan[i].name;
            }
        }
}

TEST(World, SaysWhatIsWrong) {
    World world;
    const std::uint32_t a = world.insert(convex::Sphere{1}, {}, {.name = "a"});
    const auto message = [](const char* words) {
        return ThrowsMessage<std::invalid_argument>(HasSubstr(words));
    };
    Pose bad;
    bad.translation.x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT([&] { world.set_pose(a, bad); }, message("pose"));
    EXPECT_THAT([&] { world.insert(convex::Sphere{1}, bad); }, message("pose"));
    EXPECT_THAT([&] { world.insert(convex::Sphere{1}, {}, {.name = "a"}); }, message("'a'"));
    EXPECT_THAT([&] { world.insert(convex::Sphere{1}, {}, {.margin = -1}); }, message("margin"));
    EXPECT_THAT([&] { world.set_margin(a, std::nan("")); }, message("margin"));
    EXPECT_THAT([&] { world.set_pose(7, {}); }, message("body 7"));
    EXPECT_THAT([&] { world.allow(a, a); }, message("itself"));
    EXPECT_THAT([&] { world.within(-1); }, message("tolerance"));
    EXPECT_THAT([&] { world.candidates_of(a, std::nan("")); }, message("tolerance"));
    EXPECT_THAT([&] { world.least_distance(-1); }, message("limit"));
    const std::uint32_t ids[] = {a, 5};
    const Pose poses[] = {pose_at(3), pose_at(4)};
    EXPECT_THAT([&] { world.set_poses(ids, poses); }, message("body 5"));
    EXPECT_EQ(world.pose(a), Pose{});
    EXPECT_THAT([&] { world.set_poses(ids, {}); }, message("2 bodies and 0 poses"));
    const BodyMotion twice[] = {{a, pose_at(1)}, {a, pose_at(2)}};
    EXPECT_THAT([&] { world.first_contacts(twice); }, message("two motions"));
    EXPECT_EQ(world.size(), 1u);
}

} // namespace
} // namespace boxwood
