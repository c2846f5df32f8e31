#pragma once

#include "bench/tasks/answers.h"
#include "trees/tree.h"

namespace boxwood::bench {

/// Of the task build: the tree that was built, which lives until the next build. It is handed out
/// by the query, which is not timed.
struct TreeAnswers final : Answers {
    const Tree* tree = nullptr;

    std::size_t size() const override { return tree ? tree->size() : 0; }
    void reserve(std::size_t) override {}
};

} // namespace boxwood::bench
