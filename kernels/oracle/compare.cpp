#include "kernels/oracle/exact_vector.h"
#include "kernels/oracle/oracle.h"

#include <cmath>

namespace boxwood::oracle {

int compare(double d, const mpq_class& squared) {
    if (std::isinf(d))
        return d > 0 ? 1 : -1;
    const mpq_class root = exact(d);
    if (sgn(root) < 0)
        return -1;
    return sgn(mpq_class(root * root - squared));
}

} // namespace boxwood::oracle
