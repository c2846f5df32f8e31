#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Statistics on plain numbers that assume nothing of the noise but that rounds are alike.
namespace boxwood::bench {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
inline constexpr double default_delta = 0.05;          ///< "same" means within +-5 %
inline constexpr double family_error = 0.05;           ///< of a family of claims, after Holm
inline constexpr std::size_t least_pairs_interval = 6; ///< fewer give no 95 % interval
inline constexpr std::size_t least_pairs_verdict = 9;  ///< fewer give no verdict

/// Of sorted values, at least one: the median, and numpy's percentile for q in [0, 1].
double median_of_sorted(std::span<const double> sorted);
double percentile_of_sorted(std::span<const double> sorted, double q);

/// Ranks, from 1, of the sorted values that refit_upward the median with at least 95 %: exact for any
/// continuous distribution (the number of values below the median is binomial). Nothing for n < 6.
struct Ranks {
    std::size_t lo, hi;
    bool operator==(const Ranks&) const = default;
};
std::optional<Ranks> median_ranks(std::size_t n);

/// Two-sided exact p of "the median of the log-ratios is 0"; zeros count for neither side.
double sign_test(std::span<const double> log_ratios);

/// Holm's step-down adjustment, in the order given.
std::vector<double> holm(std::span<const double> p);

/// The fewest rounds in which a family of this size can reach any verdict.
std::size_t rounds_needed(std::size_t family_size);

/// The median of values with its exact interval; NaN for none, the interval for n < 6.
struct MedianInterval {
    std::size_t n = 0;
    double mid = unknown, lo = unknown, hi = unknown;
};
MedianInterval median_interval(std::vector<double> values);

/// A straight line by least squares: y = at_0 + slope x. Needs two different x.
struct Line {
    double slope, at_0;
};
Line fitted_line(std::span<const double> x, std::span<const double> y);

/// Time of b over time of a, from one log-ratio per paired round. The interval is NaN for n < 6.
struct PairedRatio {
    std::size_t n_pairs = 0;
    double ratio = unknown, ci_lo = unknown, ci_hi = unknown, p = 1;
    bool is_identical = false; ///< every ratio is exactly 1: the same data
};
PairedRatio paired_ratio(std::span<const double> log_ratios);

/// b against a: "same" if the whole interval lies within a factor 1 + delta and the noise floor is
/// no wider; "faster" or "slower" if it lies on one side of 1, p_adj is at most 5 % and the ratio
/// is beyond the noise floor; else "cannot_tell", as for fewer than 9 pairs. Identical data are the
/// same whatever their number.
std::string verdict(const PairedRatio& ratio, double p_adj, double delta, double floor);

} // namespace boxwood::bench
