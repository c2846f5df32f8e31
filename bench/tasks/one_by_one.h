#pragma once

#include "bench/tasks/contender.h"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// Calls `function` for one case after the other; `answers` is the list of Answers that it fills.
/// `Input` is a case in the function's own numbers or types, made before timing.
template <class Input, auto answers, class Function> class OneByOne final : public Contender {
  public:
    OneByOne(std::vector<Input> inputs, Function function)
        : inputs_(std::move(inputs)), function_(std::move(function)) {}

    void build() override {}
    void query(Answers& all) override {
        auto& out = all.*answers;
        out.resize(inputs_.size());
        for (std::size_t i = 0; i < inputs_.size(); ++i)
            out[i] = function_(inputs_[i]);
    }

  private:
    std::vector<Input> inputs_;
    Function function_;
};
template <auto answers, class Input, class Function>
std::unique_ptr<Contender> one_by_one(std::vector<Input> inputs, Function function) {
    return std::make_unique<OneByOne<Input, answers, Function>>(std::move(inputs),
                                                                std::move(function));
}

} // namespace boxwood::bench
