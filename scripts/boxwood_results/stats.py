"""Paired comparisons without assumptions on the noise: medians, order statistics, sign tests."""

import math
from dataclasses import dataclass
from statistics import median

import numpy as np

LEAST_FOR_INTERVAL = 6  # below, no order-statistic interval reaches 95 %
LEAST_FOR_VERDICT = 9
SAME_WITHIN = 0.05  # "same": the whole interval of the ratio lies within +-5 %

FASTER, SLOWER, SAME, CANNOT_TELL, WRONG = "faster", "slower", "same", "cannot_tell", "wrong"


def interval_ranks(n, confidence=0.95):
    """Ranks (1-based) of the sorted values that refit_upward the median with at least `confidence`, as
    narrow as can be; None where n is too small. Exact for any continuous distribution."""
    tail, rank = 0.0, 0
    for k in range(n // 2):
        tail += math.comb(n, k) / 2**n
        if 1 - 2 * tail < confidence:
            break
        rank = k + 1
    return (rank, n + 1 - rank) if rank else None


@dataclass(frozen=True)
class Interval:
    """A median over n rounds; lo and hi are NaN where there are too few rounds."""

    n: int
    mid: float
    lo: float
    hi: float

    @property
    def known(self):
        return not math.isnan(self.lo)


def median_interval(values):
    values = sorted(values)
    if not values:
        return Interval(0, math.nan, math.nan, math.nan)
    ranks = interval_ranks(len(values))
    lo, hi = (values[ranks[0] - 1], values[ranks[1] - 1]) if ranks else (math.nan, math.nan)
    return Interval(len(values), median(values), lo, hi)


def paired_ratio(numerator, denominator):
    """Median over the rounds that both have of numerator / denominator, with its interval. Both are
    dicts round -> time; the median is taken of log ratios, so that swapping the two inverts it."""
    logs = paired_logs(numerator, denominator)
    of_logs = median_interval(logs)
    return Interval(of_logs.n, *(math.exp(x) for x in (of_logs.mid, of_logs.lo, of_logs.hi)))


def paired_logs(numerator, denominator):
    return [math.log(numerator[r] / denominator[r]) for r in sorted(numerator.keys() & denominator.keys())]


def sign_test(logs):
    """Two-sided exact p of "neither is faster"; ties count for neither."""
    signs = [x > 0 for x in logs if x != 0]
    n, k = len(signs), min(sum(signs), len(signs) - sum(signs))
    return min(1.0, 2 * sum(math.comb(n, i) for i in range(k + 1)) / 2**n)


def holm(ps):
    """Holm's step-down adjustment, in the order given."""
    adjusted, running = [0.0] * len(ps), 0.0
    for place, index in enumerate(sorted(range(len(ps)), key=ps.__getitem__)):
        running = max(running, min(1.0, (len(ps) - place) * ps[index]))
        adjusted[index] = running
    return adjusted


def verdict(ratio, p_adjusted, floor):
    """What may be said of ratio = their time / our time. No difference within the A/A noise floor
    (a relative difference, NaN where it is not known) is claimed."""
    if ratio.n < LEAST_FOR_VERDICT or not ratio.known:
        return CANNOT_TELL
    floor = 0.0 if math.isnan(floor) else floor
    if 1 / (1 + SAME_WITHIN) <= ratio.lo and ratio.hi <= 1 + SAME_WITHIN and floor <= SAME_WITHIN:
        return SAME  # which a noisier machine cannot tell
    if p_adjusted > 0.05 or 1 / (1 + floor) <= ratio.mid <= 1 + floor:
        return CANNOT_TELL
    if ratio.lo > 1:
        return FASTER
    return SLOWER if ratio.hi < 1 else CANNOT_TELL


def noise_floor(twin_logs):
    """From the log ratios of one cell timed twice, per phase: the largest relative difference that
    the interval of a median still contains though there is none. NaN without enough rounds."""
    ends = []
    for logs in twin_logs:
        interval = median_interval(logs)
        if interval.known:
            ends += [abs(interval.lo), abs(interval.hi)]
    return math.expm1(max(ends)) if ends else math.nan


def exponent(times_by_size):
    """Slope of log time against log n, fitted per round over all sizes, then the median over rounds
    with its interval. times_by_size: {n: {round: time}}."""
    sizes = sorted(times_by_size)
    rounds = set.intersection(*(set(times_by_size[n]) for n in sizes))
    log_n = np.log(np.array(sizes, dtype=float))
    slopes = [
        float(np.polyfit(log_n, np.log([times_by_size[n][r] for n in sizes]), 1)[0])
        for r in sorted(rounds)
    ]
    return median_interval(slopes)


def off_line(median_by_size):
    """How far the times are off the straight line through their logarithms: the farthest factor less 1."""
    log_n = np.log(np.array(sorted(median_by_size), dtype=float))
    logs = np.log([median_by_size[n] for n in sorted(median_by_size)])
    return math.expm1(float(np.max(np.abs(logs - np.polyval(np.polyfit(log_n, logs, 1), log_n)))))
