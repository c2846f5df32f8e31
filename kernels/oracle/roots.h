#pragma once

#include <gmpxx.h>

namespace boxwood::oracle {

/// The double or float nearest to x, ties to even; beyond them infinite. Made from its bits: right
/// among the denormals and in flush-to-zero modes.
double nearest_double(const mpq_class& x);
float nearest_float(const mpq_class& x);

/// The doubles next to x >= 0, which may be infinite; 0 is its own next below.
double next_above(double x);
double next_below(double x);

} // namespace boxwood::oracle
