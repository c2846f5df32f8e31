#pragma once

#include "bench/tasks/contender.h"

/// What the peers say when they cannot do a job.
namespace boxwood::bench {

using Unsupported = std::optional<std::string>;

inline Unsupported not_box_ask(const Job& job) {
    if (job.task == Ask::pairs || job.task == Ask::tree_pairs)
        return std::nullopt;
    return "answers pairs and tree_pairs only";
}

/// Of those that take new boxes frame after frame, too.
inline Unsupported not_frame_or_box_ask(const Job& job) {
    return job.task == Ask::moving_pairs ? std::nullopt : not_box_ask(job);
}

inline Unsupported not_serial(const Job& job) {
    if (job.executor == "serial" && job.threads == 1)
        return std::nullopt;
    return "runs on one thread only";
}

inline Unsupported not_tbb(const Job& job) {
    if (job.executor == "tbb" || (job.executor == "serial" && job.threads == 1))
        return std::nullopt;
    return "runs on TBB only";
}

/// The pair of two items in the order that Answers wants.
inline Pair ordered_pair(std::uint32_t a, std::uint32_t b) {
    return a < b ? Pair{a, b} : Pair{b, a};
}

} // namespace boxwood::bench
