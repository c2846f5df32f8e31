#pragma once

#include "bench/tasks/contender.h"
#include "bench/tasks/detail/halves.h"
#include "trees/queries/sinks.h"

#include <memory>
#include <string>
#include <vector>

/// What the files of the peers share.
namespace boxwood::bench {

/// A contender that answers a task as a C, made of the job and further arguments.
template <class C, class... More> Answering answering(std::string task, More... more) {
    return {std::move(task), [more...](const Job& job) -> std::unique_ptr<Contender> {
                return std::make_unique<C>(job, more...);
            }};
}

/// Which boxes a contender finds pairs of.
enum class Sides : std::uint8_t {
    all,       ///< pairs, moving_pairs
    two_halves ///< tree_pairs
};

/// A C of every task of pairs of boxes: C(job, sides, more...).
template <class C, class... More> std::vector<Answering> answering_pairs(More... more) {
    return {answering<C>("pairs", Sides::all, more...),
            answering<C>("tree_pairs", Sides::two_halves, more...)};
}
/// The same where the contender takes new boxes frame after frame, too.
template <class C, class... More> std::vector<Answering> answering_all_pairs(More... more) {
    std::vector<Answering> all = answering_pairs<C>(more...);
    all.push_back(answering<C>("moving_pairs", Sides::all, more...));
    return all;
}

/// The pair of two items in the order that pairs have.
inline Pair ordered_pair(std::uint32_t a, std::uint32_t b) {
    return a < b ? Pair{a, b} : Pair{b, a};
}

} // namespace boxwood::bench
