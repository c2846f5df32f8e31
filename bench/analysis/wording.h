#pragma once

#include "results/results.h"

#include <cstdint>
#include <string>
#include <string_view>

/// Comparisons in words that a newcomer knows.
namespace boxwood::bench {

/// Which way a comparison goes for us, the worst first.
enum class Outcome { loses, open, even, wins };
Outcome outcome_of(const results::Comparison& row);

/// "LOSES 0.73x to Embree"; the ratio is the rival's time over ours. No rival: the one named
/// before.
std::string outcome_text(const results::Comparison& row, const std::string& rival);

/// Its interval from `lo` to `hi`, as the reader sees the ratio, and `of` what it is; else why
/// nothing can be told.
std::string certainty_text(const results::Comparison& row, double lo, double hi,
                           std::string_view of = "");

std::string reason_text(results::Reason reason);

/// "faster", "can't tell (too few rounds)": the verdict of a comparison, with its reason.
std::string verdict_text(const results::Comparison& row);

/// "3.12x (3.01 to 3.20)": a ratio with its interval, where it has one; "-" for no ratio.
std::string interval_text(double ratio, double lo, double hi);

std::string count_words(std::uint64_t n); ///< "10k"

/// "Embree: rtc_intersect1" of a library's.
std::string peer_text(const results::Variant& peer);

} // namespace boxwood::bench
