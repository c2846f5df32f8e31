#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boxwood {

/// Answers to n queries: those to query i are of[offsets[i]] up to of[offsets[i + 1]].
template <class T> struct AnswersOf {
    std::vector<std::uint64_t> offsets; ///< n + 1
    std::vector<T> of;

    std::size_t size() const { return offsets.empty() ? 0 : offsets.size() - 1; }
    std::span<const T> operator[](std::size_t i) const {
        return {of.data() + offsets[i], of.data() + offsets[i + 1]};
    }
};

} // namespace boxwood
