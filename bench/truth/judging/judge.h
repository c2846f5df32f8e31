#pragma once

#include "bench/tasks/contender.h"
#include "results/results.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// How right a kernel is: its answers to the cases of a scene against the truth, which is known by
/// construction or told by the rational oracle.
namespace boxwood::bench {

/// What one contender's answers are worth. Ids and times are left unset.
struct Judgement {
    results::KernelRow kernel;
    std::vector<results::ConditionRow> conditions;
    results::Check check;
    bool breaks_promise = false; ///< a rung of ours does not keep what it states
};

/// Each kernel is judged on the case as it reads it: one that reads floats on the coordinates
/// rounded to float. A case with NaN or infinity in it is not judged: nothing is promised there.
///
/// Wrong are: a false yes or no; a distance off by more than 64 u L (u the precision's roundoff, L
/// the largest extent of the pair), too small counted as a false yes and too large as a false no; a
/// box that does not hold the exact one. What a rung promises is judged by its promise instead:
/// never-miss may say yes too often, never-false no, certified may say maybe and must refit_upward a
/// distance or a first touch.
class Judge {
  public:
    virtual ~Judge() = default;
    /// The truth is computed on the first call that needs it.
    virtual Judgement judge(const Answers& answers, const ContenderEntry& contender) = 0;

    // In words, with numbers as hex floats that read back exactly.
    virtual std::string case_text(std::size_t i) const = 0;
    virtual std::string truth_text(std::size_t i, const std::string& precision) = 0;
    virtual std::string answer_text(const Answers& answers, std::size_t i) const = 0;
};

/// The scene must outlive the judge; its cases must be of the kind that the ask is for (`fits`).
std::unique_ptr<Judge> make_judge(const Scene& scene, Ask ask, unsigned threads);

/// Whether a kernel ask is for cases of this kind.
bool fits(const Cases& cases, Ask ask);
/// Cut down to one of them. Throws std::out_of_range if there is no such case.
Cases only_case(const Cases& cases, std::size_t i);

/// The panel of a scene's family; degenerate at the ends of its range of scales, where products
/// over- and underflow; generic for other scenes.
Panel panel_of(const Scene& scene);

/// Whether a rung of ours did what it promises not to do.
bool breaks_promise(const results::KernelRow& row);

/// The command that judges one case of a scene again.
std::string replay_command(const Scene& scene, Ask ask, const std::string& rung, std::size_t i);

} // namespace boxwood::bench
