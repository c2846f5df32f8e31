#include "bench/analysis/findings.h"

#include "bench/analysis/findings/draft.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

namespace boxwood::bench {
namespace {

using results::Finding;
using results::Results;
using results::Topic;

/// The worst for us first.
void sort(std::vector<Draft>& drafts) {
    std::ranges::stable_sort(drafts, {}, [](const Draft& draft) {
        return std::tuple(draft.finding.topic, draft.outcome, draft.ratio);
    });
}

/// Marks one finding per question, of sorted ones: the first of the largest size.
void mark_headlines(std::vector<Draft>& drafts, const Index& index) {
    const auto question_of = [&](const Draft& draft) {
        return std::tuple(draft.finding.topic, draft.question,
                          index.scene(draft.finding.scene_id).name, draft.finding.contender_class);
    };
    std::map<decltype(question_of(drafts.front())), std::uint64_t> largest;
    for (const Draft& draft : drafts)
        if (draft.finding.topic != Topic::kernel)
            largest[question_of(draft)] = std::max(largest[question_of(draft)], draft.n_items);
    for (Draft& draft : drafts) {
        if (draft.finding.topic == Topic::kernel)
            continue;
        std::uint64_t& n = largest[question_of(draft)];
        draft.finding.is_headline = n == draft.n_items;
        if (draft.finding.is_headline)
            n = 0;
    }
}

/// What is shortened on a screen is its end, and so the name of the scene.
std::string question_text(const Draft& draft) {
    switch (draft.finding.topic) {
    case Topic::race:
    case Topic::call:
    case Topic::device:
        return draft.question + draft.how + ", " + draft.where;
    case Topic::scene:
        return draft.where + draft.how;
    default:
        return draft.question;
    }
}

} // namespace

void describe(Draft& draft, const Index& index, const results::Cell& cell) {
    const results::SceneRow& scene = index.scene(cell.scene_id);
    Finding& row = draft.finding;
    row.scene_id = cell.scene_id;
    row.task = cell.task;
    row.threads = cell.threads;
    draft.question = index.task(cell.task).title;
    if (!scene.rays.empty())
        draft.question += ", " + spaced(scene.rays) + " rays";
    draft.n_items = cell.n_items;
    draft.where = scene.human_name.empty() ? spaced(scene.name) + " " + count_words(cell.n_items)
                                           : scene.human_name;
    if (!row.contender_class.empty())
        draft.how += ", " + row.contender_class;
    if (row.threads > 1)
        draft.how += fmt::format(", {} threads", row.threads);
}

std::vector<Finding> findings_of(const Results& results) {
    if (!results.health.empty() && results.health.front().is_too_noisy)
        return {};
    const Index index(results);
    const MedianIndex medians(results);
    std::vector<Draft> drafts = race_findings(index, medians);
    std::ranges::move(kernel_findings(index), std::back_inserter(drafts));
    std::ranges::move(scene_findings(index, medians), std::back_inserter(drafts));
    std::ranges::move(device_findings(index), std::back_inserter(drafts));
    sort(drafts);
    mark_headlines(drafts, index);
    std::vector<Finding> findings;
    for (Draft& draft : drafts) {
        draft.finding.place = static_cast<std::uint32_t>(findings.size());
        draft.finding.is_loss = draft.outcome == Outcome::loses;
        draft.finding.question = question_text(draft);
        findings.push_back(std::move(draft.finding));
    }
    return findings;
}

std::vector<results::TopicRow> topics() {
    return {{Topic::race, "against the best rival, losses first", "rival's best time / our best",
             "build + query", "query alone", "interval (of which)"},
            {Topic::call,
             "a call of a kernel against the best rival, both always right, losses first",
             "rival's best time / our best", "a call", "", "interval"},
            {Topic::kernel, "kernels on hard cases", "kernels on hard cases", "cheapest, a call",
             "against our fastest", "errors"},
            {Topic::scene, "moving scenes, a frame", "moving scenes", "what they require",
             "with all stages", "interval"},
            {Topic::device, "on a device, from the host's boxes to the host's answers",
             "on a device, end to end", "against the CPU's best", "the largest", "interval"}};
}

} // namespace boxwood::bench
