/// What Embree is really called with: its functions that trace rays and set up scenes are taken
/// down here on their way to the library.

#include <gtest/gtest.h>

#if !defined(BOXWOOD_EMBREE_3)

TEST(EmbreesCalls, AreTakenDownOfVersion3) {
    GTEST_SKIP() << "no Embree 3 here: install libembree-dev, and leave BOXWOOD_EMBREE empty";
}

#else

#include "bench/peers/ray_lanes.h"
#include "bench/tasks/task.h"
#include "scenes/scene.h"

#include <dlfcn.h>
#include <embree3/rtcore.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace {

struct Calls {
    std::map<std::string, int> functions;
    std::set<RTCIntersectContextFlags> flags;
    std::set<RTCBuildQuality> qualities;
    std::set<RTCSceneFlags> scene_flags;
    std::size_t lanes = 0, lanes_with_rays = 0;
    unsigned longest_stream = 0;
    std::string device;
};
Calls calls;

template <class Function> Function* of_embree(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void take_down(const char* function, const RTCIntersectContext* context) {
    ++calls.functions[function];
    calls.flags.insert(context->flags);
}
void take_down_lanes(const int* valid, std::size_t width) {
    calls.lanes += width;
    calls.lanes_with_rays += static_cast<std::size_t>(std::count(valid, valid + width, -1));
}
void take_down_stream(unsigned n) { calls.longest_stream = std::max(calls.longest_stream, n); }

} // namespace

extern "C" {

#define BOXWOOD_ONE(name, Ray)                                                                     \
    void name(RTCScene scene, RTCIntersectContext* context, Ray* ray) {                            \
        take_down(#name, context);                                                                 \
        of_embree<decltype(name)>(#name)(scene, context, ray);                                     \
    }
#define BOXWOOD_PACKET(name, width, Ray)                                                           \
    void name(const int* valid, RTCScene scene, RTCIntersectContext* context, Ray* ray) {          \
        take_down(#name, context);                                                                 \
        take_down_lanes(valid, width);                                                             \
        of_embree<decltype(name)>(#name)(valid, scene, context, ray);                              \
    }
#define BOXWOOD_STREAM_1M(name, Ray)                                                               \
    void name(RTCScene scene, RTCIntersectContext* context, Ray* rays, unsigned n,                 \
              std::size_t stride) {                                                                \
        take_down(#name, context);                                                                 \
        take_down_stream(n);                                                                       \
        of_embree<decltype(name)>(#name)(scene, context, rays, n, stride);                         \
    }
#define BOXWOOD_STREAM_NP(name, Rays)                                                              \
    void name(RTCScene scene, RTCIntersectContext* context, const Rays* rays, unsigned n) {        \
        take_down(#name, context);                                                                 \
        take_down_stream(n);                                                                       \
        of_embree<decltype(name)>(#name)(scene, context, rays, n);                                 \
    }
BOXWOOD_ONE(rtcIntersect1, RTCRayHit)
BOXWOOD_ONE(rtcOccluded1, RTCRay)
BOXWOOD_PACKET(rtcIntersect8, 8, RTCRayHit8)
BOXWOOD_PACKET(rtcOccluded8, 8, RTCRay8)
BOXWOOD_PACKET(rtcIntersect16, 16, RTCRayHit16)
BOXWOOD_PACKET(rtcOccluded16, 16, RTCRay16)
BOXWOOD_STREAM_1M(rtcIntersect1M, RTCRayHit)
BOXWOOD_STREAM_1M(rtcOccluded1M, RTCRay)
BOXWOOD_STREAM_NP(rtcIntersectNp, RTCRayHitNp)
BOXWOOD_STREAM_NP(rtcOccludedNp, RTCRayNp)

RTCDevice rtcNewDevice(const char* settings) {
    calls.device = settings;
    return of_embree<decltype(rtcNewDevice)>("rtcNewDevice")(settings);
}
void rtcSetSceneBuildQuality(RTCScene scene, RTCBuildQuality quality) {
    calls.qualities.insert(quality);
    of_embree<decltype(rtcSetSceneBuildQuality)>("rtcSetSceneBuildQuality")(scene, quality);
}
void rtcSetSceneFlags(RTCScene scene, RTCSceneFlags flags) {
    calls.scene_flags.insert(flags);
    of_embree<decltype(rtcSetSceneFlags)>("rtcSetSceneFlags")(scene, flags);
}

} // extern "C"

namespace boxwood::bench {
namespace {

using testing::ElementsAre;

bool says(const ContenderEntry& entry, const std::string& word) {
    return (entry.name + ".").find("." + word + ".") != std::string::npos;
}
RTCBuildQuality quality_in_name(const ContenderEntry& entry, RTCBuildQuality otherwise) {
    return says(entry, "low")      ? RTC_BUILD_QUALITY_LOW
           : says(entry, "medium") ? RTC_BUILD_QUALITY_MEDIUM
           : says(entry, "high")   ? RTC_BUILD_QUALITY_HIGH
                                   : otherwise;
}
/// "rtcIntersect_np" of "embree.rtc_intersect_np.tiles", but as Embree writes it.
std::string function_in_name(const ContenderEntry& entry) {
    const std::string word = entry.name.substr(11, entry.name.find('.', 11) - 11);
    static const std::map<std::string, std::string> ends{
        {"1", "1"}, {"8", "8"}, {"16", "16"}, {"1m", "1M"}, {"_np", "Np"}};
    const bool any = word.starts_with("occluded");
    const std::string end = word.substr(std::string(any ? "occluded" : "intersect").size());
    return (any ? "rtcOccluded" : "rtcIntersect") + ends.at(end);
}

/// f(entry, answers) for each of Embree's contenders of a task, after one build and query.
template <class F>
std::size_t for_each_contender(const Scene& scene, const char* task_name, const F& f) {
    const Task& task = *find_task(task_name);
    std::size_t n = 0;
    for (const ContenderEntry& entry : peers_that_answer(task_name)) {
        const Job job{&scene, &task};
        if (entry.library != "embree" || entry.unsupported(job))
            continue;
        SCOPED_TRACE(entry.name);
        const auto contender = entry.make(job);
        const auto answers = task.make_answers();
        calls = {};
        contender->build();
        contender->query(*answers);
        f(entry, *answers);
        ++n;
    }
    return n;
}

Scene picture(std::size_t n_rays, const char* kind = "primary") {
    return make_scene({.generator = "sphere_mesh", .n = 500, .rays = kind, .n_rays = n_rays});
}

TEST(EmbreesCalls, AreThoseThatTheNamesOfRaysSay) {
    const Scene scene = picture(1003); // a picture 32 wide, the last row in part
    for (const char* task : {"rays_closest", "rays_any", "rays_all"}) {
        const std::size_t n =
            for_each_contender(scene, task, [&](const ContenderEntry& entry, const Answers&) {
                EXPECT_THAT(calls.qualities,
                            ElementsAre(quality_in_name(entry, RTC_BUILD_QUALITY_MEDIUM)));
                EXPECT_THAT(calls.scene_flags,
                            ElementsAre(says(entry, "robust") ? RTC_SCENE_FLAG_ROBUST
                                                              : RTC_SCENE_FLAG_NONE));
                EXPECT_THAT(calls.flags, ElementsAre(says(entry, "coherent")
                                                         ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                         : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT));
                ASSERT_EQ(calls.functions.size(), 1u);
                const auto& [function, times] = *calls.functions.begin();
                EXPECT_EQ(function, function_in_name(entry));
                if (function.ends_with('8') || function.ends_with('6')) {
                    EXPECT_EQ(calls.lanes_with_rays, 1003u);
                    EXPECT_EQ(calls.lanes, says(entry, "tiles") ? 1024u : 1008u);
                } else if (function.ends_with('1')) {
                    EXPECT_EQ(times, 1003);
                } else {
                    EXPECT_EQ(times, 4);
                    EXPECT_EQ(calls.longest_stream, 256u);
                }
            });
        // Qualities and robust, of batches also flag and tiles.
        EXPECT_EQ(n, task == std::string("rays_all") ? 12u : 6u + 4 * 6 * 4) << task;
    }
}

TEST(EmbreesCalls, BuildPointsAndPairsWithTheQualityOfTheName) {
    Scene scene = picture(0, "");
    scene.points.assign(3, {0.5f, 0.5f, 0.5f});
    scene.spheres.assign(3, {{0.5f, 0.5f, 0.5f}, 0.1f});
    scene.spec.k = 2;
    const auto check = [](const ContenderEntry& entry, const Answers&) {
        EXPECT_THAT(calls.qualities, ElementsAre(quality_in_name(entry, RTC_BUILD_QUALITY_HIGH)));
    };
    for (const char* task : {"points", "regions", "nearest", "closest_points", "pairs"})
        EXPECT_EQ(for_each_contender(scene, task, check), task == std::string("pairs") ? 3u : 6u)
            << task; // of points also those along a curve
}

TEST(EmbreesCalls, HoldTheDeviceToTheInstructionSetOfTheJob) {
    const Scene scene = picture(16);
    const std::map<std::string, std::string> settings{
        {"", ""}, {"baseline", ",isa=sse4.2"}, {"avx2", ",isa=avx2"}, {"avx512", ",isa=avx512"}};
    for (const auto& [isa, setting] : settings) {
        const Job job{&scene, find_task("rays_closest"), "serial", 1, isa};
        for (const ContenderEntry& entry : peers_that_answer("rays_closest"))
            if (entry.name == "embree.rtc_intersect1" && !entry.unsupported(job)) {
                entry.make(job);
                EXPECT_EQ(calls.device, "threads=1,set_affinity=0" + setting);
            }
    }
}

TEST(EmbreesTiles, AnswerInTheOrderOfTheRays) {
    for (const std::size_t n : {1u, 7u, 64u, 1003u, 1024u, 1025u}) {
        const Scene scene = picture(n);
        for (const char* task : {"rays_closest", "rays_any"}) {
            std::map<std::string, std::vector<RayHit>> in_order;
            std::size_t compared = 0;
            for_each_contender(scene, task,
                               [&](const ContenderEntry& entry, const Answers& answers) {
                                   const std::vector<RayHit>& hits = list_of<RayHit>(answers);
                                   ASSERT_EQ(hits.size(), n);
                                   const std::size_t at = entry.name.find(".tiles");
                                   if (at == std::string::npos) {
                                       in_order[entry.name] = hits;
                                       return;
                                   }
                                   std::string other = entry.name;
                                   other.erase(at, std::string(".tiles").size());
                                   ASSERT_TRUE(in_order.contains(other));
                                   for (std::size_t i = 0; i < n; ++i)
                                       EXPECT_EQ(hits[i].hit(), in_order[other][i].hit()) << i;
                                   ++compared;
                               });
            EXPECT_EQ(compared, 48u) << task;
        }
    }
}

TEST(EmbreesTiles, AreLeftToRaysThatAreAPicture) {
    const Scene scene = picture(100, "random");
    const std::size_t n =
        for_each_contender(scene, "rays_closest", [](const ContenderEntry& entry, const Answers&) {
            EXPECT_FALSE(says(entry, "tiles"));
        });
    EXPECT_EQ(n, 6u + 4 * 3 * 4);
}

TEST(RayLanes, HoldEachRayOnceInItsTile) {
    for (const std::size_t width : {8u, 16u})
        for (const std::size_t picture_width : {1u, 3u, 4u, 32u, 33u})
            for (const std::size_t n : {1u, 31u, 1003u, 1024u}) {
                const auto lanes = lanes_in_tiles(n, picture_width, width);
                ASSERT_EQ(lanes.size() % width, 0u);
                std::set<std::uint32_t> seen;
                std::set<std::pair<std::size_t, std::size_t>> tiles;
                for (std::size_t packet = 0; packet < lanes.size(); packet += width) {
                    std::set<std::pair<std::size_t, std::size_t>> here;
                    for (std::size_t k = packet; k < packet + width; ++k)
                        if (const std::size_t ray = lanes[k]; ray != no_ray) {
                            EXPECT_LT(ray, n);
                            EXPECT_TRUE(seen.insert(lanes[k]).second) << ray;
                            here.insert(
                                {ray % picture_width / 4, ray / picture_width / (width / 4)});
                        }
                    EXPECT_LE(here.size(), 1u);
                    for (const auto& tile : here)
                        EXPECT_TRUE(tiles.insert(tile).second);
                }
                EXPECT_EQ(seen.size(), n);
            }
    EXPECT_EQ(lanes_in_tiles(24, 6, 8),
              (std::vector<std::uint32_t>{
                  0,  1,  2,  3,  6,  7,  8,  9,  4,  5,  no_ray, no_ray, 10, 11, no_ray, no_ray,
                  12, 13, 14, 15, 18, 19, 20, 21, 16, 17, no_ray, no_ray, 22, 23, no_ray, no_ray}));
    const auto in_order = lanes_in_order(9, 8);
    EXPECT_EQ(in_order.size(), 16u);
    EXPECT_EQ(in_order[8], 8u);
    EXPECT_EQ(in_order[9], no_ray);
}

} // namespace
} // namespace boxwood::bench

#endif
