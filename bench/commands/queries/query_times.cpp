#include "bench/commands/queries/query_times.h"

#include "bench/analysis/statistics.h"
#include "bench/io/json.h"
#include "bench/io/say.h"
#include "bench/io/text_table.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

constexpr double budget_s = 0.2;
constexpr double min_sample_s = 20e-6; ///< a thousand times what reading the clock takes

} // namespace

/// Batches double until one is long enough for the clock; each of those is a sample.
void QueryTimes::repeat(double first_s, double share, const std::function<void()>& question) {
    const bool is_first = first_s_ < 0;
    if (is_first)
        first_s_ = first_s;
    const double most_s = budget_s * share;
    const std::size_t samples_before = samples_.size();
    const Clock::time_point begin = Clock::now();
    for (std::size_t batch = 1; first_s < most_s && seconds_since(begin) < most_s;) {
        const Clock::time_point start = Clock::now();
        for (std::size_t i = 0; i < batch; ++i)
            question();
        const double batch_s = seconds_since(start);
        if (batch_s < min_sample_s) {
            batch *= 2;
            continue;
        }
        samples_.push_back(batch_s / static_cast<double>(batch));
        runs_ += batch;
    }
    if (samples_.size() == samples_before) {
        samples_.push_back(first_s);
        ++runs_;
    }
}

double QueryTimes::query_s() const {
    std::vector<double> sorted = samples_;
    std::ranges::sort(sorted);
    return sorted.empty() ? 0 : median_of_sorted(sorted);
}

std::string QueryTimes::json() const {
    if (!are_wanted_)
        return "";
    return fmt::format(",\"read_seconds\":{},\"build_seconds\":{},\"first_query_seconds\":{},"
                       "\"query_seconds\":{},\"query_runs\":{}",
                       json_number(read_s_), json_number(build_s_), json_number(first_s_),
                       json_number(query_s()), runs_);
}

void QueryTimes::report() const {
    if (are_wanted_)
        say(fmt::format(
            "boxwood: read in {}, trees built in {}, answered in {} (median of {} run{}; "
            "the first took {})\n",
            time_text(1e9 * read_s_), time_text(1e9 * build_s_), time_text(1e9 * query_s()), runs_,
            runs_ == 1 ? "" : "s", time_text(1e9 * first_s_)));
}

void add_times_option(CLI::App& app, bool& are_wanted) {
    app.add_flag("--times", are_wanted,
                 "say on stderr, with --json in the object, how long it took to read the files, to "
                 "build the trees, and to answer: the first time, in cold caches, and the median "
                 "when the same is answered again for a fifth of a second; printing is not timed");
}

} // namespace boxwood::bench
