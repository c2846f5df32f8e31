#pragma once

#include "trees/cuda/launch.h"
#include "trees/queries/sinks.h"

namespace boxwood::cuda {

/// What a pass does with the answers that it finds. The first two together give each query, which
/// for pairs is a leaf of `a`, its own place, so that the order is the same each time.
enum class Pass : std::uint8_t {
    count, ///< at[query] becomes the number of answers of that query
    fill,  ///< those of a query go to answers[at[query]] and on
    capped ///< in any order; at[0] counts them all, those beyond `room` are left out
};

template <class Answer> struct AnswersTo {
    std::uint64_t* at;
    Answer* answers;
    std::uint64_t room; ///< of answers; of Pass::capped alone

    /// The first of n places of Pass::capped.
    __device__ std::uint64_t take(unsigned n) const {
        return atomicAdd(reinterpret_cast<unsigned long long*>(at), // the same, by another name
                         static_cast<unsigned long long>(n));
    }
};

using PairsTo = AnswersTo<Pair>;

/// How many lanes of the mask come before this one.
__device__ inline unsigned lanes_below(unsigned mask) {
    return static_cast<unsigned>(__popc(mask & ((1u << threadIdx.x % 32) - 1)));
}

/// The answers of one query, found by one thread.
template <Pass pass, class Answer> class ThreadAnswers {
  public:
    __device__ ThreadAnswers(const AnswersTo<Answer>& to, std::uint32_t query)
        : to_(to), query_(query), at_(pass == Pass::fill ? to.at[query] : 0) {}

    __device__ void add(const Answer& answer) {
        const std::uint64_t place = pass == Pass::capped ? to_.take(1) : at_;
        if (pass == Pass::fill || (pass == Pass::capped && place < to_.room))
            to_.answers[place] = answer;
        ++at_;
    }
    /// Forgets those of this query; not of Pass::capped, whose places others have.
    __device__ void restart() {
        static_assert(pass != Pass::capped);
        at_ = pass == Pass::fill ? to_.at[query_] : 0;
    }
    /// After the last one.
    __device__ void finish() const {
        if constexpr (pass == Pass::count)
            to_.at[query_] = at_;
    }

  private:
    const AnswersTo<Answer>& to_;
    std::uint32_t query_;
    std::uint64_t at_;
};

/// Those that a warp found for one query: all of its lanes call together.
template <Pass pass, class Answer> class WarpAnswers {
  public:
    __device__ WarpAnswers(const AnswersTo<Answer>& to, std::uint64_t query)
        : to_(to), query_(query), at_(pass == Pass::fill ? to.at[query] : 0) {}

    /// make() gives the answer of a lane that has one.
    template <class Make> __device__ void add(bool has, const Make& make) {
        if constexpr (pass == Pass::count) {
            at_ += has;
            return;
        }
        const unsigned all = __ballot_sync(~0u, has);
        if (all == 0)
            return;
        const auto n = static_cast<unsigned>(__popc(all));
        std::uint64_t first = at_;
        if constexpr (pass == Pass::capped) {
            if (threadIdx.x % 32 == 0)
                first = to_.take(n);
            first = __shfl_sync(~0u, first, 0);
        }
        const std::uint64_t place = first + lanes_below(all);
        if (has && (pass == Pass::fill || place < to_.room))
            to_.answers[place] = make();
        at_ += n;
    }
    /// After the last one.
    __device__ void finish() {
        if constexpr (pass == Pass::count) {
            for (unsigned step = 16; step > 0; step /= 2)
                at_ += __shfl_xor_sync(~0u, at_, step);
            if (threadIdx.x % 32 == 0)
                to_.at[query_] = at_;
        }
    }

  private:
    const AnswersTo<Answer>& to_;
    std::uint64_t query_, at_;
};

template <bool is_self> __device__ Pair pair_of(std::uint32_t x, std::uint32_t y) {
    return is_self && y < x ? Pair{y, x} : Pair{x, y};
}

} // namespace boxwood::cuda
