#include "scenes/moving/moving_scene.h"

#include "kernels/boxes/fit.h"
#include "kernels/testing/complaint.h"
#include "scenes/robots/four_link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <map>
#include <set>

namespace boxwood {
namespace {

using testing::HasSubstr;

std::vector<Aabb<float>> boxes_of(const Bodies& bodies) {
    std::vector<Aabb<float>> boxes(bodies.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        boxes[i] = fitted_box(bodies, i);
    return boxes;
}

std::uint64_t hash_of(const std::vector<Aabb<float>>& boxes) {
    return XXH3_64bits(boxes.data(), boxes.size() * sizeof(boxes[0]));
}

MovingScene scene_of(const std::string& bodies, std::size_t n = 500) {
    return MovingScene(
        parse_scene_file("[[bodies]]\ngenerator = \"uniform\"\n" + bodies, "test.toml"), n);
}

// A change of an effect or of a scene on purpose prints its new hash here.
TEST(MovingScene, SameBitsOnEveryMachine) {
    const std::map<std::string, std::uint64_t> golden{
        {"arm_in_clutter", 9700967038719346885u},
        {"broadmark_brownian", 14370348206002602028u},
        {"broadmark_brownian_assorted", 15492296474262005164u},
        {"broadmark_free_fall", 7877404418472026855u},
        {"broadmark_free_fall_assorted", 10190602960508659385u},
        {"broadmark_gravity", 4762088257581116873u},
        {"broadmark_gravity_assorted", 12404455036538452007u},
        {"carousel", 7018824462925320136u},
        {"cloth_on_sphere", 7194247173963055679u},
        {"crowd", 9108712809485576929u},
        {"drone_swarm", 16672872951863974898u},
        {"fly_through", 2285026484788174835u},
        {"four_link_arm", 11566619400684287410u},
        {"popcorn", 7979897268764288550u},
        {"rubble", 868987502972552907u},
        {"still_life", 2285026484788174835u},
        {"tumbling_rocks", 15901392205163723007u},
        {"warehouse", 16480614128109678713u},
    };
    std::map<std::string, std::uint64_t> made;
    for (const BuiltInScene& scene : built_in_scenes()) {
        MovingScene played(load_scene(std::string(scene.name)), 777);
        for (int frame = 0; frame < 20; ++frame)
            played.advance();
        made[std::string(scene.name)] = hash_of(boxes_of(played.bodies()));
    }
    EXPECT_EQ(made, golden);
}

TEST(MovingScene, ListsEveryBodyWhoseBoxIsAnother) {
    for (const BuiltInScene& scene : built_in_scenes()) {
        SCOPED_TRACE(scene.name);
        MovingScene played(load_scene(std::string(scene.name)), 300);
        EXPECT_FALSE(played.file().summary.empty());
        EXPECT_FALSE(played.file().source.empty());
        EXPECT_EQ(played.file().licence, "Apache-2.0");
        std::vector<Aabb<float>> before = boxes_of(played.bodies());
        for (int frame = 0; frame < 30; ++frame) {
            const auto changed = played.advance();
            EXPECT_TRUE(std::ranges::is_sorted(changed));
            const std::vector<Aabb<float>> now = boxes_of(played.bodies());
            for (std::uint32_t i = 0; i < now.size(); ++i) {
                if (!std::ranges::binary_search(changed, i)) {
                    ASSERT_EQ(now[i], before[i]) << "frame " << frame << " body " << i;
                }
                ASSERT_TRUE(played.bodies().present[i] ? now[i].is_valid() : now[i].is_empty());
            }
            before = now;
        }
    }
}

TEST(Changed, IsListedOnceInOrder) {
    for (const std::uint32_t step : {1u, 7u, 97u}) { // many, and few
        Changed changed(1000);
        for (int pass = 0; pass < 2; ++pass) {
            std::set<std::uint32_t> expected;
            for (std::uint32_t i = 0; i < 1000; i += step)
                for (int twice = 0; twice < 2; ++twice) {
                    changed.add(999 - i);
                    expected.insert(999 - i);
                }
            changed.sort();
            EXPECT_TRUE(std::ranges::equal(changed.bodies(), expected));
            changed.clear();
            EXPECT_TRUE(changed.bodies().empty());
        }
    }
}

TEST(MovingScene, EffectsChangeOnlyWhatTheySay) {
    for (const EffectEntry& effect : effects()) {
        SCOPED_TRACE(effect.name);
        MovingScene played = scene_of("shape = \"sphere_mesh\"\ntriangles = 20\neffects = \"" +
                                          std::string(effect.name) + "\"\n",
                                      100);
        const Bodies before = played.bodies();
        bool is_seen = false;
        for (int frame = 0; frame < 40; ++frame) {
            is_seen |= !played.advance().empty();
            ASSERT_EQ(played.changes(), effect.changes);
        }
        EXPECT_TRUE(is_seen);
        const Bodies& after = played.bodies();
        EXPECT_EQ(after.present != before.present, effect.changes.presence);
        bool place = false, rotation = false, shape = false;
        for (std::size_t i = 0; i < before.size(); ++i) {
            place |= !(after.pose[i].translation == before.pose[i].translation);
            rotation |= after.pose[i].rotation != before.pose[i].rotation;
            shape |= after.meshes[after.mesh[i]].vertices != before.meshes[before.mesh[i]].vertices;
        }
        EXPECT_EQ(place, effect.changes.position || effect.changes.velocity);
        EXPECT_EQ(rotation, effect.changes.rotation);
        EXPECT_EQ(shape, effect.changes.shape);
    }
}

TEST(MovingScene, ShareLaysAnEffectOnSome) {
    MovingScene played = scene_of("effects = {name = \"drift\", share = 0.1}\n", 5000);
    const std::size_t moved = played.advance().size();
    EXPECT_GT(moved, 400u);
    EXPECT_LT(moved, 600u);
    for (int frame = 0; frame < 5; ++frame)
        EXPECT_EQ(played.advance().size(), moved); // the same ones
}

TEST(MovingScene, StaysInItsRoom) {
    for (const char* effect : {"drift", "brownian", "swarm", "gravity", "teleport"}) {
        MovingScene played = scene_of(std::string("effects = \"") + effect + "\"\n");
        for (int frame = 0; frame < 300; ++frame)
            played.advance();
        for (const auto& pose : played.bodies().pose)
            ASSERT_TRUE(played.bodies().bounds.contains(pose.translation)) << effect;
    }
}

TEST(MovingScene, RubbleComesToRest) {
    MovingScene played(load_scene("rubble"), 300);
    std::size_t last = 0;
    for (int frame = 0; frame < 1500; ++frame)
        last = played.advance().size();
    MovingScene still = scene_of("effects = \"gravity\"\n", 300);
    for (int frame = 0; frame < 1500; ++frame)
        still.advance();
    EXPECT_TRUE(still.advance().empty());
    EXPECT_GT(last, 0u); // a fifth of the rubble goes on spinning
    EXPECT_LT(last, 100u);
}

TEST(MovingScene, SpinKeepsRotationsOrthonormal) {
    MovingScene played = scene_of("effects = \"spin\"\n", 20);
    for (int frame = 0; frame < 100'000; ++frame)
        played.advance();
    for (const auto& pose : played.bodies().pose)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = i; j < 3; ++j)
                ASSERT_NEAR(dot(pose.rotation[i], pose.rotation[j]), i == j ? 1 : 0, 1e-15);
}

TEST(MovingScene, OrbitKeepsItsDistance) {
    MovingScene played = scene_of("effects = \"orbit\"\n", 20);
    const Aabb<double> bounds = played.bodies().bounds;
    const Vec3<double> middle = .5 * (bounds.min + bounds.max);
    std::vector<double> before;
    for (const auto& pose : played.bodies().pose)
        before.push_back(length(pose.translation - middle));
    for (int frame = 0; frame < 100'000; ++frame)
        played.advance();
    for (std::size_t i = 0; i < before.size(); ++i)
        ASSERT_NEAR(length(played.bodies().pose[i].translation - middle), before[i], 1e-10);
}

TEST(MovingScene, JointsHoldTheirLinks) {
    MovingScene played(load_scene("arm_in_clutter"), 10);
    ASSERT_EQ(played.ignored().size(), 1u);
    EXPECT_TRUE(played.is_ignored(30, 31));
    EXPECT_FALSE(played.is_ignored(29, 31)); // no neighbours
    EXPECT_FALSE(played.is_ignored(31, 32)); // one of the clutter
    for (int frame = 0; frame < 200; ++frame) {
        played.advance();
        const Bodies& bodies = played.bodies();
        for (std::uint32_t k = 0; k + 1 < 32; ++k) {
            // the joint is a quarter of the scale behind one origin and before the next
            const Vec3<double> from_first = bodies.pose[k](Vec3<double>{.02, 0, 0});
            const Vec3<double> from_next = bodies.pose[k + 1](Vec3<double>{-.02, 0, 0});
            ASSERT_LT(length(from_first - from_next), 1e-6);
        }
    }
}

// The demo's own kinematics, with sines and cosines, are the oracle.
TEST(MovingScene, FourLinkArmTurnsAsTheDemoDoes) {
    MovingScene played(load_scene("four_link_arm"), 4);
    for (int frame = 0; frame < 50; ++frame) {
        played.advance();
        const Bodies& bodies = played.bodies();
        const auto turn = [&](std::size_t i) {
            return std::atan2(bodies.pose[i].rotation[1].x, bodies.pose[i].rotation[0].x);
        };
        const auto expected =
            four_link_boxes({turn(1) - turn(0), turn(2) - turn(1), turn(3) - turn(2)});
        for (std::uint32_t i = 0; i < 4; ++i) {
            const Aabb<float> box = fitted_box(bodies, i);
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_NEAR(box.min[axis], expected[i].min[axis], 1e-6);
                ASSERT_NEAR(box.max[axis], expected[i].max[axis], 1e-6);
            }
        }
    }
}

TEST(MovingScene, BoxesHoldTheirMeshes) {
    for (const char* effect : {"spin", "deform", "joint_motion"}) {
        MovingScene played = scene_of("shape = \"sphere_mesh\"\ntriangles = 60\neffects = \"" +
                                          std::string(effect) + "\"\n",
                                      50);
        for (int frame = 0; frame < 20; ++frame)
            played.advance();
        const Bodies& bodies = played.bodies();
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            const Aabb<float> box = fitted_box(bodies, i);
            for (const Vec3<float>& v : bodies.meshes[bodies.mesh[i]].vertices) {
                const Vec3<double> p = bodies.pose[i](static_cast<Vec3<double>>(v));
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_GE(p[axis], static_cast<double>(box.min[axis]) - 1e-12) << effect;
                    ASSERT_LE(p[axis], static_cast<double>(box.max[axis]) + 1e-12) << effect;
                }
            }
        }
    }
}

TEST(MovingScene, BodiesOfOneSizeShareAMesh) {
    MovingScene played(
        parse_scene_file("[[bodies]]\ngenerator = \"cubes\"\nshape = \"sphere_mesh\"\n"
                         "triangles = 100\n",
                         "test.toml"),
        50);
    EXPECT_LT(played.bodies().meshes.size(), 10u); // unit cubes, but for the last bits of floats
    EXPECT_EQ(played.changes(), Changes{});
    EXPECT_TRUE(played.advance().empty());
}

// The mesh of a body fills the box that the generator gave it.
TEST(MovingScene, ShapesKeepTheSizeOfTheirBoxes) {
    const MovingScene boxes = scene_of("", 50);
    const MovingScene shapes = scene_of("shape = \"sphere_mesh\"\ntriangles = 20\n", 50);
    for (std::uint32_t i = 0; i < 50; ++i) {
        const Aabb<float> a = fitted_box(boxes.bodies(), i), b = fitted_box(shapes.bodies(), i);
        for (int axis = 0; axis < 3; ++axis) {
            const float side = a.max[axis] - a.min[axis];
            EXPECT_NEAR(b.max[axis] - b.min[axis], side, 1e-3 * static_cast<double>(side));
            EXPECT_NEAR(b.min[axis], a.min[axis], 1e-3 * static_cast<double>(side));
        }
    }
}

std::string complaint(const std::string& text) {
    return complaint_of([&] { MovingScene(parse_scene_file(text, "mine.toml")); });
}

TEST(SceneFile, BadOnesAreRefusedWithTheirPlace) {
    const std::string uniform = "[[bodies]]\ngenerator = \"uniform\"\n";
    EXPECT_THAT(complaint(""), HasSubstr("mine.toml: no [[bodies]] block"));
    EXPECT_THAT(complaint("n = = 3"), HasSubstr("mine.toml:1: not TOML"));
    EXPECT_THAT(complaint("frmes = 3\n" + uniform), HasSubstr("did you mean 'frames'?"));
    EXPECT_THAT(complaint("n = 0\n" + uniform), HasSubstr("mine.toml:1: n = 0 is out of range"));
    EXPECT_THAT(complaint("n = 1e3\n" + uniform), HasSubstr("n must be a whole number"));
    EXPECT_THAT(complaint("[[bodies]]\n"), HasSubstr("mine.toml:1: [[bodies]] needs a generator"));
    EXPECT_THAT(complaint("[[bodies]]\ngenerator = \"unifrom\"\n"),
                HasSubstr("mine.toml:2: generator: unknown name 'unifrom'; did you mean"));
    EXPECT_THAT(complaint(uniform + "effects = \"drfit\"\n"), HasSubstr("did you mean 'drift'?"));
    EXPECT_THAT(complaint(uniform + "effects = {name = \"drift\", sped = 1}\n"),
                HasSubstr("mine.toml:3: 'drift' has no setting 'sped'; it has speed"));
    EXPECT_THAT(complaint(uniform + "effects = {name = \"drift\", speed = -1}\n"),
                HasSubstr("must be a number from"));
    EXPECT_THAT(complaint(uniform + "effects = {name = \"drift\", speed = nan}\n"),
                HasSubstr("out of range"));
    EXPECT_THAT(complaint(uniform + "effects = {share = 1}\n"), HasSubstr("an effect is a name"));
    EXPECT_THAT(complaint(uniform + "effects = {name = \"drift\", share = 2}\n"),
                HasSubstr("share = 2 is out of range"));
    EXPECT_THAT(complaint(uniform + "n = 3\nshare = 0.5\n"), HasSubstr("not both"));
    EXPECT_THAT(complaint(uniform + "shape = \"sphere_mesh\"\n"), HasSubstr("needs triangles"));
    EXPECT_THAT(complaint(uniform + "triangles = 3\n"), HasSubstr("triangles is for a shape"));
    EXPECT_THAT(complaint(uniform + "at = [0, 1]\n"), HasSubstr("three numbers"));
    EXPECT_THAT(complaint(uniform + "share = 0.0001\n"), HasSubstr("leave no body"));
    EXPECT_THAT(complaint("bodies = 3\n"), HasSubstr("no [[bodies]] block"));
}

TEST(SceneFile, LoadsByNameOrPath) {
    EXPECT_EQ(load_scene("warehouse").name, "warehouse");
    EXPECT_EQ(load_scene("scenes/built_in/warehouse.toml").groups.size(), 2u);
    EXPECT_THROW(load_scene("warehose"), std::invalid_argument);
    EXPECT_THROW(load_scene("no/such.toml"), std::runtime_error);
}

TEST(Effect, WaveIsSmoothAndBounded) {
    EXPECT_EQ(wave(0), 0);
    EXPECT_EQ(wave(1), 1);
    EXPECT_EQ(wave(2), 0);
    EXPECT_EQ(wave(3), -1);
    EXPECT_EQ(wave(-1), -1);
    EXPECT_EQ(wave(5), 1);
    for (double x = -5; x < 5; x += 1e-3) {
        EXPECT_LE(std::abs(wave(x)), 1);
        EXPECT_NEAR(wave(x + 1e-3), wave(x), 2.1e-3);
    }
}

} // namespace
} // namespace boxwood
