#include "bench/running/prepare.h"

#include "bench/running/calibration.h"
#include "bench/truth/judging/judge.h"
#include "bench/running/record.h"
#include "bench/tasks/scene_queries.h"
#include "bench/io/scene_strip.h"
#include "bench/tasks/tree_builds.h"
#include "bench/truth/truth.h"
#include "trees/inspect/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <thread>

namespace boxwood::bench {
namespace {

template <class Body> double elapsed_ns(Body body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start)
        .count();
}

/// Time of one call after a first one: calls are doubled until they fill a quarter of the target,
/// so that calibration takes less than one sample more. A first call beyond the target is enough.
template <class Body> double calibrate_ns(double target_ns, Body body) {
    const double first = elapsed_ns(body);
    if (first >= target_ns)
        return first;
    for (std::uint64_t calls = 1;; calls *= 2) {
        const double all = elapsed_ns([&] {
            for (std::uint64_t i = 0; i < calls; ++i)
                body();
        });
        if (all >= target_ns / 4)
            return all / static_cast<double>(calls);
    }
}

class Preparation {
  public:
    Preparation(const Plan& plan, const results::Env& env, const std::set<std::string>& skip,
                const Report& report)
        : plan_(plan), skip_(skip), report_(report), target_ns_(plan.min_time_ms * 1e6),
          record_(env, "boxwood sweep"), out_(record_.out) {}

    results::Results run() {
        out_.sweep_hash = plan_.sweep_hash;

        std::vector<std::string> keys; // scenes in the order of the plan
        std::map<std::string, std::vector<const PlannedCell*>> cells_of;
        for (const PlannedCell& cell : plan_.cells) {
            std::vector<const PlannedCell*>& cells = cells_of[scene_key(cell.scene)];
            if (cells.empty())
                keys.push_back(scene_key(cell.scene));
            cells.push_back(&cell);
        }
        for (const std::string& key : keys)
            prepare_scene(cells_of[key]);
        out_.texts["calibration"] = to_text(calibrations_);
        out_.texts["sweep_toml"] = plan_.config_text;
        return std::move(out_);
    }

  private:
    void prepare_scene(const std::vector<const PlannedCell*>& cells) {
        truths_.clear();
        judges_.clear();
        moving_truth_.reset();
        scene_truth_.reset();
        frames_.reset();
        scene_ = make_scene(cells.front()->scene);
        if (scene_.spec.moving) {
            frames_.emplace(scene_.spec.moving);
            scene_.content_hash = content_hash(*frames_);
        }
        quality_of_.clear();

        std::set<std::string_view> asked;
        for (const PlannedCell* cell : cells)
            asked.insert(to_string(cell->task));
        const std::uint32_t scene_id =
            record_.add_scene(scene_, fmt::format("{}", fmt::join(asked, ",")));
        if (asked.contains(to_string(Ask::scene_queries)))
            out_.texts.try_emplace("strip_" + scene_.name, scene_strip(*scene_.spec.moving));
        for (const PlannedCell* cell : cells) {
            report_(out_.cells.size(), plan_.cells.size(), cell->name);
            prepare_cell(*cell, scene_id);
        }
    }

    void prepare_cell(const PlannedCell& cell, std::uint32_t scene_id) {
        results::Cell row = record_.cell(cell.name, scene_, scene_id, cell.task, cell.contender,
                                         cell.executor, cell.threads);
        results::Check check;
        const Job job{&scene_, cell.task, cell.executor, cell.threads};
        const std::optional<std::string> why =
            cell.contender.unsupported ? cell.contender.unsupported(job) : std::nullopt;
        if (why) {
            check.status = "unsupported";
            check.witness = *why;
        } else if (!skip_.contains(cell.name)) {
            try {
                const Calibration calibration =
                    is_kernel_ask(cell.task)         ? measure_kernel(cell, job, row.cell_id, check)
                    : cell.task == Ask::moving_pairs ? measure_moving(cell, job, row.cell_id, check)
                    : cell.task == Ask::scene_queries   ? measure_scene(cell, job, row.cell_id, check)
                    : cell.task == Ask::tree         ? measure_tree(cell, job, row.cell_id, check)
                                                    : measure(cell, job, row.cell_id, check);
                row.iterations = calibration.query_iterations;
                calibrations_.emplace(cell.name, calibration);
            } catch (const std::exception& error) {
                check.status = "wrong";
                check.witness = fmt::format("threw: {:.500}", error.what());
            }
        }
        check.cell_id = row.cell_id;
        out_.cells.push_back(row);
        if (!check.status.empty())
            out_.checks.push_back(check);
    }

    Calibration measure(const PlannedCell& cell, const Job& job, std::uint32_t cell_id,
                        results::Check& check) {
        const Truth& truth = truth_of(cell.task);
        const KeepFloatingPointMode keep;
        const std::unique_ptr<Contender> contender = cell.contender.make(job);
        Answers answers;
        Calibration calibration;
        calibration.build_ns = calibrate_ns(target_ns_, [&] { contender->build(); });
        calibration.query_ns = calibrate_ns(target_ns_, [&] { contender->query(answers); });
        calibration.build_iterations = iterations_for(target_ns_, calibration.build_ns);
        calibration.query_iterations = iterations_for(target_ns_, calibration.query_ns);
        check = truth.check(answers);
        check.result_hash = answer_hash(answers, cell.task);
        if (cell.task == Ask::triangle_pairs)
            add_kernel_row(cell, cell_id, check);

        count(cell.task, *contender, answers, cell_id, check);
        if (const auto structure = contender->structure()) {
            out_.counters.push_back({cell_id, "bytes", structure->bytes});
            if (structure->tree && !structure->tree->empty())
                add_tree(cell.contender.builder, *structure->tree, cell_id);
        }
        return calibration;
    }

    /// A tree of which nothing is asked: all its time is in the build.
    Calibration measure_tree(const PlannedCell& cell, const Job& job, std::uint32_t cell_id,
                             results::Check& check) {
        const KeepFloatingPointMode keep;
        const std::unique_ptr<Contender> contender = cell.contender.make(job);
        Calibration calibration;
        calibration.query_iterations = 0;
        calibration.build_ns = calibrate_ns(target_ns_, [&] { contender->build(); });
        calibration.build_iterations = iterations_for(target_ns_, calibration.build_ns);
        check = check_tree(*contender, scene_);
        const StructureInfo structure = contender->structure().value();
        out_.counters.push_back({cell_id, "bytes", structure.bytes});
        if (check.status == "exact" && !structure.tree->empty())
            add_tree(cell.contender.is_peer ? cell.contender.name : cell.contender.builder,
                     *structure.tree, cell_id);
        return calibration;
    }

    /// The query of a moving scene is a pass through all of its frames, updates included.
    Calibration measure_moving(const PlannedCell& cell, const Job& job, std::uint32_t cell_id,
                               results::Check& check) {
        if (!moving_truth_)
            moving_truth_.emplace(*frames_, std::max(1u, std::thread::hardware_concurrency()));
        const KeepFloatingPointMode keep;
        const std::unique_ptr<Contender> contender = cell.contender.make(job);
        Answers answers;
        FramesHash hash;
        std::vector<FrameTime> times(frames_->size());
        Calibration calibration;
        calibration.build_ns = calibrate_ns(target_ns_, [&] { contender->build(); });
        std::uint64_t moved = 0;
        play(*contender, *frames_, answers, times, [&](std::size_t index, const Frame& frame) {
            moved += frame.moved.size();
            hash.add(answers.pairs);
            moving_truth_->check(index, frame, answers, check);
        });
        contender->build();
        std::ranges::fill(times, FrameTime{});
        play(*contender, *frames_, answers, times, [](std::size_t, const Frame&) {});
        for (const FrameTime& time : times)
            calibration.query_ns += time.update_ns + time.query_ns;
        calibration.build_iterations = iterations_for(target_ns_, calibration.build_ns);
        calibration.query_iterations = iterations_for(target_ns_, calibration.query_ns);

        check.result_hash = hash.value();
        const PairsDigest last = digest_of(answers.pairs);
        const auto add = [&](std::string counter, std::uint64_t value) {
            out_.counters.push_back({cell_id, std::move(counter), value});
        };
        add("pairs", answers.pairs.size());
        add("items_moved", moved); // in all frames
        for (const NamedCount& count : contender->more_counts())
            add(count.name, count.value);
        if (const auto structure = contender->structure())
            add("bytes", structure->bytes);
        if (const std::optional<Work> work = contender->counted_query(answers)) {
            add("node_visits", work->node_visits);
            add("box_tests", work->box_tests);
            add("stack_max", work->stack_max);
            if (digest_of(answers.pairs) != last) {
                check.status = "wrong";
                check.witness = "the counted pass answered otherwise than the timed one";
            }
        }
        return calibration;
    }

    /// The same of all that a scene asks.
    Calibration measure_scene(const PlannedCell& cell, const Job& job, std::uint32_t cell_id,
                              results::Check& check) {
        if (!scene_truth_)
            scene_truth_.emplace(scene_.spec.moving,
                                 std::max(1u, std::thread::hardware_concurrency()));
        const KeepFloatingPointMode keep;
        const std::unique_ptr<Contender> contender = cell.contender.make(job);
        auto& stages = dynamic_cast<StagesContender&>(*contender);
        std::vector<FrameTime> times(frames_->size());
        Calibration calibration;
        calibration.build_ns = calibrate_ns(target_ns_, [&] { contender->build(); });
        check.result_hash = scene_truth_->check(stages, cell.contender.name, times, check);
        contender->build();
        std::ranges::fill(times, FrameTime{});
        play_scene(stages, times.size(), times, [](std::size_t, const FrameAnswers&) {});
        for (const FrameTime& time : times)
            calibration.query_ns += time.update_ns + time.query_ns;
        calibration.build_iterations = iterations_for(target_ns_, calibration.build_ns);
        calibration.query_iterations = iterations_for(target_ns_, calibration.query_ns);
        out_.counters.push_back({cell_id, "pairs", stages.frame_answers().pairs.size()});
        return calibration;
    }

    /// A kernel has nothing to build: all its time is in the query.
    Calibration measure_kernel(const PlannedCell& cell, const Job& job, std::uint32_t cell_id,
                               results::Check& check) {
        Judge& judge = judge_of(cell.task);
        const KeepFloatingPointMode keep;
        const std::unique_ptr<Contender> contender = cell.contender.make(job);
        contender->build();
        Answers answers;
        Calibration calibration;
        calibration.build_iterations = 0;
        calibration.query_ns = calibrate_ns(target_ns_, [&] { contender->query(answers); });
        calibration.query_iterations = iterations_for(target_ns_, calibration.query_ns);

        Judgement judgement = judge.judge(answers, cell.contender);
        judgement.kernel.ns_per_call =
            calibration.query_ns /
            static_cast<double>(std::max<std::uint64_t>(1, items_of(scene_)));
        check = judgement.check;
        check.result_hash = answer_hash(answers, cell.task);
        record_.add(std::move(judgement), cell_id);
        return calibration;
    }

    void count(Ask ask, Contender& contender, Answers& answers, std::uint32_t cell_id,
               results::Check& check) {
        const bool is_rays = is_ray_ask(ask);
        const std::uint64_t found =
            is_rays && ask != Ask::rays_all
                ? static_cast<std::uint64_t>(std::ranges::count_if(
                      answers.hits, [](const RayHit& hit) { return hit.hit(); }))
                : answers.pairs.size() + answers.neighbours.size() + answers.surface_points.size();
        const auto add = [&](const char* counter, std::uint64_t value) {
            out_.counters.push_back({cell_id, counter, value});
        };
        const bool is_nearest = ask == Ask::nearest || ask == Ask::closest_points;
        add(is_rays || is_nearest ? "hits" : "pairs", found);
        const std::optional<Work> work = contender.counted_query(answers);
        if (!work)
            return;
        add("node_visits", work->node_visits);
        add("box_tests", work->box_tests);
        if (is_rays || ask == Ask::triangle_pairs || ask == Ask::closest_points)
            add("triangle_tests", work->triangle_tests);
        add("stack_max", work->stack_max);
        if (answer_hash(answers, ask) != check.result_hash) {
            check.status = "wrong";
            check.witness = "the counted pass answered otherwise than the timed one";
        }
    }

    /// Whole queries are rows of the kernel they use, too: what its wrong answers come to.
    void add_kernel_row(const PlannedCell& cell, std::uint32_t cell_id,
                        const results::Check& check) {
        results::KernelRow row;
        row.cell_id = cell_id;
        row.family = "typical";
        row.panel = to_string(Panel::generic);
        row.task = to_string(cell.task);
        row.kernel = cell.contender.kernel.empty() ? cell.contender.name : cell.contender.kernel;
        row.promise = to_string(cell.contender.promise);
        row.n = row.tier_0 = check.n_expected;
        row.false_pos = check.extra;
        row.false_neg = check.missing;
        row.status = check.status;
        row.witness = check.witness;
        out_.kernels.push_back(std::move(row));
    }

    /// One measurement per builder and scene: the tree is the same in all of its cells.
    void add_tree(const std::string& builder, const Tree& tree, std::uint32_t cell_id) {
        const auto [found, is_new] = quality_of_.try_emplace(builder);
        if (is_new)
            found->second = quality(tree, scene_.boxes);
        const Quality& q = found->second;
        const QualityModel model;
        out_.trees.push_back({cell_id, q.n_nodes, q.n_leaves, q.depth_max, q.depth_mean,
                              q.leaf_mean, q.bytes, q.sah_cost, model.c_trav, model.c_isect, q.epo,
                              q.overlap});
    }

    const Truth& truth_of(Ask ask) {
        std::unique_ptr<Truth>& truth = truths_[ask];
        if (!truth)
            truth = make_truth(scene_, ask, std::max(1u, std::thread::hardware_concurrency()));
        return *truth;
    }

    Judge& judge_of(Ask ask) {
        std::unique_ptr<Judge>& judge = judges_[ask];
        if (!judge)
            judge = make_judge(scene_, ask, std::max(1u, std::thread::hardware_concurrency()));
        return *judge;
    }

    const Plan& plan_;
    const std::set<std::string>& skip_;
    const Report& report_;
    double target_ns_;
    Record record_;
    results::Results& out_; ///< of the record
    Calibrations calibrations_;
    // Of the scene at hand.
    Scene scene_;
    std::map<Ask, std::unique_ptr<Truth>> truths_;
    std::map<Ask, std::unique_ptr<Judge>> judges_;
    std::optional<Frames> frames_; ///< of a scene that moves
    std::optional<MovingTruth> moving_truth_;
    std::optional<SceneTruth> scene_truth_;
    std::map<std::string, Quality> quality_of_; ///< by builder
};

} // namespace

results::Results prepare(const Plan& plan, const results::Env& env,
                         const std::set<std::string>& skip, const Report& report) {
    return Preparation(plan, env, skip, report).run();
}

bool mark_crashed(results::Results& prepared, const std::string& cell, const std::string& witness) {
    bool is_new = false;
    Calibrations calibrations = calibrations_of(prepared.texts["calibration"]);
    calibrations.erase(cell);
    prepared.texts["calibration"] = to_text(calibrations);
    for (const results::Cell& row : prepared.cells) {
        if (row.name != cell)
            continue;
        auto seen = std::ranges::find(prepared.checks, row.cell_id, &results::Check::cell_id);
        if (seen == prepared.checks.end())
            seen = prepared.checks.emplace(seen);
        results::Check& check = *seen;
        is_new |= check.witness != witness;
        check.cell_id = row.cell_id;
        check.status = "wrong";
        check.witness = witness;
    }
    return is_new;
}

std::string scene_key(const SceneSpec& spec) {
    return fmt::format("{}/n{}-s{}", scene_name(spec), spec.n, spec.seed);
}

} // namespace boxwood::bench
