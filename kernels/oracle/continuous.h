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
/// rule in the Bernstein basis and refined where a sign is open; zeros are proven by a common
/// divisor.
/// Cost: microseconds; up to some 20 ms where coordinates span all doubles. They are then integers
/// of 2,100 bits, the coefficients of the cubic have 6,300, and so two of its roots may be apart
/// only after 2 * 6,300 halvings, of numbers that grow by 3 bits each.
Impact vertex_face(const RationalMotion& motion);
Impact edge_edge(const RationalMotion& motion);

} // namespace boxwood::oracle
