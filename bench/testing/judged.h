#pragma once

#include "bench/tasks/task.h"
#include "bench/truth/judging/tally.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// A contender of ours with a promise, whose answers a test makes up.
inline ContenderEntry named(Promise promise, const std::string& precision = "f64") {
    ContenderEntry contender;
    contender.name = "made_up";
    contender.promise = promise;
    contender.precision = precision;
    return contender;
}

/// By the row that a result file has of it.
inline bool is_broken(const Judgement& judgement) {
    results::KernelRow row = judgement.kernel.value();
    row.status = judgement.status;
    return breaks_promise(row);
}

inline Judgement judged(const Scene& scene, std::string_view task, const Answers& answers,
                        const ContenderEntry& contender) {
    return find_task(task)->make_truth(scene, 2)->judge(answers, contender);
}

template <class T> AnswerList<T> answers_of(std::vector<T> list) {
    AnswerList<T> answers;
    answers.list = std::move(list);
    return answers;
}

} // namespace boxwood::bench
