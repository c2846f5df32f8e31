#pragma once

#include "kernels/continuous/continuous_kernel.h"
#include "kernels/oracle/exact_answers.h"

namespace boxwood::oracle {

/// A LinearMotion between rational points.
struct RationalMotion {
    std::array<RationalPoint, 4> start, end;
};

/// Whether and when the moving vertex (point 0) touches the moving closed face (points 1, 2, 3), or
/// the closed edges (0, 1) and (2, 3) touch. Any of them may be degenerate, at times or always.
/// t_free and t_hit are the doubles next to the first touch, equal where it is a double.
/// Tier 0: no root of the coplanarity cubic. 1: decided at its roots. 2: coplanar all the time.
/// Method: signs of polynomials in t with integer coefficients, at roots isolated by Descartes'
/// rule in the Bernstein basis and halved where a sign is open; zeros are proven by a common
/// divisor.
Impact vertex_face(const RationalMotion& motion);
Impact edge_edge(const RationalMotion& motion);

} // namespace boxwood::oracle
