#include "scenes/hard_cases/hard_cases.h"

#include "kernels/testing/complaint.h"
#include "scenes/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>
#include <set>

namespace boxwood {
namespace {

using testing::HasSubstr;

/// The numbers of cases: positions and lengths, which `scale` multiplies, and the rest.
struct Numbers {
    std::vector<double> positions, others;

    template <class Real> void position(Vec3<Real> p) {
        for (int axis = 0; axis < 3; ++axis)
            positions.push_back(static_cast<double>(p[axis]));
    }
    template <class Real> void other(Vec3<Real> p) {
        for (int axis = 0; axis < 3; ++axis)
            others.push_back(static_cast<double>(p[axis]));
    }
    template <class Real> void triangle(const Triangle<Real>& t) {
        position(t.a);
        position(t.b);
        position(t.c);
    }
    template <class Real> void box(const Aabb<Real>& b) {
        position(b.min);
        position(b.max);
    }
    void ray(const Ray<float>& r, Known hit) {
        position(r.origin);
        other(r.direction);
        others.push_back(static_cast<double>(hit));
    }

    void operator()(std::monostate) {}
    void operator()(const std::vector<TrianglePairCase>& cases) {
        for (const TrianglePairCase& c : cases) {
            triangle(c.a);
            triangle(c.b);
            others.push_back(static_cast<double>(c.touch));
        }
    }
    void operator()(const RayCases& cases) {
        for (const RayCase& c : cases.rays) {
            for (std::uint32_t i = c.first; i < c.first + c.count; ++i)
                triangle(cases.triangles.at(i));
            ray(c.ray, c.hit);
        }
    }
    void operator()(const std::vector<RayBoxCase>& cases) {
        for (const RayBoxCase& c : cases) {
            box(c.box);
            ray(c.ray, c.hit);
        }
    }
    void operator()(const MotionCases& cases) {
        for (const MotionCase& c : cases.motions) {
            for (const auto* points : {&c.motion.start, &c.motion.end})
                for (const Vec3<double>& p : *points)
                    position(p);
            others.push_back(static_cast<double>(c.touch));
        }
    }
    void operator()(const std::vector<ObbPairCase>& cases) {
        for (const ObbPairCase& c : cases)
            for (const Obb<double>* b : {&c.a, &c.b}) {
                position(b->centre);
                position(b->half);
                for (const Vec3<double>& axis : b->axis)
                    other(axis);
            }
    }
    void operator()(const std::vector<ShapePairCase>& cases) {
        for (const ShapePairCase& c : cases) {
            for (const ShapeOfPair* side : {&c.a, &c.b}) {
                others.push_back(static_cast<double>(side->shape.kind()));
                std::ranges::copy(lengths_of(side->shape), std::back_inserter(positions));
                position(side->pose.translation);
                for (const Vec3<double>& row : side->pose.rotation)
                    other(row);
            }
            positions.insert(positions.end(), {c.lo, c.hi});
        }
    }
    void operator()(const std::vector<FitCase>& cases) {
        for (const FitCase& c : cases) {
            box(c.box);
            position(c.transform.translation);
            for (const Vec3<double>& row : c.transform.rotation)
                other(row);
        }
    }
    void operator()(const BoxCases& cases) {
        for (const Aabb<float>& b : cases.boxes)
            box(b);
    }
};

Numbers numbers_of(const Cases& cases) {
    Numbers numbers;
    std::visit(numbers, cases);
    return numbers;
}

std::vector<HardCaseFamily> generated() {
    std::vector<HardCaseFamily> families;
    std::ranges::copy_if(hard_case_families(), std::back_inserter(families),
                         [](const HardCaseFamily& f) { return !f.reads_file; });
    return families;
}

HardCaseSpec spec_of(std::size_t n, std::uint64_t seed, std::optional<int> k = {}, int scale = 0) {
    return {n, seed, k, scale, {}};
}

/// The least, the default and the greatest k.
std::vector<std::optional<int>> ks_of(const HardCaseFamily& family) {
    if (family.k_meaning.empty())
        return {std::nullopt};
    return {family.k_min, family.k_default, family.k_max};
}

TEST(HardCases, NamesAreWordsOfTheirOwn) {
    std::set<std::string_view> names;
    for (const SceneEntry& scene : scene_generators())
        names.insert(scene.name);
    for (const HardCaseFamily& family : hard_case_families()) {
        SCOPED_TRACE(family.name);
        EXPECT_TRUE(names.insert(family.name).second);
        EXPECT_EQ(family.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"),
                  std::string_view::npos);
        EXPECT_FALSE(family.summary.empty());
        EXPECT_EQ(find_hard_case_family(family.name)->name, family.name);
        EXPECT_LE(family.k_min, family.k_default);
        EXPECT_LE(family.k_default, family.k_max);
        EXPECT_EQ(family.k_meaning.empty(), family.k_min == family.k_max);
        EXPECT_LE(family.scale_min, 0);
        EXPECT_GE(family.scale_max, 0);
    }
    EXPECT_EQ(find_hard_case_family("uniform"), nullptr);
}

TEST(HardCases, ScaleIsAnExactPowerOfTwoOnEveryPosition) {
    for (const HardCaseFamily& family : generated())
        for (const std::optional<int> k : ks_of(family)) {
            SCOPED_TRACE(family.name);
            const Numbers plain = numbers_of(make_cases(family, spec_of(200, 3, k)));
            for (const double x : plain.positions)
                ASSERT_TRUE(std::isfinite(x));
            for (const int scale : {family.scale_min, family.scale_max, -1}) {
                if (scale < family.scale_min)
                    continue;
                const Numbers scaled = numbers_of(make_cases(family, spec_of(200, 3, k, scale)));
                ASSERT_EQ(scaled.positions.size(), plain.positions.size());
                for (std::size_t i = 0; i < plain.positions.size(); ++i) {
                    ASSERT_TRUE(std::isfinite(scaled.positions[i])) << scale;
                    ASSERT_EQ(std::ldexp(scaled.positions[i], -scale), plain.positions[i])
                        << "number " << i << ", k " << k.value_or(0) << ", scale " << scale;
                }
                EXPECT_EQ(scaled.others, plain.others);
            }
        }
}

// So that the kernels of floats get the very same triangles.
TEST(HardCases, FloatsHoldTheLatticeUpToSize15) {
    int families = 0;
    for (const HardCaseFamily& family : generated())
        if (family.k_meaning.find("exact in floats") != std::string_view::npos) {
            ++families;
            for (const double x : numbers_of(make_cases(family, spec_of(500, 4, 15))).positions)
                ASSERT_EQ(static_cast<double>(static_cast<float>(x)), x) << family.name;
        }
    EXPECT_EQ(families, 19);
}

TEST(HardCases, AsManyAsWantedAndEachFromItsNumberAndSeedAlone) {
    for (const HardCaseFamily& family : generated()) {
        SCOPED_TRACE(family.name);
        const Cases few = make_cases(family, spec_of(10, 1)),
                    many = make_cases(family, spec_of(40, 1));
        if (family.name == "identical_boxes") {
            EXPECT_EQ(n_cases(few), 256u);
            continue;
        }
        EXPECT_EQ(n_cases(few), 10u);
        EXPECT_EQ(n_cases(many), 40u);
        if (std::holds_alternative<BoxCases>(few))
            continue;
        const Numbers first = numbers_of(few), all = numbers_of(many);
        EXPECT_TRUE(std::ranges::equal(first.positions,
                                       all.positions | std::views::take(first.positions.size())));
        EXPECT_NE(first.positions, numbers_of(make_cases(family, spec_of(10, 2))).positions);
        if (!family.k_meaning.empty()) {
            const int other = family.k_default == family.k_max ? family.k_min : family.k_max;
            EXPECT_NE(first.positions,
                      numbers_of(make_cases(family, spec_of(10, 1, other))).positions);
        }
    }
}

TEST(HardCases, OrdersOfBoxesAreOrdersOfTheSameBoxes) {
    for (const char* name : {"touching_grid", "flat_boxes", "nested_boxes"}) {
        SCOPED_TRACE(name);
        std::set<std::vector<double>> orders;
        std::set<std::multiset<std::vector<double>>> contents;
        std::set<std::uint64_t> counts;
        for (int k = 0; k < 4; ++k) {
            const Cases cases = make_cases(*find_hard_case_family(name), spec_of(300, 1, k));
            orders.insert(numbers_of(cases).positions);
            std::multiset<std::vector<double>> content;
            for (const Aabb<float>& box : std::get<BoxCases>(cases).boxes) {
                Numbers numbers;
                numbers.box(box);
                content.insert(numbers.positions);
                EXPECT_TRUE(box.is_valid());
            }
            contents.insert(content);
            counts.insert(std::get<BoxCases>(cases).n_pairs);
        }
        // Morton order of the lower corners of nested boxes is the reverse order.
        EXPECT_EQ(orders.size(), std::string_view(name) == "nested_boxes" ? 3u : 4u);
        EXPECT_EQ(contents.size(), 1u);
        EXPECT_EQ(counts.size(), 1u);
    }
}

std::string error_of(const char* family, const HardCaseSpec& spec) {
    return complaint_of([&] { make_cases(*find_hard_case_family(family), spec); });
}

TEST(HardCases, ErrorsNameFamilyParameterAndRange) {
    EXPECT_THAT(error_of("near_coplanar", spec_of(1, 1, 99)),
                HasSubstr("family near_coplanar: k = 99 is not within 1 .. 18 (k: the angle"));
    EXPECT_THAT(error_of("near_coplanar", spec_of(1, 1, 0)), HasSubstr("k = 0"));
    EXPECT_THAT(error_of("edge_on_edge", spec_of(1, 1, 3)), HasSubstr("no parameter k"));
    EXPECT_THAT(error_of("edge_on_edge", spec_of(1, 1, {}, 861)),
                HasSubstr("scale = 861 is not within -860 .. 860"));
    EXPECT_THAT(error_of("edge_on_edge", spec_of(0, 1)), HasSubstr("n is 0"));
    EXPECT_THAT(error_of("nested_boxes", spec_of(8193, 1)), HasSubstr("more than 8192"));
    EXPECT_THAT(error_of("edge_on_edge", {1, 1, {}, 0, "a.csv"}), HasSubstr("reads no file"));
    EXPECT_THAT(error_of("ccd_queries_edge_edge", spec_of(1, 1)), HasSubstr("no file is given"));
}

TEST(HardCases, AFamilyIsAScene) {
    const Scene scene = make_scene({.generator = "near_coplanar", .n = 12, .k = 3, .scale = -40});
    EXPECT_EQ(scene.name, "near_coplanar_k3_scalem40");
    EXPECT_EQ(scene.params_json, R"({"family":"near_coplanar","k":3,"scale":-40})");
    EXPECT_EQ(n_cases(scene.cases), 12u);
    EXPECT_TRUE(scene.boxes.empty());
    EXPECT_EQ(scene_name({.generator = "near_coplanar", .k = 16}), "near_coplanar");
    EXPECT_EQ(scene_name({.generator = "decimal_scale", .k = -30}), "decimal_scale_km30");
    EXPECT_EQ(scene_name({.generator = "edge_on_edge", .scale = 7}), "edge_on_edge_scale7");
    EXPECT_EQ(scene_name({.generator = "ccd_queries_edge_edge", .file = "data/ccd/"}),
              "ccd_queries_edge_edge_ccd");
    EXPECT_EQ(make_scene({.generator = "edge_on_edge", .n = 1}).params_json,
              R"({"family":"edge_on_edge","scale":0})");

    const Scene boxes = make_scene({.generator = "touching_grid", .n = 27});
    EXPECT_EQ(boxes.boxes.size(), 27u);
    EXPECT_EQ(n_cases(boxes.cases), 27u);
    EXPECT_EQ(std::get<BoxCases>(boxes.cases).n_pairs, 158u); // 54 faces, 72 edges, 32 corners
}

TEST(HardCases, SceneErrorsSayWhatIsWrong) {
    const auto error = [](const SceneSpec& spec) -> std::string {
        try {
            make_scene(spec);
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
        return "no error";
    };
    EXPECT_THAT(error({.generator = "near_coplaner"}), HasSubstr("did you mean 'near_coplanar'"));
    EXPECT_THAT(error({.generator = "uniform", .k = 3}), HasSubstr("no parameter k"));
    EXPECT_THAT(error({.generator = "uniform", .scale = 3}), HasSubstr("no parameter scale"));
    EXPECT_THAT(error({.generator = "near_coplanar", .k = 99}), HasSubstr("1 .. 18"));
    EXPECT_THAT(error({.generator = "near_coplanar", .rays = "ambient", .n_rays = 1}),
                HasSubstr("leave rays out"));
    EXPECT_THAT(error({.generator = "near_coplanar", .n = std::size_t{1} << 40}),
                HasSubstr("too large"));
    EXPECT_THROW(scene_name({.generator = "near_coplanar", .k = 99}), std::invalid_argument);
}

// As Scene.SameBitsOnEveryMachine: a change of a family on purpose prints its new hash here.
TEST(HardCases, SameBitsOnEveryMachine) {
    const std::map<std::string, std::uint64_t> golden{
        {"ball_in_ellipsoid", 6353779517629067290u},
        {"box_and_box", 560981867527588112u},
        {"box_and_capsule", 10812146572045182837u},
        {"box_and_cone", 8468405680122119199u},
        {"box_and_cylinder", 17165527371430593000u},
        {"box_and_ellipsoid", 242341118847612579u},
        {"box_and_hull", 16635548634630703016u},
        {"cap_triangles", 13878616234989647358u},
        {"capsule_and_capsule", 14535035755026997788u},
        {"capsule_and_cone", 11795307772895935357u},
        {"capsule_and_cylinder", 4944871887115444645u},
        {"capsule_and_ellipsoid", 11899869138708667271u},
        {"capsule_and_hull", 12825640554184419642u},
        {"cone_and_cone", 18324949739666605144u},
        {"cone_and_ellipsoid", 16377883884486090470u},
        {"cone_and_hull", 15339948121964307577u},
        {"coplanar_disjoint", 13510509543126918338u},
        {"coplanar_edge_edge", 10008211577900645685u},
        {"coplanar_mixed_octaves", 14699075438027275242u},
        {"coplanar_overlapping", 4887585875461964809u},
        {"coplanar_touching", 11949867877598824743u},
        {"coplanar_vertex_face", 17160488662041491236u},
        {"cylinder_and_cone", 1176531238120203093u},
        {"cylinder_and_cylinder", 2164099427229101287u},
        {"cylinder_and_ellipsoid", 5752297048902739077u},
        {"cylinder_and_hull", 17340779470633723255u},
        {"decimal_scale", 1956400356719761115u},
        {"deep_shapes", 9107117981038734770u},
        {"edge_on_edge", 3157825884334223102u},
        {"ellipsoid_and_ellipsoid", 9420075258365754487u},
        {"ellipsoid_and_hull", 11496397947398921611u},
        {"far_from_origin", 16058162688544407031u},
        {"flat_boxes", 7740634830458501541u},
        {"generic_edge_edge", 11031736288075029894u},
        {"generic_obbs", 9094396481956506063u},
        {"generic_ray_boxes", 10886681040143600618u},
        {"generic_rays", 8376017178132525294u},
        {"generic_triangles", 17489183923326692645u},
        {"generic_vertex_face", 15663117579615265513u},
        {"hull_and_hull", 1981575490279053640u},
        {"identical_boxes", 166524248530905804u},
        {"identical_triangles", 16527209336771045065u},
        {"just_missed_edge_edge", 2967329897493303545u},
        {"just_missed_vertex_face", 16208733790047712397u},
        {"kissing_obbs", 15989349627344166478u},
        {"mixed_octaves", 9208019822047256614u},
        {"mixed_scale", 1633140109871199763u},
        {"near_coplanar", 12802253110821112719u},
        {"near_coplanar_needles", 15685909486571881376u},
        {"near_parallel_edges", 16990405377412050793u},
        {"nearly_touching_shapes", 7879919302056588231u},
        {"needle_triangles", 4637809677500503660u},
        {"nested_boxes", 11455204694651997210u},
        {"parallel_planes", 7792759023748694236u},
        {"points_and_duplicates", 14739447872043792707u},
        {"ray_at_exact_limits", 13043602662155776702u},
        {"ray_at_small_triangle", 11719283786879805816u},
        {"ray_box_limits", 13342151799344829598u},
        {"ray_grazing", 1887266763017988345u},
        {"ray_in_far_mesh", 10008816360312439538u},
        {"ray_in_mesh", 14280089815169477378u},
        {"ray_in_plane", 2275906484095796451u},
        {"ray_in_stretched_mesh", 10115283102105447385u},
        {"ray_limits", 11210177938641768968u},
        {"ray_through_edge", 9284143858727831251u},
        {"ray_through_mesh", 3829898785785850445u},
        {"ray_through_vertex", 16507112624556922491u},
        {"rotated_boxes", 16579140992361086362u},
        {"separated_triangles", 14049160957508766538u},
        {"shared_edge", 15317416454657593927u},
        {"shared_vertex", 4846953421792423773u},
        {"signed_zero_directions", 22270008973883616u},
        {"slab_corner_ties", 16022891954423705593u},
        {"slivers", 5678131445294023570u},
        {"small_integers_edge_edge", 13717088538496191479u},
        {"small_integers_vertex_face", 2857316326797031843u},
        {"sphere_and_box", 5468910353127978006u},
        {"sphere_and_capsule", 11873449675748759252u},
        {"sphere_and_cone", 14084559349298191470u},
        {"sphere_and_cylinder", 13798602581551513623u},
        {"sphere_and_ellipsoid", 5225633238239514661u},
        {"sphere_and_hull", 3039108801352942643u},
        {"sphere_and_sphere", 15712133255619017364u},
        {"still_edge_edge", 12215929099683418417u},
        {"still_vertex_face", 11229151140972390038u},
        {"tangential_edge_edge", 10987514743819173695u},
        {"tangential_vertex_face", 5214847704939803020u},
        {"thin_obbs", 12322839706166820342u},
        {"thin_shapes", 11072074642483413987u},
        {"tiny_gaps", 11608074594876576704u},
        {"tiny_triangles", 1115446505896839213u},
        {"touch_at_ends_edge_edge", 17577255713270965494u},
        {"touch_at_ends_vertex_face", 4598375060173480386u},
        {"touching_grid", 3945129846426064690u},
        {"touching_obbs", 14753094336903607072u},
        {"translated_copies", 15475234883056201220u},
        {"vertex_on_face", 17310629619823478778u},
        {"within_one_ulp", 14217011064419124121u},
        {"zero_area_triangles", 7390700823446684044u},
    };
    std::map<std::string, std::uint64_t> made;
    for (const HardCaseFamily& family : generated()) {
        const Scene scene =
            make_scene({.generator = std::string(family.name), .n = 300, .seed = 42});
        made[scene.name] = scene.content_hash;
    }
    for (const auto& [name, hash] : made) {
        const auto known = golden.find(name);
        EXPECT_TRUE(known != golden.end() && known->second == hash)
            << "{\"" << name << "\", " << hash << "u},";
    }
    EXPECT_EQ(made.size(), golden.size());
}

} // namespace
} // namespace boxwood
