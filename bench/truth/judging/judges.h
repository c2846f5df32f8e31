#pragma once

#include "bench/truth/judging/judge.h"

namespace boxwood::bench {

/// One file of this folder per kind of answer.
std::unique_ptr<Judge> verdict_judge(const Scene& scene, Ask ask, unsigned threads);
std::unique_ptr<Judge> distance_judge(const Scene& scene, Ask ask, unsigned threads);
std::unique_ptr<Judge> ray_judge(const Scene& scene, unsigned threads);
std::unique_ptr<Judge> impact_judge(const Scene& scene, unsigned threads);
std::unique_ptr<Judge> fit_judge(const Scene& scene, unsigned threads);

/// Answers are as many as the cases, or the contender is broken.
void require_one_per_case(std::size_t answers, std::size_t cases);

/// What a row of two triangles can be piped into, to be asked of a rung again; empty for peers.
std::string query_command(const ContenderEntry& contender, Ask ask);

std::string text_of(Answer answer);
inline std::string text_of(bool truth) { return truth ? "yes" : "no"; }

} // namespace boxwood::bench
