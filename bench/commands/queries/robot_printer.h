#pragma once

#include "bench/commands/queries/query.h"
#include "bench/commands/queries/query_times.h"
#include "bench/commands/queries/robot_case.h"
#include "bench/commands/queries/surroundings.h"

#include <cstddef>
#include <memory>
#include <ostream>
#include <span>

namespace boxwood::bench {

/// Prints a robot, then what is found in each of its states.
class RobotPrinter {
  public:
    virtual ~RobotPrinter() = default;
    virtual void begin() = 0;
    /// around: none without obstacles.
    virtual void state(std::size_t i, std::span<const double> values, const SelfCollision& found,
                       const Surroundings::Answer* around) = 0;
    virtual void end(const QueryTimes& times) = 0;
};

/// Lines, each of which begins with what it is, or one JSON object. The robot must outlive it.
std::unique_ptr<RobotPrinter> make_robot_printer(const RobotCase& robot, const Format& format,
                                                 std::ostream& out);

} // namespace boxwood::bench
