#pragma once

#include "trees/executor.h"

#include <memory>
#include <string>
#include <vector>

namespace boxwood {

/// An executor, with its name and threads for messages.
struct ExecutorToTry {
    std::string name;
    std::unique_ptr<Executor> run;
};

/// Each executor of the registry with those of 1, 2 and 4 threads that it can have.
inline std::vector<ExecutorToTry> every_executor() {
    std::vector<ExecutorToTry> all;
    for (const ExecutorEntry& entry : executors())
        for (const unsigned threads : {1u, 2u, 4u})
            if (threads <= entry.max_threads)
                all.push_back({std::string(entry.name) + " on " + std::to_string(threads),
                               entry.make(threads)});
    return all;
}

/// Those of more than one thread.
inline std::vector<ExecutorToTry> parallel_executors() {
    std::vector<ExecutorToTry> all = every_executor();
    std::erase_if(all, [](const ExecutorToTry& e) { return e.run->threads() == 1; });
    return all;
}

} // namespace boxwood
