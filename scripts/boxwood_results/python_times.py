"""What `scripts/python_bench` timed: samples in a JSON file, here alone made into medians and intervals. No C++ program times
Python, so that no result file of a sweep holds these."""

import json
import statistics
from dataclasses import dataclass
from math import comb
from pathlib import Path

from .checkout import environment_of
from boxwood.results.reader import BadFile
from boxwood.results.words import interval_text, ratio_text, time_text


@dataclass(frozen=True)
class Row:
    """A question of n boxes, points or rays. Times in ns, one a round; a round's belong together."""

    question: str
    n: int
    ours: list
    inside: list  # what the C++ library took of them
    others: dict  # whose -> times

    @property
    def over_ns(self):
        """What Python adds to a call."""
        return statistics.median(ours - inside for ours, inside in zip(self.ours, self.inside))

    @property
    def over_percent(self):
        return 100 * self.over_ns / statistics.median(self.inside)

    def ratios(self):
        """whose -> (median, lo, hi) of its time over ours, round by round."""
        return {whose: median_interval([other / ours for other, ours in zip(times, self.ours)]) for whose, times in self.others.items()}


def of_round(times):
    """The median call of those of a round: (ns, ns of it inside the library)."""
    return sorted(times)[len(times) // 2]


def median_interval(values):
    """The median and an interval between two of the values, which misses the true one at most once in twenty (the sign test);
    of less than six values their whole range, which misses it more often."""
    ordered, n = sorted(values), len(values)
    cut = 0
    while 2 * sum(comb(n, k) for k in range(cut + 2)) <= 0.05 * 2**n:
        cut += 1
    return statistics.median(ordered), ordered[cut], ordered[n - 1 - cut]


@dataclass(frozen=True)
class PythonTimes:
    rows: list
    env: dict  # of ENV

    def add(self, of_round):
        """A round: [[question, n, {whose: (ns, of it inside the library)}], ...], ours under ""."""
        for place, (question, n, times) in enumerate(of_round):
            if place == len(self.rows):
                self.rows.append(Row(question, n, [], [], {whose: [] for whose in times if whose}))
            row = self.rows[place]
            row.ours.append(times[""][0])
            row.inside.append(times[""][1])
            for whose, of in row.others.items():
                of.append(times[whose][0])

    def write(self, path):
        rows = [vars(row) for row in self.rows]
        part = Path(f"{path}.part")
        part.write_text(json.dumps({"env": self.env, "rows": rows}) + "\n", encoding="utf-8")
        part.replace(path)


def read(path):
    try:
        found = json.loads(Path(path).read_text(encoding="utf-8"))
        times = PythonTimes([Row(**row) for row in found["rows"]], environment_of(found["env"]))
        if not times.rows:
            raise ValueError("no question")
        for row in times.rows:
            for samples in (row.ours, row.inside, *row.others.values()):
                if len(samples) != len(row.ours) or not all(isinstance(ns, int) and ns > 0 for ns in samples):
                    raise ValueError(f"'{row.question}' has not a time above 0 of each round")
        return times
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadFile(path, f"it is no file of scripts/python_bench --out ({error})") from error


HEADER = ["one thread, from Python", "n", "boxwood", "over C++", "others / boxwood"]


def table(times):
    """[header, row, ...] of texts."""
    rows = [HEADER]
    for row in times.rows:
        others = ", ".join(f"{whose} {interval_text(*ratio)}{open_mark(ratio)}" for whose, ratio in row.ratios().items())
        rows.append([row.question, f"{row.n:,}", time_text(statistics.median(row.ours)),
                     f"{time_text(row.over_ns)}, {ratio_text(row.over_percent)} %", others])
    return rows


def open_mark(ratio):
    _, lo, hi = ratio
    return " ?" if lo <= 1 <= hi else ""
