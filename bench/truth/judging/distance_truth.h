#pragma once

#include "bench/truth/judging/case_truths.h"

#include <gmpxx.h>

#include <initializer_list>

namespace boxwood::bench {

struct TrueDistance {
    mpq_class squared;
    double nearest;        ///< of all doubles
    double extent;         ///< L: the longest side of the box around all that is measured
    Triangle<double> a, b; ///< what is measured; a last corner is repeated if there are fewer
};
/// squared: by the first oracle. a, b: the corners of the two things measured.
TrueDistance true_distance(mpq_class squared, std::initializer_list<Vec3<double>> a,
                           std::initializer_list<Vec3<double>> b);

/// The distance of two things in each case.
std::unique_ptr<CaseTruth> make_distance_truth(const CaseScene& scene,
                                               TrueDistance (*measure)(const TrianglePairCase&));

} // namespace boxwood::bench
