#pragma once

#include "kernels/oracle/exact_answers.h"

namespace boxwood::oracle {

/// The squared minimum distance of two closed sets and a point of each where it is taken, all
/// exact. The sets may be degenerate. If they share a point, then a = b is one.
struct Nearest {
    mpq_class squared;
    RationalPoint a, b;
};
Nearest nearest(const Triangle<double>& a, const Triangle<double>& b);
Nearest nearest(const Segment<double>& a, const Segment<double>& b);
Nearest nearest(Vec3<double> a, const Triangle<double>& b);
Nearest nearest(Vec3<double> a, const Segment<double>& b);

} // namespace boxwood::oracle
