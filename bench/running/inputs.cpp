#include "bench/running/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace boxwood::bench {
namespace {

constexpr std::string_view table_header = "input\thash\tanswers\tcell";

} // namespace

bool has_inputs(const PlannedCell& cell) {
    return cell.scene.file.empty() && !cell.scene.moving && !cell.scene.k &&
           cell.task->scenes() == SceneKind::still && cell.task->phases() != Phases::frames;
}

SceneSpec scene_in_round(const Plan& plan, const PlannedCell& cell, unsigned round) {
    SceneSpec spec = cell.scene;
    if (has_inputs(cell))
        spec.seed += round % plan.inputs;
    return spec;
}

std::string to_text(const InputAnswers& answers) {
    std::string text = fmt::format("{}\n", table_header);
    for (const auto& [key, checked] : answers)
        text += fmt::format("{}\t{}\t{}\t{}\n", key.second, checked.hash, checked.n, key.first);
    return text;
}

InputAnswers input_answers_of(std::string_view text) {
    std::istringstream lines{std::string(text)};
    std::string line;
    if (!std::getline(lines, line) || line != table_header)
        throw std::runtime_error("the text \"inputs\" is not the table it should be");
    InputAnswers answers;
    while (std::getline(lines, line)) {
        std::istringstream fields(line);
        unsigned input = 0;
        CheckedAnswers checked;
        std::string cell;
        if (!(fields >> input >> checked.hash >> checked.n >> cell))
            throw std::runtime_error("the text \"inputs\" has a bad line: " + line);
        answers[{cell, input}] = checked;
    }
    return answers;
}

void add_input(results::Check& check, unsigned input, const results::Check& of_input) {
    using results::Check;
    for (std::uint64_t Check::*count : {&Check::n_checked, &Check::n_expected, &Check::n_got,
                                        &Check::missing, &Check::extra, &Check::bound_violations})
        check.*count =
            check.*count == results::no_count ? results::no_count : check.*count + of_input.*count;
    for (double Check::*error : {&Check::max_ulp, &Check::max_abs_err, &Check::max_rel_err})
        if (!(check.*error >= of_input.*error))
            check.*error = of_input.*error;
    if (of_input.status <= check.status)
        return;
    check.status = of_input.status;
    check.witness = fmt::format("on input {}: {}", input, of_input.witness);
}

} // namespace boxwood::bench
