#include "bench/analysis/screen.h"

#include "bench/analysis/statistics.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

using results::Finding;
using results::Health;
using results::Topic;

constexpr std::size_t columns = 100;

std::string cut(const std::string& text, std::size_t width = columns) {
    return text.size() <= width ? text : text.substr(0, width - 3) + "...";
}

std::string trust_text(const Health& health) {
    std::string text = fmt::format("{} rounds, {:.1f} % of the samples disturbed; ", health.rounds,
                                   health.samples ? 100.0 * static_cast<double>(health.disturbed) /
                                                        static_cast<double>(health.samples)
                                                  : 0.0);
    if (std::isnan(health.floor))
        text += "noise floor not known";
    else
        text += fmt::format("noise floor {:.1f} %", 100 * health.floor);
    if (health.is_too_noisy)
        return text + ": too noisy";
    if (health.rounds < min_pairs_verdict)
        return text + fmt::format(": {} rounds give verdicts", min_pairs_verdict);
    return text + (std::isnan(health.floor) ? ": no cell was timed twice" : ": quiet enough");
}

std::string answers_text(const Health& health) {
    std::string text = fmt::format("{} answers checked: {} of ours wrong, {} of the peers' wrong",
                                   health.answers, health.wrong_ours, health.wrong_peers);
    if (health.broken_promises > 0)
        text += fmt::format("; {} BROKEN PROMISES", health.broken_promises);
    return text;
}

/// The headings of the four columns of a topic.
std::vector<std::string> headings_of(Topic topic) {
    switch (topic) {
    case Topic::kernel:
        return {"kernels on hard cases", "cheapest, a call", "against our fastest", "errors"};
    case Topic::scene:
        return {"moving scenes", "what they require", "with all stages", "interval"};
    default:
        return {"rival's time / ours", "build + query", "query alone", "interval"};
    }
}

/// The rows of one topic; the questions are cut so that all answers are seen.
std::string table_text(std::span<const Finding* const> findings) {
    const auto headings = headings_of(findings.front()->topic);
    std::size_t answers = 0;
    for (const auto& [column, heading] :
         {std::pair{&Finding::together, 1}, {&Finding::alone, 2}, {&Finding::certainty, 3}}) {
        std::size_t width = headings[static_cast<std::size_t>(heading)].size();
        for (const Finding* finding : findings)
            width = std::max(width, (finding->*column).size());
        answers += 2 + width;
    }
    const std::size_t room = answers + 20 < columns ? columns - answers : 20;
    TextTable table(headings);
    for (const Finding* finding : findings)
        table.add(
            {cut(finding->question, room), finding->together, finding->alone, finding->certainty});
    std::string text;
    std::istringstream in(table.text());
    for (std::string line; std::getline(in, line);)
        text += cut(line) + "\n";
    return text;
}

} // namespace

std::string screen_text(const results::Results& results, std::size_t max_lines) {
    const Health health = results.health.empty() ? Health{} : results.health.front();
    std::string text = cut(trust_text(health)) + "\n" + cut(answers_text(health)) + "\n";
    if (health.is_too_noisy)
        return text + "\nREPEAT THIS: the same work timed twice differed by more than 20 %, so no "
                      "time here means anything.\nClose other programs (`boxwood doctor` says "
                      "which settings disturb) and measure again.\n";
    std::vector<std::vector<const Finding*>> topics;
    for (const Topic topic : {Topic::race, Topic::kernel, Topic::scene}) {
        std::vector<const Finding*> headlines;
        for (const Finding& finding : results.findings)
            if (finding.topic == topic && finding.is_headline)
                headlines.push_back(&finding);
        if (!headlines.empty())
            topics.push_back(std::move(headlines));
    }
    // Two lines are taken, each topic takes two more, and the last may say that there is more.
    std::size_t left = max_lines - 3 - 2 * topics.size(), shown = 0;
    for (std::size_t topic = 0; topic < topics.size(); ++topic) {
        std::size_t others = 0; // lines that later topics need at least
        for (std::size_t later = topic + 1; later < topics.size(); ++later)
            others += std::min(topics[later].size(), left / topics.size());
        const std::size_t n = std::min(topics[topic].size(), left - others);
        text += "\n" + table_text(std::span(topics[topic]).first(n));
        left -= n;
        shown += n;
    }
    if (const std::size_t more = results.findings.size() - shown; more > 0)
        text += fmt::format("and {} more: boxwood show FILE.h5 --all\n", more);
    return text;
}

std::string paths_text(const std::filesystem::path& file) {
    std::string text = fmt::format("\nresults  {}\n", file.string());
    const auto add = [&](const char* what, const std::string& ending, const char* mark) {
        const std::filesystem::path path = file.parent_path() / (file.stem().string() + ending);
        if (std::filesystem::exists(path))
            text += fmt::format("{}  {}{}\n", what, path.string(), mark);
    };
    add("report ", ".html", "");
    add("figures", "-figures", "/");
    return text;
}

} // namespace boxwood::bench
