#include "bench/stages/scene_player.h"

#include "kernels/primitives/aabb.h"
#include "trees/executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace boxwood::bench {
namespace {

const std::string uniform_bodies = "[[bodies]]\ngenerator = \"uniform\"\n";

SceneFile file_of(const std::string& text, std::size_t n) {
    SceneFile file = parse_scene_file(text, "mine.toml");
    file.n = n;
    return file;
}

/// Played from the start through so many further frames.
std::unique_ptr<ScenePlayer> played(const SceneFile& file, int frames,
                                    Extent extent = Extent::required) {
    auto player = std::make_unique<ScenePlayer>(MovingScene(file), extent, serial());
    player->start();
    player->query();
    for (int frame = 0; frame < frames; ++frame) {
        player->advance();
        player->query();
    }
    return player;
}

void expect_untouched(const LedgerRow& row) {
    EXPECT_EQ(row.calls, 0u) << row.stage;
    EXPECT_EQ(row.items, 0u) << row.stage;
    EXPECT_EQ(row.ns, 0) << row.stage;
    EXPECT_EQ(row.bytes, 0u) << row.stage;
}

TEST(ScenePlayer, AStaticSceneNeverUpdates) {
    SceneFile file = load_scene("still_life");
    file.n = 500;
    const auto player = played(file, 10);
    const Ledger& ledger = player->ledger();
    for (const LedgerRow& row : ledger.rows())
        if (row.stage != "fit" && row.stage != "tree" && row.stage != "pairs")
            expect_untouched(row);
    EXPECT_EQ(ledger.row("fit").calls, 1u);
    EXPECT_EQ(ledger.row("fit").items, 500u);
    EXPECT_EQ(ledger.row("tree").calls, 1u);
    EXPECT_EQ(ledger.row("pairs").items, player->query().pairs.size()); // found once
    EXPECT_GT(player->query().pairs.size(), 100u);
}

// Every effect is compiled in and may be named; on nobody, it costs nothing.
TEST(ScenePlayer, EffectsThatAreNotUsedCostNothing) {
    std::string every = "effects = [";
    for (const EffectEntry& effect : effects())
        every += (every.back() == '[' ? "" : ", ") + std::string("{name = \"") +
                 std::string(effect.name) + "\", share = 0}";
    const auto one = played(file_of(uniform_bodies, 500), 10);
    const auto other = played(file_of(uniform_bodies + every + "]\n", 500), 10);
    const auto &a = one->ledger().rows(), &b = other->ledger().rows();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].is_required, b[i].is_required) << a[i].stage;
        EXPECT_EQ(a[i].calls, b[i].calls) << a[i].stage;
        EXPECT_EQ(a[i].items, b[i].items) << a[i].stage;
        EXPECT_EQ(a[i].bytes, b[i].bytes) << a[i].stage;
    }
    EXPECT_FALSE(one->query().pairs.empty());
    EXPECT_EQ(one->query().pairs, other->query().pairs); // in one order, that of one tree
}

TEST(ScenePlayer, PairsAloneNeverTouchATriangle) {
    SceneFile file = load_scene("tumbling_rocks");
    file.n = 200;
    file.queries = {{.name = "pairs"}};
    const auto player = played(file, 10);
    EXPECT_GT(player->query().pairs.size(), 0u);
    for (const char* stage : {"transform", "mesh_trees", "triangle_pairs", "surface", "box_tree"})
        expect_untouched(player->ledger().row(stage));
}

TEST(ScenePlayer, MeshesThatNeverMeetBuildNoTree) {
    const std::string rock = "[[bodies]]\ngenerator = \"cubes\"\nn = 1\nshape = \"sphere_mesh\"\n"
                             "triangles = 20\neffects = \"spin\"\n";
    const auto player =
        played(file_of("queries = \"triangle_pairs\"\n" + rock + rock + "at = [9, 9, 9]\n", 1), 20);
    EXPECT_EQ(player->ledger().row("transform").items, 0u);
    EXPECT_EQ(player->ledger().row("mesh_trees").items, 0u);
    EXPECT_EQ(player->ledger().row("triangle_pairs").items, 0u);
    EXPECT_TRUE(player->query().pairs.empty()); // no query of them
}

// What must be done follows from which bodies changed and who met whom, counted here by itself.
TEST(ScenePlayer, BodiesAtRestAreNotTransformedFittedOrRefitted) {
    SceneFile file = load_scene("tumbling_rocks");
    file.n = 300;
    file.queries = {{.name = "pairs"}, {.name = "triangle_pairs"}};
    const int frames = 15;
    ScenePlayer player(MovingScene(file), Extent::required, serial());
    MovingScene scene(file);
    std::size_t fitted = scene.bodies().size(), updated = 0, vertices = 0, triangles = 0;
    std::map<std::uint32_t, int> changed_in, made_for;
    player.start();
    for (int frame = 0; frame <= frames; ++frame) {
        if (frame > 0) {
            const auto changed = scene.advance();
            EXPECT_LT(changed.size(), 60u);
            fitted += changed.size();
            updated += changed.size();
            for (const std::uint32_t i : changed)
                changed_in[i] = frame;
            player.advance();
        }
        for (const Pair p : player.query().pairs)
            for (const std::uint32_t i : {p.a, p.b}) {
                const auto [made, is_new] = made_for.try_emplace(i, -1);
                if (made->second == changed_in[i])
                    continue;
                made->second = changed_in[i];
                const TriangleMesh& mesh = scene.bodies().meshes[scene.bodies().mesh[i]];
                vertices += mesh.vertices.size();
                triangles += mesh.triangles.size();
            }
    }
    EXPECT_GT(vertices, 0u);
    const Ledger& ledger = player.ledger();
    EXPECT_EQ(ledger.row("fit").items, fitted);
    EXPECT_EQ(ledger.row("update").items, updated);
    EXPECT_EQ(ledger.row("transform").items, vertices);
    EXPECT_EQ(ledger.row("mesh_trees").items, triangles);
}

// The surface that rays meet is written once, then where bodies have changed: in a tree for all, or
// in one beside that of the bodies at rest. No order pays in so few frames.
TEST(ScenePlayer, TrianglesThatRestAreNotWrittenAgain) {
    for (const std::size_t rays : {10u, 60000u}) {
        SceneFile file = load_scene("tumbling_rocks");
        file.n = 300;
        file.queries = {{.name = "rays", .kind = "scattered", .n = rays}};
        MovingScene scene(file);
        std::size_t all = 0, written = 0;
        for (const std::uint32_t mesh : scene.bodies().mesh)
            all += scene.bodies().meshes[mesh].triangles.size();
        for (int frame = 0; frame < 4; ++frame)
            for (const std::uint32_t i : scene.advance())
                written += scene.bodies().meshes[scene.bodies().mesh[i]].triangles.size();
        EXPECT_LT(written, all);
        const auto player = played(file, 4);
        EXPECT_EQ(player->ledger().row("surface").items, all + written) << rays << " rays";
    }
}

// Those who come and go are, in the frame in which they do.
TEST(ScenePlayer, BodiesThatStayAbsentAreNotFitted) {
    SceneFile file = load_scene("crowd");
    file.n = 400;
    MovingScene scene(file);
    std::size_t fitted = file.n;
    for (int frame = 0; frame < 10; ++frame) {
        const std::vector<std::uint8_t> before = scene.bodies().present;
        for (const std::uint32_t i : scene.advance())
            fitted += before[i] != 0 || scene.bodies().present[i] != 0;
    }
    EXPECT_LT(fitted, 11 * file.n * 2 / 3);
    const auto player = played(file, 10);
    for (const char* stage : {"fit", "box_tree"})
        EXPECT_EQ(player->ledger().row(stage).items, fitted) << stage;
}

TEST(ScenePlayer, NoFilterNamedNoFilterLookedUp) {
    SceneFile file = load_scene("warehouse");
    file.n = 300;
    expect_untouched(played(file, 5)->ledger().row("filter"));
    file.groups[0].neighbours_ignored = true;
    EXPECT_GT(played(file, 5)->ledger().row("filter").items, 0u);
    EXPECT_GT(played(load_scene("four_link_arm"), 5)->ledger().row("filter").items, 0u);
}

TEST(ScenePlayer, NothingDeformsNoVertexIsTouched) {
    const SceneFile file = file_of(uniform_bodies + "effects = [\"deform\", \"drift\"]\n", 100);
    const auto player = played(file, 5);
    expect_untouched(player->ledger().row("advance_deform"));
    expect_untouched(player->ledger().row("transform"));
    EXPECT_EQ(player->ledger().row("advance_drift").items, 500u);
}

TEST(ScenePlayer, RestedFramesFindNothingAnew) {
    SceneFile file = file_of(uniform_bodies + "effects = \"gravity\"\n", 100);
    const auto player = played(file, 1500); // all of it lies on the floor
    const std::uint64_t found = player->ledger().row("pairs").items;
    const std::vector<Pair> pairs = player->query().pairs;
    player->advance();
    EXPECT_EQ(player->query().pairs, pairs);
    EXPECT_EQ(player->ledger().row("pairs").items, found);
    EXPECT_FALSE(pairs.empty());
}

TEST(ScenePlayer, StartsAgain) {
    SceneFile file = load_scene("tumbling_rocks");
    file.n = 200;
    ScenePlayer player(MovingScene(file, {}, true), Extent::required, serial());
    const auto play = [&] {
        std::vector<std::uint64_t> hashes;
        player.start();
        for (int frame = 0; frame < 10; ++frame) {
            hashes.push_back(answers_hash(player.query()));
            player.advance();
        }
        return hashes;
    };
    const auto first = play();
    const LedgerRow pairs = player.ledger().row("pairs");
    EXPECT_EQ(play(), first);
    EXPECT_EQ(player.ledger().row("pairs").calls, pairs.calls);
    EXPECT_EQ(player.ledger().row("pairs").items, pairs.items);
    ScenePlayer once(MovingScene(file), Extent::required, serial());
    once.start();
    once.advance();
    EXPECT_THROW(once.start(), std::logic_error);
}

TEST(ScenePlayer, FramesMayGoWithoutAQuery) {
    SceneFile file = load_scene("tumbling_rocks");
    file.n = 200;
    file.queries.push_back({.name = "rays", .kind = "scattered", .n = 100});
    ScenePlayer player(MovingScene(file), Extent::required, serial());
    player.start();
    for (const int frames : {0, 3, 4}) { // the first is queried, and then a few
        for (int frame = 0; frame < frames; ++frame)
            player.advance();
        player.query();
    }
    EXPECT_EQ(answers_hash(player.answers()), answers_hash(played(file, 7)->answers()));
    EXPECT_FALSE(player.answers().triangle_pairs.empty());
    EXPECT_FALSE(player.answers().rays.empty());
}

} // namespace
} // namespace boxwood::bench
