#pragma once

#include "results/results.h"

#include <cstdint>
#include <string>
#include <tuple>

namespace boxwood::bench {

/// What is the same for all contenders of one job: scene, task, threads, and on a device its
/// executor.
using JobKey = std::tuple<std::uint32_t, std::string, std::uint32_t, std::string>;
inline JobKey job_of(const results::Cell& cell) {
    return {cell.scene_id, cell.task, cell.threads, is_device(cell) ? cell.executor : ""};
}

} // namespace boxwood::bench
