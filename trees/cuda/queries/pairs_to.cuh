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

/// Those that a warp found for one query: all of its lanes call together. In any order they are
/// held back in shared memory, so that one place is taken for many, and they are written side by
/// side.
template <Pass pass, class Answer> class WarpAnswers {
  public:
    /// Of the warp's own answers in `held`; none are held but by Pass::capped.
    static constexpr unsigned n_held = pass == Pass::capped ? 128 : 1;

    __device__ WarpAnswers(const AnswersTo<Answer>& to, std::uint64_t query, Answer* held)
        : to_(to), query_(query), at_(pass == Pass::fill ? to.at[query] : 0), held_(held) {}

    /// make() gives the answer of a lane that has one.
    template <class Make> __device__ void add(bool has, const Make& make) {
        if constexpr (pass == Pass::count) {
            at_ += has;
            return;
        }
        const unsigned all = __ballot_sync(~0u, has);
        if (all == 0)
            return;
        const std::uint64_t place = at_ + lanes_below(all);
        if (has)
            (pass == Pass::fill ? to_.answers : held_)[place] = make();
        at_ += static_cast<unsigned>(__popc(all));
        if (pass == Pass::capped && at_ > n_held - 32)
            write();
    }
    /// After the last one.
    __device__ void finish() {
        if constexpr (pass == Pass::count) {
            for (unsigned step = 16; step > 0; step /= 2)
                at_ += __shfl_xor_sync(~0u, at_, step);
            if (threadIdx.x % 32 == 0)
                to_.at[query_] = at_;
        } else if (pass == Pass::capped && at_ > 0) {
            write();
        }
    }

  private:
    __device__ void write() {
        const unsigned n = static_cast<unsigned>(at_), lane = threadIdx.x % 32;
        std::uint64_t first = 0;
        if (lane == 0)
            first = to_.take(n);
        first = __shfl_sync(~0u, first, 0);
        __syncwarp(); // what the others hold is there
        for (unsigned i = lane; i < n; i += 32)
            if (first + i < to_.room)
                to_.answers[first + i] = held_[i];
        __syncwarp(); // all have read what is now written over
        at_ = 0;
    }

    const AnswersTo<Answer>& to_;
    std::uint64_t query_, at_;
    Answer* held_;
};

/// Pairs in any order, found by the threads of a warp: each holds some back, so that one place is
/// taken for those of all of them.
class HeldPairs {
  public:
    __device__ explicit HeldPairs(const PairsTo& to) : to_(to) {}

    __device__ void add(const Pair& pair) {
        if (n_ == most) {
            write(to_.take(most));
            n_ = 0;
        }
        held_[n_++] = pair;
    }
    /// After the last one, by all lanes of the warp together.
    __device__ void finish() {
        const unsigned lane = threadIdx.x % 32;
        unsigned up_to_here = n_;
        for (unsigned step = 1; step < 32; step *= 2) {
            const unsigned before = __shfl_up_sync(~0u, up_to_here, step);
            up_to_here += lane < step ? 0 : before;
        }
        std::uint64_t first = 0;
        if (lane == 31 && up_to_here > 0)
            first = to_.take(up_to_here);
        write(__shfl_sync(~0u, first, 31) + up_to_here - n_);
    }

  private:
    static constexpr unsigned most = 8;

    __device__ void write(std::uint64_t first) {
        for (unsigned i = 0; i < n_; ++i)
            if (first + i < to_.room)
                to_.answers[first + i] = held_[i];
    }

    const PairsTo& to_;
    Pair held_[most];
    unsigned n_ = 0;
};

/// find(answers): the pairs of one slot, by a thread that is there. All lanes of a warp come here.
template <Pass pass, class Find>
__device__ void answer_pairs(const PairsTo& to, std::uint32_t slot, bool is_there,
                             const Find& find) {
    if constexpr (pass == Pass::capped) {
        HeldPairs held(to);
        if (is_there)
            find(held);
        held.finish();
    } else if (is_there) {
        ThreadAnswers<pass, Pair> answers(to, slot);
        find(answers);
        answers.finish();
    }
}

template <bool is_self> __device__ Pair pair_of(std::uint32_t x, std::uint32_t y) {
    return is_self && y < x ? Pair{y, x} : Pair{x, y};
}

} // namespace boxwood::cuda
