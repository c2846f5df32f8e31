"""The statistics against tables, enumeration and known distributions."""

import itertools
import math
import random

import pytest

from boxwood_results import stats


@pytest.mark.parametrize("n, ranks", [(6, (1, 6)), (9, (2, 8)), (12, (3, 10)), (15, (4, 12)), (20, (6, 15)), (30, (10, 21))])
def test_ranks_of_the_method(n, ranks):
    assert stats.interval_ranks(n) == ranks


@pytest.mark.parametrize("n", range(6))
def test_too_few_rounds_give_no_interval(n):
    assert stats.interval_ranks(n) is None
    assert not stats.median_interval(range(n)).known


@pytest.mark.parametrize("n", range(6, 13))
def test_coverage_by_enumeration(n):
    """Each value is below the true median or not, with one half: count how often the ranks refit_upward it."""
    lo, hi = stats.interval_ranks(n)
    below = [sum(signs) for signs in itertools.product((0, 1), repeat=n)]
    inside = sum(lo <= count < hi for count in below) / len(below)
    narrower = sum(lo + 1 <= count < hi - 1 for count in below) / len(below)
    assert inside >= 0.95 > narrower


def test_paired_ratio_cancels_what_rounds_share():
    drift = {r: 10.0**r for r in range(9)}
    ratio = stats.paired_ratio({r: 3 * drift[r] for r in drift}, drift)
    assert (ratio.n, ratio.mid, ratio.lo, ratio.hi) == (9, pytest.approx(3), pytest.approx(3), pytest.approx(3))


def test_paired_ratio_uses_common_rounds_and_inverts():
    random.seed(1)
    a = {r: random.uniform(1, 2) for r in range(10)}
    b = {r: random.uniform(1, 2) for r in range(3, 15)}
    there, back = stats.paired_ratio(a, b), stats.paired_ratio(b, a)
    assert there.n == 7
    assert there.mid == pytest.approx(1 / back.mid) and there.lo == pytest.approx(1 / back.hi)


def test_sign_test_and_holm():
    assert stats.sign_test([1.0] * 9) == pytest.approx(2 / 2**9)
    assert stats.sign_test([1.0, -1.0] * 5) == 1.0
    assert stats.sign_test([0.0] * 5) == 1.0
    assert stats.holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])
    assert stats.holm([0.9, 0.9]) == [1.0, 1.0]


def interval(lo, mid, hi, n=15):
    return stats.Interval(n, mid, lo, hi)


@pytest.mark.parametrize(
    "ratio, p, floor, expected",
    [
        (interval(1.9, 2.0, 2.1), 0.001, 0.02, stats.FASTER),
        (interval(0.4, 0.5, 0.6), 0.001, 0.02, stats.SLOWER),
        (interval(0.99, 1.0, 1.01), 0.9, 0.02, stats.SAME),
        (interval(0.99, 1.0, 1.01), 0.9, 0.50, stats.CANNOT_TELL),  # the machine cannot tell 5 %
        (interval(0.8, 1.2, 1.4), 0.3, 0.02, stats.CANNOT_TELL),
        (interval(1.9, 2.0, 2.1), 0.2, 0.02, stats.CANNOT_TELL),  # not after the correction
        (interval(1.9, 2.0, 2.1, n=8), 0.001, 0.02, stats.CANNOT_TELL),  # too few rounds
        (interval(1.06, 1.08, 1.12), 0.001, 0.10, stats.CANNOT_TELL),  # within the A/A noise floor
        (interval(1.06, 1.08, 1.12), 0.001, 0.02, stats.FASTER),
        (interval(1.9, 2.0, 2.1), 0.001, math.nan, stats.FASTER),
        (stats.Interval(1, 2.0, math.nan, math.nan), 1.0, math.nan, stats.CANNOT_TELL),
    ],
)
def test_verdicts(ratio, p, floor, expected):
    assert stats.verdict(ratio, p, floor) == expected


def test_noise_floor_is_the_far_end_of_the_interval():
    logs = [-0.03, -0.01, 0.0, 0.01, 0.02, 0.05]  # ranks 1..6
    assert stats.noise_floor([logs]) == pytest.approx(math.expm1(0.05))
    assert math.isnan(stats.noise_floor([[0.1] * 5]))
    assert math.isnan(stats.noise_floor([]))


def test_exponent_of_a_power_law():
    times = {n: {r: (1 + r) * n**1.5 for r in range(9)} for n in (1000, 10000, 100000)}
    fit = stats.exponent(times)
    assert fit.n == 9 and fit.mid == pytest.approx(1.5) and fit.lo == pytest.approx(1.5)
    del times[1000][0]
    assert stats.exponent(times).n == 8


def test_distance_from_a_power_law():
    sizes = (1e3, 1e4, 1e5, 1e6)
    assert stats.off_line({n: 7 * n**1.25 for n in sizes}) == pytest.approx(0, abs=1e-12)
    # Twice the time at the last size: the residuals of log 2 are 0.2, -0.1, -0.4, 0.3 of it.
    kinked = {n: n * (2 if n == 1e6 else 1) for n in sizes}
    assert stats.off_line(kinked) == pytest.approx(2**0.4 - 1)


def test_many_rounds():
    lo, hi = stats.interval_ranks(3000)
    assert hi == 3001 - lo and 1400 < lo < 1500
    assert stats.sign_test([1.0] * 3000) == 0.0 and stats.sign_test([1.0, -1.0] * 1500) == 1.0
