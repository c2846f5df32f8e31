#include "bench/truth/judging/witnesses.h"

#include "kernels/oracle/exact_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood::bench {
namespace {

constexpr double min_error = 0x1p-1070; ///< of denormals

double largest_coordinate(const Triangle<double>& t) {
    double size = 0;
    for (const Vec3<double>& p : {t.a, t.b, t.c})
        size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return size;
}

/// What is wrong with one of the points; `which` in words.
std::string fault_of(const char* which, Vec3<double> point, const Triangle<double>& t,
                     double error) {
    if (!is_finite(point))
        return fmt::format("{} point is not finite", which);
    const mpq_class squared = oracle::squared_distance(point, t);
    if (oracle::compare(error, squared) >= 0)
        return {};
    return fmt::format("{} point ({}, {}, {}) is {} off its triangle", which, point.x, point.y,
                       point.z, oracle::nearest_sqrt(squared));
}

} // namespace

std::string witness_fault(Vec3<double> point_a, Vec3<double> point_b, const Triangle<double>& a,
                          const Triangle<double>& b, double lo, double hi, WitnessErrors errors) {
    const double size = std::max({errors.size, largest_coordinate(a), largest_coordinate(b)});
    const double of_point = errors.of_point * size + min_error;
    if (std::string fault = fault_of("the first", point_a, a, of_point); !fault.empty())
        return fault;
    if (std::string fault = fault_of("the second", point_b, b, of_point); !fault.empty())
        return fault;
    const Vec3<double> gap = point_a - point_b;
    // hypot of three makes NaN of an infinity.
    const double apart =
        is_finite(gap) ? std::hypot(gap.x, gap.y, gap.z) : std::numeric_limits<double>::infinity();
    const double of_separation = errors.of_separation * size + min_error;
    if (apart >= lo - of_separation && apart <= hi + of_separation)
        return {};
    return fmt::format("its points are {} apart, and it is {}", apart,
                       lo == hi ? fmt::format("{}", lo) : fmt::format("{} to {}", lo, hi));
}

} // namespace boxwood::bench
