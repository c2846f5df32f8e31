#include "bench/tasks/detail/halves.h"
#include "bench/tasks/task.h"
#include "bench/truth/truth.h"
#include "scenes/scenes.h"
#include "trees/builder.h"
#include "trees/inspect/validate.h"
#include "trees/layout.h"
#include "trees/queries/sorted_rays.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/ways_to_build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <filesystem>
#include <fstream>

/// Every builder (alone and with each stage), layout, query and executor on every scene and family
/// of boxes, against oracles that use no tree. All of it comes from the registries: a new word is
/// tried by itself.
namespace boxwood::bench {
namespace {

/// A closed mesh and three boxes as files, for the scenes that read them.
std::filesystem::path file_for(std::string_view generator) {
    const auto folder = std::filesystem::path(testing::TempDir());
    if (generator == "boxes") {
        const auto path = folder / "every_way_boxes.csv";
        std::ofstream(path) << "0,0,0,1,1,1\n1,1,1,2,2,2\n3,3,3,4,4,4\n";
        return path;
    }
    const auto path = folder / "every_way_octahedron.obj";
    std::ofstream(path)
        << "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
           "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    return path;
}

/// A question about a scene.
struct Question {
    Scene scene;
    std::string_view task;
};

/// All tasks on a scene of boxes or triangles, with n points, regions and rays of each
/// kind.
std::vector<Question> questions_of(Scene scene, std::size_t n) {
    std::vector<Question> all{{scene, "pairs"}, {scene, "tree_pairs"}};
    if (scene.boxes.empty())
        return all;
    const bool has_mesh = !scene.mesh.triangles.empty();
    scene.spec.k = 7;
    Scene with_boxes = scene, with_balls = scene, with_points = scene;
    with_boxes.regions = make_box_regions(scene.boxes, n, 2);
    with_balls.spheres = make_sphere_regions(scene.boxes, n, 3);
    with_points.points = make_points(scene.boxes, n, 4);
    all.push_back({with_boxes, "regions"});
    all.push_back({with_balls, "regions"});
    all.push_back({with_points, "points"});
    all.push_back({with_points, "nearest"});
    if (!has_mesh)
        return all;
    all.push_back({with_points, "closest_points"});
    scene.rays = make_rays("random", scene.mesh, n, 5);
    const auto more = make_rays("primary", scene.mesh, n, 6);
    scene.rays.insert(scene.rays.end(), more.begin(), more.end());
    for (const char* task : {"rays_closest", "rays_any", "rays_all"})
        all.push_back({scene, task});
    return all;
}

/// Every scene of the registry, and every family of boxes in each order, with about n items.
std::vector<Scene> every_scene(std::size_t n) {
    std::vector<Scene> all;
    for (const SceneEntry& entry : scene_generators()) {
        SceneSpec spec{.generator = std::string(entry.name), .n = n};
        if (entry.reads_file)
            spec.file = file_for(entry.name);
        try {
            all.push_back(make_scene(spec));
        } catch (const std::invalid_argument&) {
            EXPECT_LT(n, 50u) << entry.name << " cannot be made"; // a sphere of one triangle
        }
    }
    for (const HardCaseFamily& family : hard_case_families()) {
        if (family.reads_file)
            continue;
        const bool counts = family.name == "identical_boxes"; // 2^k boxes
        const bool all_meet = counts || family.name == "nested_boxes";
        const std::size_t m = all_meet ? std::min<std::size_t>(n, 512) : n;
        SceneSpec spec{.generator = std::string(family.name), .n = m};
        if (!std::holds_alternative<BoxCases>(make_scene(spec).cases))
            continue;
        for (int k = family.k_min; k <= (counts ? family.k_min : family.k_max); ++k) {
            spec.k = counts ? std::bit_width(m) - 1 : k;
            all.push_back(make_scene(spec));
        }
    }
    return all;
}

/// The layouts that one way to build makes for a scene, as its questions need them.
struct Built {
    std::unique_ptr<AnyLayout> all, low, high; ///< of all boxes, of either half
    std::unique_ptr<AnyLayout> of_mesh;        ///< if the builder sees triangles
    TriangleBlocks triangles;

    Built(const Scene& scene, const BuildFunction& build, const LayoutEntry& layout,
          const Executor& executor) {
        Tree tree;
        const Boxes boxes = scene.boxes;
        const std::size_t split = tree_pairs_split(boxes.size());
        all = make_layout(layout, build, boxes, executor, tree);
        low = make_layout(layout, build, boxes.first(split), executor, tree);
        high = make_layout(layout, build, boxes.subspan(split), executor, tree);
        if (scene.mesh.triangles.empty())
            return;
        if (build.build_of_mesh) {
            const Tree of_triangles = build.build_of_mesh(scene.mesh, executor);
            const auto fault = of_triangles.is_split ? validate_split(of_triangles, scene.mesh)
                                                     : validate(of_triangles, boxes);
            EXPECT_EQ(fault.value_or(""), "");
            of_mesh = layout.make(of_triangles, executor);
        }
        triangles = surface().triangles(scene.mesh, executor);
    }
    /// For rays and closest points.
    const AnyLayout& surface() const { return of_mesh ? *of_mesh : *all; }
};

/// The hits of rays_all as pairs (ray, triangle), in the order in which the chunks are numbered.
class HitsAsPairs final : public HitSink {
  public:
    explicit HitsAsPairs(std::vector<Pair>& out) : out_(out) {}
    void begin(std::size_t chunks, bool) override { parts_.assign(chunks, {}); }
    bool take(std::size_t chunk, std::uint32_t ray, std::span<const RayHit> hits) override {
        for (const RayHit& hit : hits)
            parts_[chunk].push_back({ray, hit.triangle});
        return true;
    }
    void end() override {
        for (const auto& part : parts_)
            out_.insert(out_.end(), part.begin(), part.end());
    }

  private:
    std::vector<Pair>& out_;
    std::vector<std::vector<Pair>> parts_;
};

/// Hands the pairs of a question to a sink; false if its answers are no pairs.
bool pairs_to(PairSink& sink, const Question& q, const Built& built, const Executor& executor,
              Work* work) {
    if (q.task == "pairs") {
        if (work)
            *work = built.all->self_pairs_counted(sink);
        else
            built.all->self_pairs(executor, sink);
    } else if (q.task == "tree_pairs") {
        if (work)
            *work = built.low->tree_pairs_counted(*built.high, sink);
        else
            built.low->tree_pairs(*built.high, executor, sink);
    } else if (q.task == "points") {
        built.all->points(q.scene.points, executor, sink, work);
    } else if (q.task == "regions") {
        if (q.scene.spheres.empty())
            built.all->regions(q.scene.regions, executor, sink, work);
        else
            built.all->regions(q.scene.spheres, executor, sink, work);
    } else {
        return false;
    }
    return true;
}

/// The answers to one question: one of the lists.
struct Found {
    AnswerList<Pair> pairs;
    AnswerList<Neighbour> neighbours;
    AnswerList<SurfacePoint> surface_points;
    AnswerList<RayHit> hits;

    const Answers& of(const Question& q) const {
        if (q.task == "nearest")
            return neighbours;
        if (q.task == "closest_points")
            return surface_points;
        if (q.task == "rays_closest" || q.task == "rays_any")
            return hits;
        return pairs;
    }
};

Found answers_to(const Question& q, const Built& built, const Executor& executor,
                 Work* work = nullptr) {
    Found answers;
    AppendPairs append(answers.pairs.list);
    const Scene& scene = q.scene;
    const AnyLayout& surface = built.surface();
    if (pairs_to(append, q, built, executor, work)) {
        if (q.task == "tree_pairs")
            for (Pair& pair : answers.pairs.list)
                pair.b += static_cast<std::uint32_t>(tree_pairs_split(scene.boxes.size()));
    } else if (q.task == "nearest") {
        const auto k = static_cast<std::size_t>(*scene.spec.k);
        answers.neighbours.list.resize(k * scene.points.size());
        built.all->nearest(scene.points, k, executor, answers.neighbours.list, work);
    } else if (q.task == "closest_points") {
        answers.surface_points.list.resize(scene.points.size());
        surface.closest_points(scene.points, scene.mesh, executor, answers.surface_points.list,
                               work);
    } else if (q.task == "rays_all") {
        HitsAsPairs hits(answers.pairs.list);
        surface.rays_all(scene.rays, "watertight", built.triangles, executor, hits);
    } else {
        const RayQuery query = q.task == "rays_any" ? RayQuery::any : RayQuery::closest;
        answers.hits.list.resize(scene.rays.size());
        if (work)
            *work = surface.rays_counted(scene.rays, query, "watertight", built.triangles,
                                         answers.hits.list);
        else if (executor.threads() == 4)
            sorted_rays(surface, scene.rays, query, "watertight", built.triangles, executor,
                        answers.hits.list);
        else
            surface.rays(scene.rays, query, "watertight", built.triangles, executor,
                         answers.hits.list);
    }
    return answers;
}

/// Bit for bit and in the same order.
bool same(const Found& a, const Found& b) {
    return a.pairs.list == b.pairs.list && a.neighbours.list == b.neighbours.list &&
           a.hits.list == b.hits.list &&
           std::ranges::equal(a.surface_points.list, b.surface_points.list,
                              [](const SurfacePoint& x, const SurfacePoint& y) {
                                  return x.point == y.point && x.triangle == y.triangle &&
                                         x.squared_distance == y.squared_distance;
                              });
}

std::uint64_t number_of(const Found& answers) {
    const auto found = [](const auto& list, const auto& is) {
        return static_cast<std::uint64_t>(std::ranges::count_if(list, is));
    };
    return answers.pairs.list.size() + found(answers.hits.list, &RayHit::hit) +
           found(answers.neighbours.list, [](const auto& x) { return x.item != Neighbour::none; }) +
           found(answers.surface_points.list,
                 [](const auto& x) { return x.triangle != Neighbour::none; });
}

std::string title(const Question& q) {
    return q.scene.name + " n " + std::to_string(q.scene.boxes.size()) + " " + std::string(q.task);
}

TEST(EveryWay, AnswersEveryQuestionOfEveryScene) {
    const auto parallel = parallel_executors();
    std::size_t turn = 0, answered = 0;
    for (const std::size_t n : {1u, 2u, 140u})
        for (const Scene& scene : every_scene(n)) {
            const std::vector<Question> questions = questions_of(scene, 40);
            std::vector<std::unique_ptr<Truth>> truths;
            for (const Question& q : questions)
                truths.push_back(find_task(q.task)->make_truth(q.scene, 1));
            for (const std::string& way : ways_to_build()) {
                const BuildFunction build = make_builder(way);
                const bool staged = way.find('+') != std::string::npos; // one layout each time
                for (const LayoutEntry& layout : layouts()) {
                    if (staged && &layout != &layouts()[turn % layouts().size()])
                        continue;
                    const Built built(scene, build, layout, *parallel[turn % parallel.size()].run);
                    for (std::size_t i = 0; i < questions.size(); ++i) {
                        const Question& q = questions[i];
                        const Executor& executor = *parallel[++turn % parallel.size()].run;
                        const Found answers = answers_to(q, built, serial());
                        const Judgement judged = truths[i]->judge(answers.of(q), {});
                        ASSERT_TRUE(judged.status != Status::wrong &&
                                    judged.check.missing + judged.check.extra == 0)
                            << way << "." << layout.name << ", " << title(q) << ": "
                            << judged.check.witness;
                        ASSERT_TRUE(same(answers_to(q, built, executor), answers))
                            << way << "." << layout.name << ", " << title(q) << ", "
                            << executor.threads() << " threads";
                        ++answered;
                    }
                }
            }
        }
    EXPECT_GT(answered, 3 * 10 * builders().size() * layouts().size());
}

/// Large enough for every query to be cut into chunks.
TEST(EveryWay, AnswersAlikeOnAnyNumberOfThreadsAndCounted) {
    const auto parallel = parallel_executors();
    const std::vector<std::string> ways = ways_to_build();
    std::size_t turn = 0;
    for (const Scene& scene : every_scene(4500)) {
        const std::vector<Question> questions = questions_of(scene, 600);
        for (const LayoutEntry& layout : layouts()) {
            const std::string& way = ways[turn++ % ways.size()];
            const BuildFunction build = make_builder(way);
            const Built built(scene, build, layout, serial());
            for (const Question& q : questions) {
                SCOPED_TRACE(way + "." + std::string(layout.name) + ", " + title(q));
                const Found answers = answers_to(q, built, serial());
                for (const auto& [name, executor] : parallel) {
                    const Found again = answers_to(q, built, *executor);
                    EXPECT_TRUE(same(again, answers)) << name;
                    EXPECT_EQ(find_task(q.task)->hash(again.of(q)),
                              find_task(q.task)->hash(answers.of(q)));
                }
                if (q.task == "rays_all")
                    continue; // has no counted form
                Work work;
                EXPECT_TRUE(same(answers_to(q, built, serial(), &work), answers) ||
                            q.task == "rays_any");
                EXPECT_EQ(work.answers, number_of(answers));
                if (scene.boxes.size() > 100) { // more than one block
                    EXPECT_GT(work.node_visits, 0u);
                    EXPECT_GT(work.box_tests, 0u);
                }
            }
        }
    }
}

TEST(EveryWay, HandsPairsToEverySinkAndStopsWhenOneHasEnough) {
    const auto parallel = parallel_executors();
    for (const char* generator : {"clusters", "sphere_mesh"}) {
        const Scene scene = make_scene({.generator = generator, .n = 3000});
        const std::vector<Question> questions = questions_of(scene, 1000);
        for (const LayoutEntry& layout : layouts()) {
            const Built built(scene, make_builder("median"), layout, serial());
            for (const Question& q : questions) {
                SCOPED_TRACE(std::string(layout.name) + ", " + title(q));
                CountPairs count;
                if (!pairs_to(count, q, built, serial(), nullptr))
                    continue;
                const std::uint64_t all = answers_to(q, built, serial()).pairs.size();
                ASSERT_GT(all, 400u);
                EXPECT_EQ(count.count(), all);
                for (const auto& [name, executor] : parallel) {
                    pairs_to(count, q, built, *executor, nullptr);
                    EXPECT_EQ(count.count(), all);
                }
                std::uint64_t taken = 0;
                ForEachPair ten([&](Pair) { return ++taken < 10; });
                pairs_to(ten, q, built, serial(), nullptr);
                EXPECT_EQ(taken, 10u);
                for (const auto& [name, executor] : parallel) {
                    // At most one batch of each thread is under way when the first is refused.
                    std::atomic<std::uint64_t> calls = 0;
                    ForEachPair none([&](Pair) { return ++calls == 0; });
                    pairs_to(none, q, built, *executor, nullptr);
                    EXPECT_GE(calls, 1u);
                    EXPECT_LE(calls, executor->threads());
                }
            }
        }
    }
}

} // namespace
} // namespace boxwood::bench
