#include "bench/machine/environment.h"
#include "bench/stages/scene_player.h"

#include <gtest/gtest.h>

#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace boxwood::bench {
namespace {

/// Memory of this process that is in use now.
long resident_kib() {
    long total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * (sysconf(_SC_PAGESIZE) >> 10);
}

constexpr const char* scene = R"(
queries = ["pairs", "triangle_pairs", {name = "rays", n = 4}, {name = "points", n = 4, kind = "scattered"}]
[[bodies]]
generator = "uniform"
share = 0.5
overlaps = 3
shape = "sphere_mesh"
triangles = 20
margin = 0.01
effects = ["drift", "spin"]
[[bodies]]
generator = "uniform"
share = 0.5
overlaps = 3
shape = "sphere_mesh"
triangles = 20
effects = ["spawn", "despawn", "teleport"]
)";

// The smallest block of malloc takes 32 bytes: one that is lost in each frame is found in 20000
// frames, as in the tests; in 10^6 (scripts/endure frames) one that is lost in 60.
TEST(Endurance, FramesWithoutGrowthOfMemory) {
    constexpr long max_growth_kib = 512, parts = 10;
    const char* wanted = std::getenv("BOXWOOD_FRAMES");
    const long frames = wanted ? std::atol(wanted) : 20'000;
    SceneFile file = parse_scene_file(scene, "endurance.toml");
    file.n = 12;
    ScenePlayer player(MovingScene(file), Extent::required, serial());
    player.start();
    std::size_t answers = player.query().pairs.size();
    long first = 0, last = 0;
    for (long part = 1; part <= parts; ++part) {
        for (long frame = frames * (part - 1) / parts; frame < frames * part / parts; ++frame) {
            player.advance();
            answers += player.query().pairs.size();
        }
        malloc_trim(0);
        last = resident_kib();
        first = part == 1 ? last : first;
        std::printf("endure: frame %ld: %ld KiB resident\n", frames * part / parts, last);
        std::fflush(stdout);
    }
    EXPECT_GT(answers, static_cast<std::size_t>(frames)); // bodies do meet
    if (!sanitizers().empty())
        GTEST_SKIP() << "a sanitizer keeps memory of its own";
    EXPECT_LE(last - first, max_growth_kib);
}

} // namespace
} // namespace boxwood::bench
