/// What a scene queries, answered by its plan, against all stages and against brute force.

#include "bench/stages/body_surface.h"
#include "bench/stages/scene_player.h"
#include "bench/truth/ray_truth.h"
#include "kernels/oracle/exact_answers.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

FrameAnswers sorted(FrameAnswers answers) {
    std::ranges::sort(answers.pairs);
    std::ranges::sort(answers.triangle_pairs);
    std::ranges::sort(answers.points);
    std::ranges::sort(answers.regions);
    return answers;
}

void expect_same(const FrameAnswers& a, const FrameAnswers& b) {
    EXPECT_EQ(a.pairs, b.pairs);
    EXPECT_EQ(a.triangle_pairs, b.triangle_pairs);
    EXPECT_EQ(a.rays, b.rays);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.regions, b.regions);
    EXPECT_EQ(a.nearest, b.nearest);
}

SceneFile built_in(std::string_view name, std::size_t n) {
    SceneFile file = load_scene(std::string(name));
    file.n = n;
    return file;
}

/// With all queries that there are.
SceneFile with_all_queries(SceneFile file) {
    file.queries.clear();
    for (const SceneQueryEntry& entry : scene_queries()) {
        file.queries.push_back(entry.defaults);
        file.queries.back().name = entry.name;
        file.queries.back().n = std::min<std::size_t>(entry.defaults.n, 60);
        if (entry.name == "points")
            file.queries.back().kind = "scattered";
    }
    return file;
}

TEST(Answers, AllStagesGiveTheSameFrameByFrame) {
    for (const BuiltInScene& entry : built_in_scenes())
        for (const bool all : {false, true}) {
            SCOPED_TRACE(std::string(entry.name) + (all ? ", all queries" : ""));
            SceneFile file = built_in(entry.name, 150);
            if (all)
                file = with_all_queries(file);
            ScenePlayer some(MovingScene(file), Extent::required, serial());
            ScenePlayer full(MovingScene(file), Extent::all_stages, serial());
            some.start();
            full.start();
            for (int frame = 0; frame < 20; ++frame) {
                const FrameAnswers &a = some.query(), &b = full.query();
                EXPECT_EQ(answers_hash(a), answers_hash(b));
                expect_same(sorted(a), sorted(b));
                if (testing::Test::HasFailure())
                    return;
                some.advance();
                full.advance();
            }
        }
}

TEST(Answers, AndTheirOrderAreTheSameOnEveryExecutor) {
    for (const char* name : {"tumbling_rocks", "crowd", "fly_through", "cloth_on_sphere"}) {
        SCOPED_TRACE(name);
        const SceneFile file = with_all_queries(built_in(name, 600));
        ScenePlayer one(MovingScene(file), Extent::required, serial());
        one.start();
        std::vector<FrameAnswers> expected;
        for (int frame = 0; frame < 5; ++frame) {
            expected.push_back(one.query());
            one.advance();
        }
        for (const auto& [word, threads] : {std::pair{"tbb", 2u}, {"tbb", 4u}, {"openmp", 2u}}) {
            const auto executor = make_executor(word, threads);
            ScenePlayer other(MovingScene(file), Extent::required, *executor);
            other.start();
            for (const FrameAnswers& answers : expected) {
                expect_same(other.query(), answers);
                other.advance();
            }
        }
    }
}

/// Every pair of present bodies whose widened boxes overlap.
std::vector<Pair> true_body_pairs(const MovingScene& scene) {
    std::vector<Pair> pairs;
    const auto n = static_cast<std::uint32_t>(scene.bodies().size());
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < n; ++i) {
        double margin = 0;
        std::uint32_t first = 0;
        for (const BodyGroup& group : scene.file().groups) {
            const auto in_group = static_cast<std::uint32_t>(
                group.n ? group.n : std::lround(group.share * static_cast<double>(scene.file().n)));
            if (first <= i && i < first + in_group)
                margin = group.margin;
            first += in_group;
        }
        Box box = fitted_box(scene.bodies(), i);
        if (margin > 0 && !box.is_empty())
            for (int axis = 0; axis < 3; ++axis) {
                box.min[axis] = static_cast<float>(static_cast<double>(box.min[axis]) - margin);
                box.max[axis] = static_cast<float>(static_cast<double>(box.max[axis]) + margin);
            }
        boxes.push_back(box);
    }
    for (std::uint32_t a = 0; a < n; ++a)
        for (std::uint32_t b = a + 1; b < n; ++b)
            if (overlaps(boxes[a], boxes[b]) && !scene.is_ignored(a, b))
                pairs.push_back({a, b});
    return pairs;
}

std::vector<Vec3<float>> posed(const Bodies& bodies, std::uint32_t i) {
    std::vector<Vec3<float>> vertices;
    for (const Vec3<float>& v : bodies.meshes[bodies.mesh[i]].vertices)
        vertices.push_back(static_cast<Vec3<float>>(bodies.pose[i](static_cast<Vec3<double>>(v))));
    return vertices;
}

Triangle<double> exact(const std::vector<Vec3<float>>& vertices,
                       const std::array<std::uint32_t, 3>& t) {
    return {static_cast<Vec3<double>>(vertices[t[0]]), static_cast<Vec3<double>>(vertices[t[1]]),
            static_cast<Vec3<double>>(vertices[t[2]])};
}

/// Of all bodies with meshes, by rational numbers; the boxes of triangles may say no.
std::vector<TouchingTriangles> true_triangle_pairs(const MovingScene& scene) {
    const Bodies& bodies = scene.bodies();
    std::vector<TouchingTriangles> touching;
    for (std::uint32_t a = 0; a < bodies.size(); ++a)
        for (std::uint32_t b = a + 1; b < bodies.size(); ++b) {
            if (bodies.mesh[a] == no_mesh || bodies.mesh[b] == no_mesh || !bodies.present[a] ||
                !bodies.present[b] || scene.is_ignored(a, b) ||
                !overlaps(pair_box(scene, a), pair_box(scene, b)))
                continue;
            const auto va = posed(bodies, a), vb = posed(bodies, b);
            const auto& ta = bodies.meshes[bodies.mesh[a]].triangles;
            const auto& tb = bodies.meshes[bodies.mesh[b]].triangles;
            for (std::uint32_t i = 0; i < ta.size(); ++i)
                for (std::uint32_t j = 0; j < tb.size(); ++j) {
                    const auto s = exact(va, ta[i]), t = exact(vb, tb[j]);
                    if (overlaps(s.bounds(), t.bounds()) && oracle::intersect(s, t))
                        touching.push_back({a, b, i, j});
                }
        }
    return touching;
}

template <class Query, class Meets>
std::vector<Pair> true_meetings(const MovingScene& scene, const std::vector<Query>& queries,
                                const Meets& meets) {
    std::vector<Pair> found;
    for (std::uint32_t q = 0; q < queries.size(); ++q)
        for (std::uint32_t i = 0; i < scene.bodies().size(); ++i)
            if (const Box box = fitted_box(scene.bodies(), i);
                !box.is_empty() && meets(queries[q], box))
                found.push_back({q, i});
    return found;
}

std::vector<Neighbour> true_nearest(const MovingScene& scene,
                                    const std::vector<Vec3<float>>& points, std::size_t k) {
    std::vector<Neighbour> nearest;
    for (const Vec3<float>& p : points) {
        std::vector<Neighbour> all;
        for (std::uint32_t i = 0; i < scene.bodies().size(); ++i) {
            const Box box = fitted_box(scene.bodies(), i);
            if (box.is_empty())
                continue;
            double squared = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const auto x = static_cast<double>(p[axis]);
                const double d = std::max({0., static_cast<double>(box.min[axis]) - x,
                                           x - static_cast<double>(box.max[axis])});
                squared += d * d;
            }
            all.push_back({i, squared});
        }
        std::ranges::sort(all, [](const Neighbour& a, const Neighbour& b) {
            return std::pair(a.squared_distance, a.item) < std::pair(b.squared_distance, b.item);
        });
        all.resize(k);
        nearest.insert(nearest.end(), all.begin(), all.end());
    }
    return nearest;
}

/// All that rays may hit, body by body; first: the first triangle of each, and the number of all.
TriangleMesh surface_mesh(const Bodies& bodies, std::vector<std::uint32_t>& first) {
    TriangleMesh mesh;
    first.clear();
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        first.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
        if (!bodies.present[i])
            continue;
        TriangleMesh own{{}, {box_triangles.begin(), box_triangles.end()}};
        const auto &low = bodies.rest[i].min, &high = bodies.rest[i].max;
        for (unsigned corner = 0; corner < 8; ++corner)
            own.vertices.push_back({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                    corner & 4 ? high.z : low.z});
        if (bodies.mesh[i] != no_mesh)
            own = bodies.meshes[bodies.mesh[i]];
        const auto before = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const Vec3<float>& v : own.vertices)
            mesh.vertices.push_back(
                static_cast<Vec3<float>>(bodies.pose[i](static_cast<Vec3<double>>(v))));
        for (const auto& t : own.triangles)
            mesh.triangles.push_back({before + t[0], before + t[1], before + t[2]});
    }
    first.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    return mesh;
}

void expect_true_rays(const MovingScene& scene, const std::vector<Ray<float>>& rays,
                      const std::vector<SurfaceHit>& hits) {
    std::vector<std::uint32_t> first;
    const TriangleMesh mesh = surface_mesh(scene.bodies(), first);
    const RayOracle oracle(mesh);
    ASSERT_EQ(hits.size(), rays.size());
    for (std::size_t r = 0; r < rays.size(); ++r) {
        const RayTruth truth = oracle.truth(rays[r]);
        if (hits[r].body == SurfaceHit::none) {
            EXPECT_FALSE(truth.must_hit()) << "ray " << r;
            continue;
        }
        const auto t = static_cast<double>(hits[r].t);
        EXPECT_TRUE(std::ranges::any_of(truth.candidates,
                                        [&](const auto& candidate) {
                                            return candidate.triangle ==
                                                       first[hits[r].body] + hits[r].triangle &&
                                                   candidate.t_low <= t && t <= candidate.t_high &&
                                                   t <= truth.t_limit;
                                        }))
            << "ray " << r;
    }
}

TEST(Answers, AreThoseOfBruteForce) {
    std::size_t pairs = 0, triangles = 0, hits = 0;
    for (const BuiltInScene& entry : built_in_scenes()) {
        SCOPED_TRACE(entry.name);
        const SceneFile file = with_all_queries(built_in(entry.name, 120));
        ScenePlayer player(MovingScene(file), Extent::required, serial());
        player.start();
        for (int frame = 0; frame < 12; ++frame) {
            const FrameAnswers found = sorted(player.query());
            const MovingScene& scene = player.scene();
            EXPECT_EQ(found.pairs, true_body_pairs(scene));
            if (frame % 4 == 0) {
                EXPECT_EQ(found.triangle_pairs, true_triangle_pairs(scene));
                std::vector<Ray<float>> rays;
                rays_of_frame(scene, *query_named(file, "rays"), rays);
                expect_true_rays(scene, rays, found.rays);
            }
            std::vector<Vec3<float>> points;
            points_of_frame(scene, *query_named(file, "points"), points);
            EXPECT_EQ(found.points, true_meetings(scene, points, [](Vec3<float> p, const Box& box) {
                          return box.contains(p);
                      }));
            std::vector<Box> regions;
            regions_of_frame(scene, *query_named(file, "regions"), regions);
            EXPECT_EQ(found.regions,
                      true_meetings(scene, regions, [](const Box& region, const Box& box) {
                          return overlaps(region, box);
                      }));
            points_of_frame(scene, *query_named(file, "nearest"), points);
            EXPECT_EQ(found.nearest, true_nearest(scene, points, query_named(file, "nearest")->k));
            if (testing::Test::HasFailure())
                return;
            pairs += found.pairs.size();
            triangles += found.triangle_pairs.size();
            hits += static_cast<std::size_t>(std::ranges::count_if(
                found.rays, [](const SurfaceHit& hit) { return hit.body != SurfaceHit::none; }));
            player.advance();
        }
    }
    EXPECT_GT(pairs, 1000u);
    EXPECT_GT(triangles, 100u);
    EXPECT_GT(hits, 1000u);
}

// So many rays that what rests has a tree of its own, made with care; and so few that it has not.
TEST(Answers, OfRaysAreThoseOfBruteForceInOneTreeAndInTwo) {
    for (const char* name : {"tumbling_rocks", "crowd", "warehouse", "popcorn", "cloth_on_sphere"})
        for (const std::size_t frames : {1u, 100000u}) {
            SCOPED_TRACE(name);
            SceneFile file = with_all_queries(built_in(name, 150));
            file.frames = frames;
            const auto executor = make_executor("tbb", 2);
            ScenePlayer player(MovingScene(file), Extent::required, serial());
            ScenePlayer on_two(MovingScene(file), Extent::required, *executor);
            player.start();
            on_two.start();
            for (int frame = 0; frame < 8; ++frame) {
                std::vector<Ray<float>> rays;
                rays_of_frame(player.scene(), *query_named(file, "rays"), rays);
                expect_true_rays(player.scene(), rays, player.query().rays);
                EXPECT_EQ(player.answers().rays, on_two.query().rays);
                player.advance();
                on_two.advance();
            }
        }
}

// An arm that rests and one that moves lie in the same place: a ray that meets both at the same t
// reports the one that comes first, whichever tree it is in.
TEST(Answers, OfRaysThatMeetTwoBodiesAtOnceNameTheFirst) {
    const std::string arm = "[[bodies]]\ngenerator = \"four_link\"\nn = 4\n";
    const std::string moves = "effects = \"drift\"\n";
    for (const std::string& text : {arm + arm + moves, arm + moves + arm})
        for (const std::size_t frames : {1u, 100000u}) {
            SceneFile file = parse_scene_file("queries = \"rays\"\n" + text, "mine.toml");
            file.frames = frames;
            ScenePlayer player(MovingScene(file), Extent::required, serial());
            player.start();
            const Bodies& bodies = player.scene().bodies();
            ASSERT_EQ(fitted_box(bodies, 1), fitted_box(bodies, 5));
            std::size_t hits = 0;
            for (const SurfaceHit& hit : player.query().rays)
                if (hit.body != SurfaceHit::none) {
                    EXPECT_LT(hit.body, 4u) << text;
                    ++hits;
                }
            EXPECT_GT(hits, 0u);
        }
}

TEST(Answers, OfOneBodyAndOfNobody) {
    const std::string cubes = "[[bodies]]\ngenerator = \"cubes\"\nn = ";
    const std::string gone = "effects = [\"drift\", {name = \"despawn\", often = 1}]\n";
    for (const std::string& text : {cubes + "1\n", cubes + "1\n" + gone, cubes + "40\n" + gone,
                                    cubes + "2\nshape = \"sphere_mesh\"\ntriangles = 1\n" + gone}) {
        SCOPED_TRACE(text);
        const SceneFile file = with_all_queries(parse_scene_file(text, "mine.toml"));
        ScenePlayer some(MovingScene(file), Extent::required, serial());
        ScenePlayer full(MovingScene(file), Extent::all_stages, serial());
        some.start();
        full.start();
        for (int frame = 0; frame < 4; ++frame) {
            const FrameAnswers answers = sorted(some.query());
            expect_same(answers, sorted(full.query()));
            EXPECT_EQ(answers.pairs, true_body_pairs(some.scene()));
            EXPECT_EQ(answers.rays.size(), 60u);
            std::vector<Vec3<float>> points;
            points_of_frame(some.scene(), *query_named(file, "nearest"), points);
            EXPECT_EQ(answers.nearest,
                      true_nearest(some.scene(), points, query_named(file, "nearest")->k));
            some.advance();
            full.advance();
        }
        if (text.find("despawn") != std::string::npos) {
            EXPECT_TRUE(some.query().pairs.empty());
            EXPECT_EQ(some.query().rays[0], SurfaceHit{});
            EXPECT_EQ(some.query().nearest[0], Neighbour{});
        }
    }
}

TEST(Answers, ABoxHasTwelveTrianglesThatCloseIt) {
    Bodies bodies;
    bodies.add({{-1, -2, -3}, {1, 2, 3}});
    std::vector<std::uint32_t> first;
    const TriangleMesh mesh = surface_mesh(bodies, first);
    EXPECT_EQ(first, (std::vector<std::uint32_t>{0, 12}));
    double area = 0, volume = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle<float> t = mesh.triangle(i);
        const auto a = static_cast<Vec3<double>>(t.a), b = static_cast<Vec3<double>>(t.b),
                   c = static_cast<Vec3<double>>(t.c);
        area += length(cross(b - a, c - a)) / 2;
        volume += dot(a, cross(b, c)) / 6; // of the divergence theorem: all face the same way
    }
    EXPECT_NEAR(area, 2 * (2 * 4 + 4 * 6 + 2 * 6), 1e-4);
    EXPECT_NEAR(std::abs(volume), 2 * 4 * 6, 1e-4);
}

} // namespace
} // namespace boxwood::bench
