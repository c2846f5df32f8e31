#pragma once

#include "bench/tasks/contender.h"
#include "results/results.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boxwood::bench {

using results::Status;

/// What one contender's answers are worth, as rows of a result file. Ids, times, status and hash
/// are left unset in the rows.
struct Judgement {
    Status status = Status::exact;
    results::Check check;
    std::optional<results::KernelRow> kernel; ///< of the kernel that decided, if it is one's doing
    std::vector<results::ConditionRow> conditions;
    std::uint64_t calls = 0;      ///< of that kernel in one query; 0: not known
    bool has_faulty_tree = false; ///< its tree is not to be measured

    /// Sets the status by what is missing or extra; else all is exact, or within the bound.
    void conclude(bool is_exact) {
        status = check.missing || check.extra ? Status::wrong
                 : is_exact                   ? Status::exact
                                              : Status::within_bound;
    }
};

/// The right answers to one task on one scene, by an oracle that uses no tree. Computed once,
/// shared by all contenders.
class Truth {
  public:
    virtual ~Truth() = default;
    /// Counts missing and extra answers. Of tasks of frames: those of all frames since frame 0.
    virtual Judgement judge(const Answers& answers, const ContenderEntry& contender) = 0;
    /// Of tasks of frames: looks at the answers to a frame, numbered from 0 in order.
    virtual void note_frame(std::size_t /*index*/, const Frame& /*frame*/,
                            const Answers& /*answers*/, const ContenderEntry& /*contender*/) {}
};

/// Whether bounds are as near to each other as KernelInfo::relative_width says.
inline bool are_narrow(double lo, double hi, double relative_width) {
    hi = std::min(hi, std::numeric_limits<double>::max());
    return hi - lo <= relative_width * hi + 0x1p-1073;
}

/// The truth of a scene of hard cases, which can say each case in words, with numbers as hex floats
/// that read back exactly.
class CaseTruth : public Truth {
  public:
    virtual std::string case_text(std::size_t i) const = 0;
    virtual std::string truth_text(std::size_t i, const std::string& precision) = 0;
    virtual std::string answer_text(const Answers& answers, std::size_t i) const = 0;
};

} // namespace boxwood::bench
