#include "bench/truth/moving_truth.h"

#include "bench/truth/column_sweep.h"

#include <fmt/format.h>

#include <utility>

namespace boxwood::bench {

MovingTruth::MovingTruth(unsigned threads, std::function<bool(Pair)> is_left_out)
    : threads_(threads), is_left_out_(std::move(is_left_out)) {}

bool MovingTruth::check(std::size_t index, const Frame& frame, std::span<const Pair> answers,
                        results::Check& check) {
    if (index == expected_.size())
        expected_.push_back(ColumnSweep(frame.boxes, threads_).digest(is_left_out_));
    const PairsDigest& expected = expected_.at(index);
    check.oracle = "sweep";
    check.n_checked += answers.size();
    check.n_got += answers.size();
    check.n_expected += expected.count;
    if (digest_of(answers) == expected)
        return true;
    std::vector<Pair> right = ColumnSweep(frame.boxes, threads_).pairs();
    if (is_left_out_)
        std::erase_if(right, is_left_out_);
    const PairsDifference wrong = difference(right, {answers.begin(), answers.end()});
    check.missing += wrong.missing;
    check.extra += wrong.extra;
    if (check.witness.empty())
        check.witness = fmt::format("frame {}: {}", index, wrong.witness);
    return false;
}

} // namespace boxwood::bench
