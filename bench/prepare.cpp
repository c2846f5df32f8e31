#include "bench/prepare.h"

#include "bench/calibration.h"
#include "bench/truth.h"
#include "trees/quality.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cfenv>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <random>
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

/// Some libraries leave the rounding or denormal mode changed.
class KeepFloatingPointMode {
  public:
    KeepFloatingPointMode() { std::fegetenv(&saved_); }
    ~KeepFloatingPointMode() { std::fesetenv(&saved_); }
    KeepFloatingPointMode(const KeepFloatingPointMode&) = delete;

  private:
    std::fenv_t saved_;
};

std::string random_uuid() {
    std::random_device device;
    const auto bits = [&](unsigned mask, unsigned set) { return (device() & mask) | set; };
    return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:08x}{:04x}", bits(~0u, 0), bits(0xffff, 0),
                       bits(0x0fff, 0x4000), bits(0x3fff, 0x8000), bits(~0u, 0), bits(0xffff, 0));
}

std::string library_version(const ContenderEntry& contender, const results::Env& env) {
    for (const Peer& peer : peers())
        if (peer.name == contender.library)
            return peer.version;
    return env.git_commit;
}

class Preparation {
  public:
    Preparation(const Plan& plan, const results::Env& env, const std::set<std::string>& skip,
                const Report& report)
        : plan_(plan), env_(env), skip_(skip), report_(report), target_ns_(plan.min_time_ms * 1e6) {
    }

    results::Results run() {
        out_.run_uuid = random_uuid();
        out_.created_utc =
            fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
        out_.sweep_hash = plan_.sweep_hash;
        out_.generator = "boxwood sweep";
        out_.env.push_back(env_);

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
        scene_ = make_scene(cells.front()->scene);
        truths_.clear();
        quality_of_.clear();

        results::SceneRow row;
        row.scene_id = static_cast<std::uint32_t>(out_.scenes.size());
        row.name = scene_.name;
        row.generator = scene_.spec.generator;
        row.n_items = scene_.boxes.size();
        row.n_triangles = scene_.mesh.triangles.size();
        row.seed = scene_.spec.seed;
        std::set<std::string_view> asked;
        for (const PlannedCell* cell : cells)
            asked.insert(to_string(cell->ask));
        row.asks = fmt::format("{}", fmt::join(asked, ","));
        row.content_hash = scene_.content_hash;
        row.params_json = scene_.params_json;
        out_.scenes.push_back(row);

        for (const PlannedCell* cell : cells) {
            report_(out_.cells.size(), plan_.cells.size(), cell->name);
            prepare_cell(*cell, row.scene_id);
        }
    }

    void prepare_cell(const PlannedCell& cell, std::uint32_t scene_id) {
        results::Cell row;
        row.cell_id = static_cast<std::uint32_t>(out_.cells.size());
        row.name = cell.name;
        row.scene_id = scene_id;
        row.variant_id = variant_id_of(cell.contender);
        row.ask = to_string(cell.ask);
        row.n_items = scene_.boxes.size();
        row.n_queries = scene_.rays.size();
        row.precision = cell.contender.precision;
        row.executor = cell.executor;
        row.threads = cell.threads;
        row.isa = cell.contender.is_peer ? "" : env_.isa_used;

        results::Check check;
        const Job job{&scene_, cell.ask, cell.executor, cell.threads};
        const std::optional<std::string> why =
            cell.contender.unsupported ? cell.contender.unsupported(job) : std::nullopt;
        if (why) {
            check.status = "unsupported";
            check.witness = *why;
        } else if (!skip_.contains(cell.name)) {
            try {
                const Calibration calibration = measure(cell, job, row.cell_id, check);
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
        const Truth& truth = truth_of(cell.ask);
        const KeepFloatingPointMode keep;
        const std::unique_ptr<Contender> contender = cell.contender.make(job);
        Answers answers;
        Calibration calibration;
        calibration.build_ns = calibrate_ns(target_ns_, [&] { contender->build(); });
        calibration.query_ns = calibrate_ns(target_ns_, [&] { contender->query(answers); });
        calibration.build_iterations = iterations_for(target_ns_, calibration.build_ns);
        calibration.query_iterations = iterations_for(target_ns_, calibration.query_ns);
        check = truth.check(answers);
        check.result_hash = answer_hash(answers, cell.ask);

        count(cell.ask, *contender, answers, cell_id, check);
        if (const auto structure = contender->structure()) {
            out_.counters.push_back({cell_id, "bytes", structure->bytes});
            if (structure->tree)
                add_tree(cell.contender.builder, *structure->tree, cell_id);
        }
        return calibration;
    }

    void count(Ask ask, Contender& contender, Answers& answers, std::uint32_t cell_id,
               results::Check& check) {
        const bool is_rays = is_ray_ask(ask);
        const std::uint64_t found =
            is_rays ? static_cast<std::uint64_t>(std::ranges::count_if(
                          answers.hits, [](const RayHit& hit) { return hit.hit(); }))
                    : answers.pairs.size();
        const auto add = [&](const char* counter, std::uint64_t value) {
            out_.counters.push_back({cell_id, counter, value});
        };
        add(is_rays ? "hits" : "pairs", found);
        const std::optional<Work> work = contender.counted_query(answers);
        if (!work)
            return;
        add("node_visits", work->node_visits);
        add("box_tests", work->box_tests);
        if (is_rays)
            add("triangle_tests", work->triangle_tests);
        add("stack_max", work->stack_max);
        if (answer_hash(answers, ask) != check.result_hash) {
            check.status = "wrong";
            check.witness = "the counted pass answered otherwise than the timed one";
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

    std::uint32_t variant_id_of(const ContenderEntry& contender) {
        for (const results::Variant& variant : out_.variants)
            if (variant.name == contender.name && variant.library == contender.library)
                return variant.variant_id;
        results::Variant row;
        row.variant_id = static_cast<std::uint32_t>(out_.variants.size());
        row.name = contender.name;
        row.library = contender.library;
        row.lib_version = library_version(contender, env_);
        row.builder = contender.builder;
        row.layout = contender.layout;
        row.traversal = contender.traversal;
        row.kernel = contender.kernel;
        row.is_peer = contender.is_peer;
        row.params_json = contender.params_json;
        row.notes = contender.notes;
        out_.variants.push_back(row);
        return row.variant_id;
    }

    const Truth& truth_of(Ask ask) {
        std::unique_ptr<Truth>& truth = truths_[ask];
        if (!truth)
            truth = make_truth(scene_, ask, std::max(1u, std::thread::hardware_concurrency()));
        return *truth;
    }

    const Plan& plan_;
    const results::Env& env_;
    const std::set<std::string>& skip_;
    const Report& report_;
    double target_ns_;
    results::Results out_;
    Calibrations calibrations_;
    // Of the scene at hand.
    Scene scene_;
    std::map<Ask, std::unique_ptr<Truth>> truths_;
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
