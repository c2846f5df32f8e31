#pragma once

#include <cstdint>

namespace boxwood {

/// What a traversal did: counts that do not depend on the machine's mood. They come from a separate
/// counted pass; in the timed one the counting is compiled away.
struct Work {
    std::uint64_t node_visits = 0; ///< nodes or blocks opened
    std::uint64_t box_tests = 0;   ///< box-box or ray-box tests (a SIMD test of k lanes counts k)
    std::uint64_t triangle_tests = 0; ///< ray-triangle tests (of k lanes: k)
    std::uint64_t answers = 0;        ///< pairs or hits reported
    std::uint64_t stack_max = 0;      ///< most entries on a traversal stack

    Work& operator+=(const Work& other) {
        node_visits += other.node_visits;
        box_tests += other.box_tests;
        triangle_tests += other.triangle_tests;
        answers += other.answers;
        stack_max = other.stack_max > stack_max ? other.stack_max : stack_max;
        return *this;
    }
};

} // namespace boxwood
