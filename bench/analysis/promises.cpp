#include "bench/analysis/promises.h"

#include "bench/analysis/index.h"
#include "bench/truth/crash.h"
#include "bench/truth/judging/case_truths.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace boxwood::bench {
namespace {

using results::Results;

bool is_checked_wrong(const Results& results, std::uint32_t cell_id) {
    return std::ranges::any_of(results.checks, [&](const results::Check& check) {
        return check.cell_id == cell_id && check.status == results::Status::wrong;
    });
}

} // namespace

void set_broken_promises(Results& results) {
    for (results::KernelRow& row : results.kernels)
        row.is_broken = breaks_promise(row);
}

std::size_t broken_promises(const Results& results) {
    return static_cast<std::size_t>(
        std::ranges::count_if(results.kernels, [](const auto& row) { return row.is_broken != 0; }));
}

std::string promises_text(const Results& results) {
    constexpr std::size_t max_shown = 10;
    std::string text;
    std::size_t broken = 0;
    for (const results::KernelRow& row : results.kernels)
        if (row.is_broken && ++broken <= max_shown)
            text += fmt::format("BROKEN PROMISE: {} promises {} on {}/{}\n  {}\n", row.kernel,
                                row.promise, row.family, row.task, row.witness);
    if (broken > max_shown)
        text += fmt::format("and {} more\n", broken - max_shown);
    return broken == 0
               ? "Every promise is kept.\n"
               : text + fmt::format("{} broken promise{}.\n", broken, broken == 1 ? "" : "s");
}

bool is_judged_by_promise(const Results& results, const results::Cell& cell) {
    return std::ranges::find(results.kernels, cell.cell_id, &results::KernelRow::cell_id) !=
               results.kernels.end() &&
           is_checked_wrong(results, cell.cell_id);
}

bool is_promise_broken(const Results& results) {
    const Index index(results);
    return std::ranges::any_of(results.cells,
                               [&](const results::Cell& cell) {
                                   return cell.status == results::Status::wrong &&
                                          !index.is_peer(cell) &&
                                          !is_judged_by_promise(results, cell);
                               }) ||
           broken_promises(results) > 0 || std::ranges::any_of(results.checks, has_crashed);
}

} // namespace boxwood::bench
