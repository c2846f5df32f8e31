#pragma once

#include "results/words.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

/// Statistics on plain numbers that assume nothing of the noise but that rounds are alike.
namespace boxwood::bench {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
inline constexpr double default_delta = 0.05; ///< "same" means within +-5 %
inline constexpr double noisy_floor = 0.2;    ///< a claim below a higher one is open for noise
inline constexpr double max_floor = 0.5;      ///< of a run of which anything is told
inline constexpr double family_error = 0.05;  ///< of the claims of a family
inline constexpr std::size_t min_pairs_interval = 6; ///< fewer give no 95 % interval
inline constexpr std::size_t min_pairs_verdict = 9;  ///< fewer give no verdict

/// Of sorted values, at least one: the median, and numpy's percentile for q in [0, 1].
double median_of_sorted(std::span<const double> sorted);
double percentile_of_sorted(std::span<const double> sorted, double q);

/// Ranks, from 1, of the sorted values that enclose the median with an error of at most `error`:
/// exact for any continuous distribution (the number of values below the median is binomial).
/// Nothing if n is too small for that.
struct Ranks {
    std::size_t lo, hi;
    bool operator==(const Ranks&) const = default;
};
std::optional<Ranks> median_ranks(std::size_t n, double error = 0.05);

/// Two-sided exact p of "the median of the log-ratios is 0"; zeros count for neither side.
double sign_test(std::span<const double> log_ratios);

/// Benjamini and Hochberg's procedure: of what is claimed, at most a share of `family_error` is
/// false in the mean, however many claims a family has. In the order given: the adjusted p of each
/// claim; and the level of all intervals, so that those of what is claimed miss as seldom.
/// Sources: Benjamini and Hochberg 1995, "Controlling the False Discovery Rate"; Benjamini and
/// Yekutieli 2005, "False Discovery Rate-Adjusted Multiple Confidence Intervals".
struct Corrected {
    std::vector<double> p_adj;
    double level = 0;
};
Corrected corrected(std::span<const double> p);

/// The fewest rounds in which one claim of a family of this size can stand alone.
std::size_t rounds_needed(std::size_t family_size);

/// The median of values with its exact interval; NaN for none, the interval if n is too small.
struct MedianInterval {
    std::size_t n = 0;
    double mid = unknown, lo = unknown, hi = unknown;
};
MedianInterval median_interval(std::vector<double> values, double error = 0.05);

/// A straight line by least squares: y = at_0 + slope x. Needs two different x.
struct Line {
    double slope, at_0;
};
Line fitted_line(std::span<const double> x, std::span<const double> y);

/// Time of b over time of a, from one log-ratio per paired round.
struct PairedRatio {
    std::size_t n_pairs = 0;
    double ratio = unknown, ci_lo = unknown, ci_hi = unknown;
};
PairedRatio paired_ratio(std::span<const double> log_ratios, double error = 0.05);

/// The least and the greatest of the medians that the inputs of a claim have, each on its own.
struct InputMedians {
    double lo = unknown, hi = unknown; ///< log-ratios
};
/// log_ratios[i] belongs to input inputs[i]. Unknown for fewer than two inputs of three rounds: two
/// rounds have no median that one disturbed round leaves alone.
InputMedians input_medians(std::span<const double> log_ratios,
                           std::span<const std::uint32_t> inputs);

/// What is said of one claim of a family, with the interval that decided.
struct Ruling {
    PairedRatio ratio;
    double p_adj = 1;
    results::Verdict verdict = results::Verdict::cannot_tell;
    results::Reason reason = results::Reason::none;
};
/// The claims of one family, each the log-ratios of b against a by paired round, decided together.
/// Every interval is as wide as to hold the median of each input, too: rounds of one input are not
/// independent, and what is said is to hold for other inputs.
/// "same": the 95 % interval lies within a factor 1 + delta and the noise floor is no wider.
/// "faster", "slower": the interval at the claim's level within the family lies beyond 1, and the
/// ratio beyond the claim's noise floor; all of the interval, where that is above delta. Else
/// "cannot_tell", as for fewer than 9 pairs.
struct Claim {
    std::vector<double> log_ratios;
    double floor = 0; ///< the A/A noise of its class
    InputMedians by_input{};
};
std::vector<Ruling> decide(std::span<const Claim> family, double delta);

} // namespace boxwood::bench
