#pragma once

#include "bench/truth/truth.h"

namespace boxwood::bench {

/// The truth of the asks of points and regions (is_point_ask), for a seeded sample of the queries:
/// every item tested in doubles. Items of equal distance may differ between libraries, and those of
/// floats round: an answer of nearest or closest_points is right if its distance is within
/// `point_bound` of the least (of the k least, in order).
std::unique_ptr<Truth> make_point_truth(const Scene& scene, Ask ask, unsigned threads);

/// How far a distance may be off: this share of itself, and of the size of the triangle if there is
/// one. Our answers are judged alike, and recorded as exact where they equal the truth.
inline constexpr double point_bound = 0x1p-16;

/// As answer_hash, of nearest and closest_points.
std::uint64_t point_answer_hash(const Answers& answers, Ask ask);

} // namespace boxwood::bench
