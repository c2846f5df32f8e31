#pragma once

#include "bench/plan/plan.h"
#include "results/results.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

/// The inputs of a sweep: round r plays each scene with its seed + r % inputs, so that an interval
/// covers scenes as well as moments.
namespace boxwood::bench {

/// Whether the scene of a cell differs from input to input: the user's files, scenes that move and
/// hard cases do not.
bool has_inputs(const PlannedCell& cell);

/// The scene of a cell in this round.
SceneSpec scene_in_round(const Plan& plan, const PlannedCell& cell, unsigned round);

/// The answers that were checked on an input.
struct CheckedAnswers {
    std::uint64_t hash = 0, n = 0;
    bool operator==(const CheckedAnswers&) const = default;
};

/// By cell name and input; empty where a sweep has one input.
using InputAnswers = std::map<std::pair<std::string, unsigned>, CheckedAnswers>;

/// As the table that /text/inputs holds, and back. Throws std::runtime_error for other text.
std::string to_text(const InputAnswers& answers);
InputAnswers input_answers_of(std::string_view text);

/// Puts the check of another input into that of the ones before it: counts add up, the worst
/// status, bound and its witness stay.
void add_input(results::Check& check, unsigned input, const results::Check& of_input);

} // namespace boxwood::bench
