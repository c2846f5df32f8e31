#include "scenes/scene.h"

#include "kernels/testing/complaint.h"
#include "scenes/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace boxwood {
namespace {

using testing::HasSubstr;

std::string error_of(const SceneSpec& spec) {
    return complaint_of([&] { make_scene(spec); });
}

// The bits of every generator and kind of rays. A new machine, compiler or flag that changes one is
// a fault of the generator; a change of a generator on purpose prints its new hash here.
TEST(Scene, SameBitsOnEveryMachine) {
    const std::map<std::string, std::uint64_t> golden{
        {"assorted", 764731766707878517u},
        {"bars", 3999564856882404961u},
        {"chain", 736297337708942536u},
        {"cloth", 2159917498632969472u},
        {"cloth_ambient", 1034965786983559224u},
        {"cloth_occlusion", 4386118211743573888u},
        {"cloth_primary", 10245832156969344731u},
        {"cloth_random", 4740478883943402530u},
        {"cloud_in_room", 4470928977717376900u},
        {"clusters", 974975761312145907u},
        {"cubes", 18373738689142504811u},
        {"four_link", 2495750321447697732u},
        {"lattice", 1088174019089689796u},
        {"layer", 7018368754981359716u},
        {"log_normal", 119137152364335574u},
        {"needles", 16002729800118459568u},
        {"planks", 5660410375597526544u},
        {"point_cloud", 8370301100190198716u},
        {"scan_mesh", 1447981543842385729u},
        {"scan_mesh_ambient", 2176309187884952995u},
        {"scan_mesh_occlusion", 16390887021369739895u},
        {"scan_mesh_primary", 12611048603466021644u},
        {"scan_mesh_random", 15712907563534661963u},
        {"smooth_sphere", 13967288048791402112u},
        {"smooth_sphere_ambient", 17618312484751339959u},
        {"smooth_sphere_occlusion", 14565368506508326620u},
        {"smooth_sphere_primary", 15981170114979554259u},
        {"smooth_sphere_random", 5682424104629114468u},
        {"sliver_mesh", 5353869513049790800u},
        {"sliver_mesh_ambient", 2254452493378884098u},
        {"sliver_mesh_occlusion", 7351402160539420174u},
        {"sliver_mesh_primary", 2463420770355925468u},
        {"sliver_mesh_random", 7586625760524014774u},
        {"sphere_mesh", 139517382953043824u},
        {"sphere_mesh_ambient", 5531654917090704846u},
        {"sphere_mesh_occlusion", 13038711654025710886u},
        {"sphere_mesh_primary", 16998939028944365650u},
        {"sphere_mesh_random", 10204977518127464577u},
        {"triangle_soup", 9799473595022501524u},
        {"triangle_soup_ambient", 5670577355492340717u},
        {"triangle_soup_occlusion", 4938860060002708241u},
        {"triangle_soup_primary", 16366296069402606548u},
        {"triangle_soup_random", 5983404588333533559u},
        {"uniform", 3215045118247640018u},
        {"wavy_sheet", 14804950105812692915u},
        {"wavy_sheet_ambient", 6288676372108152067u},
        {"wavy_sheet_occlusion", 17804428502377118909u},
        {"wavy_sheet_primary", 17779758558593899793u},
        {"wavy_sheet_random", 4195869050136188238u},
    };
    std::map<std::string, std::uint64_t> made;
    for (const SceneEntry& entry : scene_generators()) {
        if (entry.reads_file)
            continue;
        std::vector<std::string> rays{""};
        if (entry.has_mesh)
            for (const RayKindEntry& kind : ray_kinds())
                rays.emplace_back(kind.name);
        for (const std::string& kind : rays) {
            const Scene scene = make_scene({.generator = std::string(entry.name),
                                            .n = 777,
                                            .seed = 42,
                                            .rays = kind,
                                            .n_rays = kind.empty() ? 0u : 99u});
            made[scene.name] = scene.content_hash;
        }
    }
    for (const auto& [name, hash] : made) {
        const auto found = golden.find(name);
        EXPECT_TRUE(found != golden.end() && found->second == hash)
            << "{\"" << name << "\", " << hash << "u},";
    }
    EXPECT_EQ(made.size(), golden.size());
}

TEST(Scene, BoxesAreValidAndSeedsDiffer) {
    for (const SceneEntry& entry : scene_generators()) {
        if (entry.reads_file)
            continue;
        SCOPED_TRACE(entry.name);
        std::set<std::uint64_t> hashes;
        for (const std::uint64_t seed : {0u, 1u, 2u})
            for (const std::size_t n : {1u, 2u, 3u, 1000u}) {
                const SceneSpec spec{.generator = std::string(entry.name), .n = n, .seed = seed};
                const Scene scene = make_scene(spec);
                EXPECT_TRUE(std::ranges::all_of(scene.boxes, &Aabb<float>::is_valid));
                EXPECT_EQ(scene.name, scene_name(spec));
                EXPECT_EQ(scene.content_hash, make_scene(spec).content_hash);
                EXPECT_EQ(entry.has_mesh, !scene.mesh.triangles.empty());
                EXPECT_TRUE(scene.params_json.starts_with('{') && scene.params_json.ends_with('}'));
                if (entry.uses_overlaps) {
                    EXPECT_EQ(scene.boxes.size(), n);
                }
                if (n == 1000)
                    hashes.insert(scene.content_hash);
                for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i)
                    ASSERT_EQ(scene.boxes[i], scene.mesh.triangle(i).bounds());
            }
        const bool has_seed = entry.name != "four_link" && entry.name != "chain" &&
                              entry.name != "cloth" && entry.name != "wavy_sheet" &&
                              entry.name != "smooth_sphere";
        EXPECT_EQ(hashes.size(), has_seed ? 3u : 1u);
    }
}

TEST(Scene, ItemsDoNotDependOnHowManyFollow) {
    // The scale does depend on n, so the centres are compared.
    const auto centre = [](const Aabb<float>& box) {
        return 0.5 * (static_cast<Vec3<double>>(box.min) + static_cast<Vec3<double>>(box.max));
    };
    for (const char* generator :
         {"uniform", "clusters", "bars", "planks", "needles", "cloud_in_room", "layer"}) {
        const Scene few = make_scene({.generator = generator, .n = 100});
        const Scene many = make_scene({.generator = generator, .n = 5000});
        for (std::size_t i = 0; i < 100; ++i)
            ASSERT_LT(length(centre(few.boxes[i]) - centre(many.boxes[i])), 1e-6) << generator;
    }
}

TEST(Scene, HashFollowsTheContentNotTheName) {
    const Scene a = make_scene({.generator = "uniform", .n = 10, .overlaps = 5});
    const Scene b = make_scene({.generator = "uniform", .n = 10, .overlaps = 6}); // both the half
    EXPECT_NE(a.name, b.name);
    EXPECT_EQ(a.content_hash, b.content_hash);
}

TEST(Scene, NamesAreAtomsThatTellWhatDiffers) {
    EXPECT_EQ(scene_name({.generator = "uniform"}), "uniform");
    EXPECT_EQ(scene_name({.generator = "uniform", .overlaps = 1}), "uniform_overlaps1");
    EXPECT_EQ(scene_name({.generator = "bars", .overlaps = 0.5}), "bars_overlaps0_5");
    EXPECT_EQ(scene_name({.generator = "bars", .overlaps = 1e-7}), "bars_overlaps0_0000001");
    EXPECT_EQ(scene_name({.generator = "four_link", .overlaps = 1}), "four_link");
    EXPECT_EQ(scene_name({.generator = "sphere_mesh", .rays = "primary"}), "sphere_mesh_primary");
    EXPECT_EQ(scene_name({.generator = "mesh", .rays = "primary", .file = "x/stanford-bunny.obj"}),
              "mesh_stanford_bunny_primary");
    EXPECT_EQ(scene_name({.generator = "mesh", .file = "/a/ -- Größe (2)..STL"}), "mesh_gr_e_2");
    EXPECT_EQ(scene_name({.generator = "mesh", .file = "---.ply"}), "mesh_file");
}

TEST(Scene, ErrorsSayWhatWhereAndHow) {
    EXPECT_THAT(error_of({.generator = "unifrom"}), HasSubstr("did you mean 'uniform'"));
    EXPECT_THAT(error_of({.generator = "sphere_mesh", .rays = "ambeint", .n_rays = 1}),
                HasSubstr("did you mean 'ambient'"));
    EXPECT_THAT(error_of({.generator = "sphere_mesh", .rays = "ambient"}),
                HasSubstr("n_rays is 0"));
    EXPECT_THAT(error_of({.generator = "uniform", .rays = "primary", .n_rays = 1}),
                HasSubstr("no triangles"));
    EXPECT_THAT(error_of({.generator = "sphere_mesh", .n = 0}), HasSubstr("n = 0"));
    EXPECT_THAT(error_of({.generator = "uniform", .n = 0}), HasSubstr("n is 0"));
    EXPECT_THAT(error_of({.generator = "uniform", .n = std::size_t{1} << 40}),
                HasSubstr("too large"));
    EXPECT_THAT(error_of({.generator = "mesh"}), HasSubstr("no file"));
    EXPECT_THAT(error_of({.generator = "uniform", .file = "a.obj"}), HasSubstr("reads no file"));
}

} // namespace
} // namespace boxwood
