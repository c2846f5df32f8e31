#pragma once

#include "bench/tasks/contender.h"

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// Calls `function` for one case after the other. `Input` is a case in the function's own numbers
/// or types, made before timing; what the function gives is the list of the answers.
template <class Input, class Function> class OneByOne final : public Contender {
  public:
    OneByOne(std::vector<Input> inputs, Function function)
        : inputs_(std::move(inputs)), function_(std::move(function)) {}

    void build() override {}
    void query(Answers& answers) override {
        using Answer = std::invoke_result_t<Function&, Input&>;
        static_assert(std::is_trivially_destructible_v<Answer>);
        auto& out = list_of<Answer>(answers);
        out.resize(inputs_.size());
        for (std::size_t i = 0; i < inputs_.size(); ++i)
            new (&out[i]) Answer(function_(inputs_[i])); // in place: a copy may take longer
    }

  private:
    std::vector<Input> inputs_;
    Function function_;
};
template <class Input, class Function>
std::unique_ptr<Contender> one_by_one(std::vector<Input> inputs, Function function) {
    return std::make_unique<OneByOne<Input, Function>>(std::move(inputs), std::move(function));
}

} // namespace boxwood::bench
