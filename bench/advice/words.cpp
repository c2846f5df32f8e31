#include "bench/advice/advice.h"

#include "bench/analysis/wording.h"
#include "bench/io/json.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

/// 41234.5 as "41,000": no more figures than are meant.
std::string about(double n) {
    if (!(n >= 1))
        return "0";
    const double unit = std::pow(10., std::max(0., std::floor(std::log10(n)) - 1));
    std::string digits = fmt::format("{:.0f}", std::round(n / unit) * unit);
    for (std::size_t at = digits.size(); at > 3;) {
        at -= 3;
        digits.insert(at, 1, ',');
    }
    return digits;
}

std::string range(const MedianInterval& interval) {
    return std::isnan(interval.lo)
               ? "too few rounds for an interval"
               : fmt::format("{} to {}", about(interval.lo), about(interval.hi));
}

std::string cpp_lines(const Advice& advice, const Way& way) {
    const bool is_mesh = advice.task.starts_with("rays");
    return fmt::format("    boxwood::{0} bvh({1}, {{.builder = boxwood::make_builder(\"{2}\"),\n"
                       "        .layout = boxwood::LayoutName::{3}{4}}});",
                       is_mesh ? "MeshBvh" : "Bvh", is_mesh ? "vertices, triangles" : "boxes",
                       way.builder, way.layout,
                       advice.threads > 1 ? fmt::format(", .threads = {}", advice.threads) : "");
}
std::string python_line(const Advice& advice, const Way& way) {
    const bool is_mesh = advice.task.starts_with("rays");
    return fmt::format("    bvh = boxwood.{}({}, builder=\"{}\", layout=\"{}\"{})",
                       is_mesh ? "MeshBvh" : "Bvh", is_mesh ? "vertices, faces" : "boxes",
                       way.builder, way.layout,
                       advice.threads > 1 ? fmt::format(", threads={}", advice.threads) : "");
}

/// "Up to 40,000 rays per build use A, above it B (...)."
std::string rule_text(const Advice& advice) {
    const auto name = [&](std::size_t i) { return advice.ways[advice.front[i]].name; };
    if (advice.front.size() == 1)
        return fmt::format("Use {} for any number of {} per build: no other way was seen to build "
                           "or answer faster, by more than noise.\n",
                           name(0), advice.query_word);
    std::string text;
    for (std::size_t i = 0; i < advice.steps.size(); ++i) {
        const Step& step = advice.steps[i];
        const PairedRatio& query = step.query;
        text +=
            fmt::format("Up to {} {} per build ({}) use {}, above it {} ({} as fast once built).\n",
                        about(step.queries.mid), advice.query_word, range(step.queries), name(i),
                        name(i + 1), interval_text(query.ratio, query.ci_lo, query.ci_hi));
    }
    return text;
}

/// "From about 430,000 rays per build on Embree: x is faster than all of ours (...)."
std::string losses_text(const Advice& advice) {
    std::string text;
    for (const Loss& loss : advice.losses) {
        const std::string range =
            std::isnan(loss.to)
                ? fmt::format("From about {} {} per build on,", about(loss.from), advice.query_word)
                : fmt::format("From about {} to {} {} per build", about(loss.from), about(loss.to),
                              advice.query_word);
        text +=
            fmt::format("{} {} is faster than all of ours; once built, it takes {}x the time.\n",
                        range, fmt::join(loss.peers, " or "), ratio_text(loss.query_ratio));
    }
    return text;
}

} // namespace

std::string advice_text(const Advice& advice) {
    const Way& best = advice.ways[advice.best];
    const double queries = advice.wanted.value_or(advice.n_queries);
    std::string text = fmt::format("{}, {}\n\n{}", advice.scene, advice.task, rule_text(advice));
    text += fmt::format("For {} {} per build: {} ({} to build, {} each).\n", about(queries),
                        advice.query_word, best.name, time_text(best.build_ns),
                        time_text(best.query_ns / advice.n_queries));
    if (!advice.as_good.empty()) {
        constexpr std::size_t most = 5;
        text += fmt::format("Not told apart from it there (noise floor {:.1f} %): ",
                            100 * advice.floor);
        for (std::size_t i = 0; i < std::min(most, advice.as_good.size()); ++i)
            text += (i == 0 ? "" : ", ") + advice.ways[advice.as_good[i]].name;
        text += advice.as_good.size() > most
                    ? fmt::format(" and {} more.\n", advice.as_good.size() - most)
                    : ".\n";
    }
    if (advice.rival)
        text += fmt::format("{} would take {} as long{}.\n", advice.rival->name,
                            interval_text(advice.rival_ratio.ratio, advice.rival_ratio.ci_lo,
                                          advice.rival_ratio.ci_hi),
                            advice.is_rival_distinct ? "" : ", which is not told apart from it");
    text += losses_text(advice);
    text += fmt::format("\nC++:\n{}\nPython:\n{}\n", cpp_lines(advice, best),
                        python_line(advice, best));
    text += fmt::format("\n{:<34} {:>10} {:>12}\n", "timed", "build",
                        advice.n_queries > 1 ? "per query" : "query");
    const auto row = [&](const Way& way, std::string_view mark) {
        return fmt::format("{:<34} {:>10} {:>12} {}\n", way.name, time_text(way.build_ns),
                           time_text(way.query_ns / advice.n_queries), mark);
    };
    // Of many those that are near the best for some number of queries.
    constexpr std::size_t most = 24;
    const auto is_near = [&](const Way& way) {
        for (double n = 1; n < 1e12; n *= 4) {
            const auto total = [&](const Way& w) { return total_ns(advice, w, n); };
            if (total(way) <= 1.1 * total(std::ranges::min(advice.ways, {}, total)))
                return true;
        }
        return false;
    };
    for (std::size_t i = 0; i < advice.ways.size(); ++i) {
        if (advice.ways.size() > most && !is_near(advice.ways[i]))
            continue;
        const bool on_front = std::ranges::find(advice.front, i) != advice.front.end();
        text += row(advice.ways[i], i == advice.best ? "<- take this" : on_front ? "front" : "");
    }
    if (advice.rival)
        text += row(*advice.rival, "best peer");
    return text;
}

std::string advice_json(const Advice& advice) {
    const auto interval = [](double mid, double lo, double hi) {
        return fmt::format(R"({{"value":{},"lo":{},"hi":{}}})", json_number(mid), json_number(lo),
                           json_number(hi));
    };
    const auto way = [&](const Way& w) {
        return fmt::format(R"({{"name":{},"builder":{},"layout":{},"build_ns":{},"query_ns":{}}})",
                           json_string(w.name), json_string(w.builder), json_string(w.layout),
                           interval(w.build.mid, w.build.lo, w.build.hi),
                           interval(w.query.mid / advice.n_queries, w.query.lo / advice.n_queries,
                                    w.query.hi / advice.n_queries));
    };
    std::string ways, front, steps, as_good;
    for (const Way& w : advice.ways)
        ways += (ways.empty() ? "" : ",") + way(w);
    for (const std::size_t i : advice.as_good)
        as_good += (as_good.empty() ? "" : ",") + json_string(advice.ways[i].name);
    for (const std::size_t i : advice.front)
        front += (front.empty() ? "" : ",") + json_string(advice.ways[i].name);
    for (const Step& step : advice.steps)
        steps += fmt::format(R"({}{{"break_even":{},"query_ratio":{}}})", steps.empty() ? "" : ",",
                             interval(step.queries.mid, step.queries.lo, step.queries.hi),
                             interval(step.query.ratio, step.query.ci_lo, step.query.ci_hi));
    std::string losses;
    for (const Loss& loss : advice.losses)
        losses +=
            fmt::format(R"({}{{"from":{},"to":{},"peers":[{}],"query_ratio":{}}})",
                        losses.empty() ? "" : ",", json_number(loss.from), json_number(loss.to),
                        fmt::join(json_strings(loss.peers), ","), json_number(loss.query_ratio));
    const Way& best = advice.ways[advice.best];
    return fmt::format(
        R"({{"task":{},"scene":{},"threads":{},"noise_floor":{},"queries_per_build":{},"best":{},)"
        R"("as_good":[{}],"front":[{}],"steps":[{}],"rival":{},"rival_ratio":{},)"
        R"("is_rival_distinct":{},"losses":[{}],"ways":[{}],"cpp":{},"python":{}}})"
        "\n",
        json_string(advice.task), json_string(advice.scene), advice.threads,
        json_number(advice.floor), json_number(advice.wanted.value_or(advice.n_queries)),
        json_string(best.name), as_good, front, steps, advice.rival ? way(*advice.rival) : "null",
        interval(advice.rival_ratio.ratio, advice.rival_ratio.ci_lo, advice.rival_ratio.ci_hi),
        advice.is_rival_distinct, losses, ways, json_string(cpp_lines(advice, best)),
        json_string(python_line(advice, best)));
}

} // namespace boxwood::bench
