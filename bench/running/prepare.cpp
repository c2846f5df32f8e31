#include "bench/running/prepare.h"

#include "bench/running/calibration.h"
#include "bench/running/inputs.h"
#include "bench/running/play.h"
#include "bench/running/record.h"
#include "bench/tasks/instruction_sets.h"
#include "bench/truth/truth.h"
#include "trees/device.h"
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
        out_.texts["inputs"] = to_text(input_answers_);
        out_.texts["sweep_toml"] = plan_.config_text;
        return std::move(out_);
    }

  private:
    void prepare_scene(const std::vector<const PlannedCell*>& cells) {
        truths_.clear();
        frames_.reset();
        scene_ = make_scene(cells.front()->scene);
        if (scene_.spec.moving) {
            frames_.emplace(scene_.spec.moving);
            scene_.content_hash = content_hash(*frames_);
        }
        quality_of_.clear();

        std::set<std::string_view> names;
        for (const PlannedCell* cell : cells) {
            names.insert(cell->task->name());
            out_.texts.merge(cell->task->texts(scene_));
        }
        const std::uint32_t scene_id =
            record_.add_scene(scene_, fmt::format("{}", fmt::join(names, ",")));
        for (const PlannedCell* cell : cells) {
            report_(out_.cells.size(), plan_.cells.size(), cell->name);
            prepare_cell(*cell, scene_id);
        }
        for (unsigned input = 1; input < plan_.inputs; ++input)
            prepare_input(cells, input);
    }

    /// Judges the answers on another input of those cells that are timed.
    void prepare_input(const std::vector<const PlannedCell*>& cells, unsigned input) {
        std::vector<const PlannedCell*> timed;
        for (const PlannedCell* cell : cells)
            if (has_inputs(*cell) && calibrations_.contains(cell->name))
                timed.push_back(cell);
        if (timed.empty())
            return;
        truths_.clear();
        scene_ = make_scene(scene_in_round(plan_, *timed.front(), input));
        for (const PlannedCell* cell : timed) {
            report_(out_.cells.size(), plan_.cells.size(), cell->name);
            results::Check& check = check_of(*cell);
            input_answers_.try_emplace({cell->name, 0}, check.result_hash, check.n_got);
            try {
                const Judgement judgement = judge_once(*cell);
                input_answers_[{cell->name, input}] = {judgement.check.result_hash,
                                                       judgement.check.n_got};
                add_input(check, input, judgement.check);
            } catch (const DeviceError&) {
                throw;
            } catch (const std::exception& error) {
                calibrations_.erase(cell->name);
                check.status = Status::wrong;
                check.witness = fmt::format("threw on input {}: {:.500}", input, error.what());
            }
        }
    }

    Judgement judge_once(const PlannedCell& cell) {
        const Task& task = *cell.task;
        const KeepFloatingPointMode keep;
        const InstructionSetLimit limit(cell.isa);
        const std::unique_ptr<Contender> contender =
            cell.contender.make(Job{&scene_, cell.task, cell.executor, cell.threads, cell.isa});
        const std::unique_ptr<Answers> answers = task.make_answers();
        contender->build();
        contender->query(*answers);
        contender->fetch(*answers);
        Judgement judgement = truth_of(task).judge(*answers, cell.contender);
        judgement.check.status = judgement.status;
        judgement.check.result_hash = task.hash(*answers);
        return judgement;
    }

    results::Check& check_of(const PlannedCell& cell) {
        const auto row = std::ranges::find(out_.cells, cell.name, &results::Cell::name);
        return *std::ranges::find(out_.checks, row->cell_id, &results::Check::cell_id);
    }

    void prepare_cell(const PlannedCell& cell, std::uint32_t scene_id) {
        const Job job{&scene_, cell.task, cell.executor, cell.threads, cell.isa};
        results::Cell row = record_.cell(cell.name, job, scene_id, cell.contender);
        Judgement judgement;
        Calibration calibration;
        if (const std::optional<std::string> why = cell.contender.unsupported(job)) {
            judgement.status = Status::unsupported;
            judgement.check.witness = *why;
        } else if (!skip_.contains(cell.name)) {
            try {
                calibration = measure(cell, job, row, judgement);
                row.iterations = calibration.query_iterations;
                calibrations_.emplace(cell.name, calibration);
            } catch (const DeviceOutOfMemory& error) {
                judgement = {};
                judgement.status = Status::unsupported;
                judgement.check.witness = error.what();
            } catch (const DeviceError&) {
                throw; // this process can use no device any more
            } catch (const std::exception& error) {
                judgement = {};
                judgement.status = Status::wrong;
                judgement.check.witness = fmt::format("threw: {:.500}", error.what());
            }
        }
        out_.cells.push_back(row);
        if (!skip_.contains(cell.name) || judgement.status == Status::unsupported)
            record_.add(std::move(judgement), row.cell_id, calibration.query_ns);
    }

    /// Times each phase, judges the answers, counts the work and measures the structure.
    Calibration measure(const PlannedCell& cell, const Job& job, results::Cell& row,
                        Judgement& judgement) {
        const std::uint32_t cell_id = row.cell_id;
        const Task& task = *cell.task;
        Truth& truth = truth_of(task);
        const KeepFloatingPointMode keep;
        const InstructionSetLimit limit(cell.isa);
        const std::unique_ptr<Contender> contender = cell.contender.make(job);
        const std::unique_ptr<Answers> answers = task.make_answers();
        Calibration calibration;
        if (task.phases() == Phases::query) {
            contender->build();
            calibration.build_iterations = 0;
        } else {
            calibration.build_ns = calibrate_ns(target_ns_, [&] { contender->build(); });
            calibration.build_iterations = iterations_for(target_ns_, calibration.build_ns);
        }
        std::uint64_t hash = 0;
        if (task.phases() == Phases::frames) {
            hash = measure_frames(cell, *contender, *answers, truth, calibration, cell_id);
        } else if (task.phases() == Phases::build) {
            contender->query(*answers);
            calibration.query_iterations = 0;
        } else {
            calibration.query_ns = calibrate_ns(target_ns_, [&] { contender->query(*answers); });
        }
        contender->fetch(*answers);
        if (task.phases() != Phases::build)
            calibration.query_iterations = iterations_for(target_ns_, calibration.query_ns);

        judgement = truth.judge(*answers, cell.contender);
        judgement.check.result_hash = task.phases() == Phases::frames ? hash : task.hash(*answers);
        count(task, *contender, *answers, cell_id, judgement);
        if (const auto classes = contender->classes())
            row.classes = Record::classes_text(job, *classes);
        if (const auto structure = contender->structure()) {
            out_.counters.push_back({cell_id, "bytes", structure->bytes});
            if (structure->tree && !structure->tree->empty() && !judgement.has_faulty_tree)
                add_tree(cell.contender.is_peer ? cell.contender.name : cell.contender.builder,
                         *structure->tree, cell_id);
        }
        return calibration;
    }

    /// The query of a moving scene is a pass through all of its frames, updates included: one that
    /// is judged, and one that is timed. Gives the hash of all answers.
    std::uint64_t measure_frames(const PlannedCell& cell, Contender& contender, Answers& answers,
                                 Truth& truth, Calibration& calibration, std::uint32_t cell_id) {
        Frames* const frames = cell.task->plays_own_frames() ? nullptr : &*frames_;
        FramesHash hash;
        std::vector<FrameTime> times(frames_->size());
        std::uint64_t moved = 0;
        play(contender, frames, answers, times, [&](std::size_t index, const Frame& frame) {
            moved += frame.moved.size();
            hash.add(cell.task->hash(answers));
            truth.note_frame(index, frame, answers, cell.contender);
        });
        contender.build();
        std::ranges::fill(times, FrameTime{});
        play(contender, frames, answers, times, [](std::size_t, const Frame&) {});
        for (const FrameTime& time : times)
            calibration.query_ns += time.update_ns + time.query_ns;
        if (frames)
            out_.counters.push_back({cell_id, "items_moved", moved}); // in all frames
        return hash.value();
    }

    /// In a pass of its own, which must answer as the timed one.
    void count(const Task& task, Contender& contender, Answers& answers, std::uint32_t cell_id,
               Judgement& judgement) {
        const std::uint64_t timed = task.hash(answers);
        const std::optional<Work> work = contender.counted_query(answers);
        for (const std::vector<NamedCount>& counts :
             {task.counters(answers, work ? &*work : nullptr), contender.more_counts()})
            for (const NamedCount& count : counts)
                out_.counters.push_back({cell_id, count.name, count.value});
        if (work && task.hash(answers) != timed) {
            judgement.status = Status::wrong;
            judgement.check.witness = "the counted pass answered otherwise than the timed one";
        }
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

    Truth& truth_of(const Task& task) {
        std::unique_ptr<Truth>& truth = truths_[&task];
        if (!truth)
            truth = task.make_truth(scene_, std::max(1u, std::thread::hardware_concurrency()));
        return *truth;
    }

    const Plan& plan_;
    const std::set<std::string>& skip_;
    const Report& report_;
    double target_ns_;
    Record record_;
    results::Results& out_; ///< of the record
    Calibrations calibrations_;
    InputAnswers input_answers_;
    // Of the scene at hand.
    Scene scene_;
    std::map<const Task*, std::unique_ptr<Truth>> truths_;
    std::optional<Frames> frames_;              ///< of a scene that moves
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
        check.status = Status::wrong;
        check.witness = witness;
    }
    return is_new;
}

} // namespace boxwood::bench
