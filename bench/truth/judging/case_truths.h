#pragma once

#include "bench/truth/truth.h"
#include "kernels/decision.h"
#include "scenes/scene.h"

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// How right a kernel is: its answers to the cases of a scene against the truth, which is known by
/// construction or comes from the rational oracle.
///
/// Each kernel is judged on the case as it reads it: one that reads floats on the coordinates
/// rounded to float (of convex shapes: on the case as it is, where rounding cannot matter). A case
/// with NaN or infinity in it is not judged: nothing is promised there. Where the rational oracle
/// is itself judged as a kernel, each of its answers has to agree with a second oracle
/// (kernels/oracle/second_opinion.h) first.
///
/// Wrong are: a false yes or no; a distance off by more than 64 u L (u the precision's roundoff, L
/// the largest extent of the pair) or, of convex shapes, outside of what is known by construction
/// by more than 1e-5 (in floats 2e-3) of their size, too small counted as a false yes and too large
/// as a false no, or of whether they touch a false yes or no farther than that from a touch; a box
/// that does not hold the exact one. What a kernel promises is judged by its promise instead:
/// never-leaks must hit closed fans and meshes, never-miss may say yes too often (but not where it
/// says that a yes is proven), never-false no, certified may say maybe and must enclose a distance,
/// within the width it states, or a first touch. What exact encloses lies between neighbouring
/// doubles; of exact kernels of rays t must be within 0.63 ulp, u and v within 2^-23, and the
/// triangle one that is hit there. A tree's nearest hit is that of its kernel without a tree, bit
/// for bit, and of several triangles at one t the lowest.
namespace boxwood::bench {

/// What the truths of cases are made from. The scene outlives them; its cases are of their kind.
struct CaseScene {
    const Scene& scene;
    std::string_view task;
    unsigned threads = 1; ///< that may be used when the truth is computed, which is on first need
};

/// The hits of rays at triangles or fans; all hits of rays, which are those of the kernel on each
/// triangle alone, by t and then by triangle, and an exact one's of the triangles that the rational
/// oracle hits; first touches of moving features; fitted boxes; distances of convex shapes, which
/// are known by construction, depths between bounds. Those of yes or no and of other distances are
/// in verdict_truth.h and distance_truth.h.
std::unique_ptr<CaseTruth> make_fan_truth(const CaseScene& scene);
std::unique_ptr<CaseTruth> make_all_hits_of_cases_truth(const CaseScene& scene);
std::unique_ptr<CaseTruth> make_impact_truth(const CaseScene& scene);
std::unique_ptr<CaseTruth> make_fit_truth(const CaseScene& scene);
std::unique_ptr<CaseTruth> make_shape_distance_truth(const CaseScene& scene);
std::unique_ptr<CaseTruth> make_signed_shape_distance_truth(const CaseScene& scene);

/// Unless they agree, throws std::logic_error: then no truth is known, and nothing is judged.
/// case_text(): the case in words.
template <class CaseText> void require_agreement(bool oracles_agree, const CaseText& case_text) {
    if (!oracles_agree)
        throw std::logic_error("the oracle and its second opinion differ on " + case_text());
}

/// Cut down to one of them. Throws std::out_of_range if there is no such case.
Cases only_case(const Cases& cases, std::size_t i);

/// The panel of a scene's family; degenerate at the ends of its range of scales, where products
/// over- and underflow; generic for other scenes.
Panel panel_of(const Scene& scene);

/// Whether a kernel of ours did what it promises not to do.
bool breaks_promise(const results::KernelRow& row);

/// The command that judges one case of a scene again.
std::string replay_command(const CaseScene& scene, const std::string& kernel, std::size_t i);

/// What a row of two triangles can be piped into, to query a kernel again; empty for peers.
std::string query_command(const ContenderEntry& contender);

/// Answers are as many as the cases, or the contender is broken.
void require_one_per_case(const Answers& answers, std::size_t cases);

std::string text_of(Answer answer);
inline std::string text_of(bool truth) { return truth ? "yes" : "no"; }
std::string text_of(const Decision& verdict);

} // namespace boxwood::bench
