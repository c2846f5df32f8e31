#pragma once

#include "bench/tasks/contender.h"
#include "bench/truth/pairs_digest.h"
#include "results/results.h"

#include <memory>

namespace boxwood::bench {

/// The right answer to (scene, ask), by an oracle that uses no tree: brute force for pairs, or a
/// sweep by columns beyond 20,000 boxes, with rational arithmetic for those of triangles; brute
/// force in double for a seeded sample of rays. Computed once, shared by all contenders. The kernel
/// asks have `judging/judge.h` instead.
class Truth {
  public:
    virtual ~Truth() = default;
    /// Counts missing and extra answers and says what the answer is worth (cell_id is left unset).
    virtual results::Check check(const Answers& answers) const = 0;
};

/// `threads` may be used to compute it. The scene must outlive the truth.
std::unique_ptr<Truth> make_truth(const Scene& scene, Ask ask, unsigned threads);

/// A hash of an answer that does not depend on the order of its pairs. It tells whether two rounds
/// of one contender gave the same answer.
std::uint64_t answer_hash(const Answers& answers, Ask ask);

} // namespace boxwood::bench
