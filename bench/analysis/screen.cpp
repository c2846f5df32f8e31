#include "bench/analysis/screen.h"

#include "bench/analysis/index.h"
#include "bench/analysis/wording.h"
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
using results::TopicRow;

constexpr std::size_t columns = 120;

std::string cut(const std::string& text, std::size_t width = columns) {
    return text.size() <= width ? text : text.substr(0, width - 3) + "...";
}

/// Lines of at most `columns`, broken between words.
std::string wrapped(const std::string& text) {
    std::string lines, line;
    std::istringstream in(text);
    for (std::string word; in >> word; line += (line.empty() ? "" : " ") + word)
        if (!line.empty() && line.size() + 1 + word.size() > columns)
            lines += std::exchange(line, "") + "\n";
    return line.empty() ? lines : lines + line + "\n";
}

/// The rows of one topic; the questions are cut so that all answers are seen.
std::string table_text(const TopicRow& topic, std::span<const Finding* const> findings) {
    const std::vector<std::string> headings{topic.question, topic.together, topic.alone,
                                            topic.certainty};
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

/// Of the first scene and task on a device the sizes: so many rows.
std::size_t sizes_on_screen(const results::Results& results) {
    constexpr std::size_t most = 6;
    return results.device_break_even.empty()
               ? 0
               : std::min<std::size_t>(most, results.device_break_even.front().n_sizes);
}

} // namespace

std::string devices_text(const results::Results& results, std::size_t max_rows) {
    const Index index(results);
    std::uint32_t threads = 0;
    for (const results::DeviceGain& row : results.device_gains)
        threads = std::max(threads, row.threads);
    TextTable table({"our best", ">size", ">1 thread", ">2 threads",
                     fmt::format(">all {}", threads), ">end to end", ">resident", ">device",
                     ">limit", "to best CPU"});
    std::string last;
    for (const results::DeviceGain& row : results.device_gains) {
        if (max_rows-- == 0)
            break;
        const std::string what = fmt::format("{}, {}", index.task(row.task).title,
                                             spaced(index.scene(row.scene_id).name));
        results::Comparison compared;
        compared.verdict = row.verdict;
        compared.ratio = row.ratio;
        table.add({what == last ? "" : cut(what, 32), count_words(row.n), time_text(row.cpu_1_ns),
                   time_text(row.cpu_2_ns), time_text(row.cpu_all_ns), time_text(row.end_to_end_ns),
                   time_text(row.resident_ns), time_text(row.device_ns), time_text(row.limit_ns),
                   std::isnan(row.ratio) ? row.words : outcome_text(compared, "")});
        last = what;
    }
    return table.empty() ? "" : "\n" + table.text();
}

std::string screen_text(const results::Results& results, std::size_t max_lines) {
    if (results.health.empty())
        return "";
    const Health& health = results.health.front();
    std::string text = wrapped(health.trust) + wrapped(health.correctness);
    if (health.is_too_noisy)
        return text + "\n" + wrapped(health.advice);
    const auto taken = static_cast<std::size_t>(std::ranges::count(text, '\n'));
    struct Rows {
        const TopicRow* topic;
        std::vector<const Finding*> findings;
    };
    std::vector<Rows> topics;
    Rows devices;
    for (const TopicRow& topic : results.topics) {
        Rows rows{&topic, {}};
        for (const Finding& finding : results.findings)
            if (finding.topic == topic.topic && finding.is_headline)
                rows.findings.push_back(&finding);
        if (topic.topic == results::Topic::device)
            devices = std::move(rows);
        else if (!rows.findings.empty())
            topics.push_back(std::move(rows));
    }
    // Each topic takes two lines more, and the last may say that there is more.
    const std::size_t fixed = taken + 1 + 2 * topics.size();
    std::size_t left = max_lines > fixed ? max_lines - fixed : 0, shown = 0, losses = 0;
    for (std::size_t topic = 0; topic < topics.size(); ++topic) {
        std::size_t others = 0; // lines that later topics need at least
        for (std::size_t later = topic + 1; later < topics.size(); ++later)
            others += std::min(topics[later].findings.size(), left / topics.size());
        const std::size_t n =
            std::min(topics[topic].findings.size(), left - std::min(left, others));
        if (n > 0)
            text +=
                "\n" + table_text(*topics[topic].topic, std::span(topics[topic].findings).first(n));
        left -= n;
        shown += n;
        for (std::size_t i = 0; i < n; ++i)
            losses += topics[topic].findings[i]->is_loss;
    }
    if (!devices.findings.empty()) {
        const std::size_t n = std::min<std::size_t>(devices.findings.size(), 3);
        text += "\n" + table_text(*devices.topic, std::span(devices.findings).first(n)) +
                devices_text(results, sizes_on_screen(results));
        shown += n;
        for (std::size_t i = 0; i < n; ++i)
            losses += devices.findings[i]->is_loss;
    }
    if (const std::size_t more = results.findings.size() - shown; more > 0)
        text += fmt::format(
            "and {} more ({} losses): boxwood show FILE.h5 --all\n", more,
            static_cast<std::size_t>(std::ranges::count(results.findings, 1u, &Finding::is_loss)) -
                losses);
    return text;
}

std::string findings_text(const results::Results& results) {
    std::string text;
    for (const TopicRow& topic : results.topics) {
        TextTable table({topic.question, topic.together, topic.alone, topic.certainty});
        for (const Finding& row : results.findings)
            if (row.topic == topic.topic)
                table.add({row.question, row.together, row.alone, row.certainty});
        if (!table.empty())
            text += fmt::format("\n{}:\n{}", topic.title, table.text());
    }
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
