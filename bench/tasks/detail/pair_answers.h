#pragma once

#include "bench/tasks/task.h"
#include "bench/truth/pairs_digest.h"

namespace boxwood::bench {

/// A task of kind Base whose answers are pairs in any order, each once: of two items, the lower one
/// first, or of a query and an item.
template <class Base> class PairAnswers : public Base {
  public:
    using Base::Base;
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<Pair>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        return digest_of(list_of<Pair>(answers)).hash;
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"pairs", answers.size()}};
        Task::append_work(counts, work);
        return counts;
    }
};

} // namespace boxwood::bench
