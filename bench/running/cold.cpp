#include "bench/running/cold.h"

#include "bench/running/child.h"
#include "bench/tasks/instruction_sets.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace boxwood::bench {

ColdTimes time_cold(const PlannedCell& cell, const SceneSpec& spec) {
    using Clock = std::chrono::steady_clock;
    const auto ns = [](Clock::duration time) {
        return std::chrono::duration<double, std::nano>(time).count();
    };
    const Scene scene = make_scene(spec);
    const InstructionSetLimit limit(cell.isa);
    const std::unique_ptr<Contender> contender =
        cell.contender.make(Job{&scene, cell.task, cell.executor, cell.threads, cell.isa});
    const std::unique_ptr<Answers> answers = cell.task->make_answers();
    const Clock::time_point begin = Clock::now();
    contender->build();
    const Clock::time_point built = Clock::now();
    contender->query(*answers);
    const Clock::time_point end = Clock::now();
    contender->fetch(*answers);
    return {ns(built - begin), ns(end - begin), cell.task->hash(*answers)};
}

std::string to_text(const ColdTimes& times) {
    return fmt::format("cold {} {} {}\n", times.build_ns, times.build_and_query_ns, times.hash);
}

ColdTimes cold_times_of(const std::string& line) {
    std::istringstream words(line);
    std::string first;
    ColdTimes times;
    if (!(words >> first >> times.build_ns >> times.build_and_query_ns >> times.hash) ||
        first != "cold")
        throw std::runtime_error(fmt::format("a cold process said \"{:.200}\" and no times", line));
    return times;
}

ColdTimes run_cold_process(const std::string& cell) {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::vector<std::string> arguments;
    for (std::string argument; std::getline(file, argument, '\0');)
        arguments.push_back(argument);
    arguments.insert(arguments.end(), {"--cold", cell});
    return cold_times_of(output_of_child(std::move(arguments)));
}

} // namespace boxwood::bench
