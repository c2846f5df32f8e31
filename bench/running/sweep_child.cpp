#include "bench/io/bad_input.h"
#include "bench/io/csv.h"
#include "bench/machine/environment.h"
#include "bench/running/child.h"
#include "bench/running/cold.h"
#include "bench/running/inputs.h"
#include "bench/running/instructions/count.h"
#include "bench/running/prepare.h"
#include "bench/running/round.h"
#include "bench/running/sweep.h"
#include "trees/device_memory.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

Plan plan_of(const ChildOptions& options) {
    return make_plan(read_text(options.config.string()), options.config.string(),
                     options.overrides);
}

int time_first_build(const ChildOptions& options) {
    const Plan plan = plan_of(options);
    const auto cell = std::ranges::find(plan.cells, options.cold, &PlannedCell::name);
    if (cell == plan.cells.end())
        throw BadInput(fmt::format("--cold: there is no cell {}", options.cold));
    fmt::print("{}", to_text(time_cold(*cell, scene_in_round(plan, *cell, options.round))));
    return exit_success;
}

results::Results work(const ChildOptions& options, const Report& report) {
    const Plan plan = plan_of(options);
    if (plan.sweep_hash != options.sweep_hash)
        throw BadInput("what is to be measured changed while the sweep ran: was the mesh file "
                       "edited, or boxwood built again?");
    if (options.is_preparation) {
        results::Env env = environment(true);
        env.seed = plan.seed;
        return prepare(plan, env, options.skip, report);
    }
    const results::Results prepared = results::read(options.prepared);
    if (!options.dumps.empty())
        return count_instructions(plan, prepared, options.dumps, report);
    if (environment(false).env_hash != prepared.env.at(0).env_hash)
        throw BadInput("the machine or the build changed while the sweep ran");
    results::Results results = run_round(plan, prepared, options.round, report, run_cold_process);
    results.shards.at(0).other_cores = options.other_cores;
    return results;
}

} // namespace

int run_sweep_child(const ChildOptions& options) {
    if (!options.cold.empty())
        return time_first_build(options);
    ChildReport report(options.report_fd);
    bool in_cell = false;
    try {
        const results::Results results =
            work(options, [&](std::size_t done, std::size_t total, const std::string& cell) {
                in_cell = !options.is_preparation; // which handles what cells throw by itself
                report.at(done, total, cell);
            });
        in_cell = false;
        report.finishing();
        results::write(options.out, results);
        return exit_success;
    } catch (const DeviceError& error) { // a fault that the next process does not have
        report.threw(error);
        return exit_failed;
    } catch (const std::exception& error) {
        if (in_cell)
            report.threw(error);
        else
            report.failed(error);
        return in_cell ? exit_failed : exit_bad_input;
    }
}

} // namespace boxwood::bench
