"""Ratios, intervals, noise floors and verdicts of /compare, from the samples once more: a second way to the numbers of bench/analysis,
in another language. Taken as the file has them: statuses, classes, which rows there are, and whether a row depends on the layout of memory
(`memory_layout`). `rederived.py` holds those to what the program derives of the cells and checks that are there."""

import math
from collections import defaultdict
from statistics import median

MIN_ROUNDS_OF_VERDICT = 9
MIN_ROUNDS_OF_INPUT = 3  # fewer have no median that one disturbed round leaves alone
ERROR = 0.05  # of all claims of a task together
NOISY = 0.2  # a noise floor above it is said to be the reason
NEAR = 1e-5  # of what is stored and what is computed
ON_THE_EDGE = 1e-9  # of a level: within it either side is right
SUMS = {"build+query": ("build", "query"), "update+query": ("update", "query")}
COLD = ("cold_build", "cold_query", "cold_build+query")
READ_ONLY = ("query", "cold_query", "device_query")
BRIEF_NS = 1e6
RIGHT = ("exact", "conservative", "within_bound")


def pairs(a, b):
    """[((machine, round), a's, b's)] of the rounds of both."""
    return [(key, x, y) for key in sorted(a.keys() & b.keys()) for x, y in zip(a[key], b[key])]


def is_near(a, b):
    return abs(a - b) <= NEAR * max(abs(a), abs(b))


def narrowest(n, error=ERROR):
    """The highest rank, from 1, whose interval to its mirror image misses the median with no more than this probability; 0 if none does."""
    rank, misses = 0, 0.0
    while rank < n // 2:
        misses += 2 * math.comb(n, rank) / 2**n
        if misses > error:
            break
        rank += 1
    return rank


def interval(logs, inputs, error=ERROR):
    """(lo, hi) of the ratio, with the medians of the inputs; None if the rounds are too few."""
    rank = narrowest(len(logs), error)
    if not rank:
        return None
    of_input = defaultdict(list)
    for log, number in zip(logs, inputs):
        of_input[number].append(log)
    medians = [median(values) for values in of_input.values() if len(values) >= MIN_ROUNDS_OF_INPUT]
    medians = medians if len(medians) > 1 else []
    ordered = sorted(logs)
    return math.exp(min([ordered[rank - 1], *medians])), math.exp(max([ordered[-rank], *medians]))


def sign_test(logs):
    """Two-sided p of "the median is 0"."""
    below, above = sum(log < 0 for log in logs), sum(log > 0 for log in logs)
    return min(1.0, sum(2 * math.comb(below + above, k) / 2 ** (below + above) for k in range(min(below, above) + 1)))


def level_of(claims, error):
    """That of the intervals of these p, as Benjamini and Hochberg's procedure has it."""
    ordered = sorted(claims)
    claimed = max((place for place, p in enumerate(ordered, 1) if p * len(ordered) / place <= error), default=1)
    return error * max(claimed, 1) / len(ordered)


def within(value, band):
    return 1 / (1 + band) <= value <= 1 + band


def ruling(logs, inputs, level, floor, delta):
    """(verdict, reason, interval) of one claim at the level of its family."""
    lost_in_noise = "too_noisy" if floor > NOISY else "below_the_floor"
    usual, own = interval(logs, inputs), interval(logs, inputs, level)
    if len(logs) < MIN_ROUNDS_OF_VERDICT:
        return "cannot_tell", "too_few_rounds", usual
    if usual and all(within(end, delta) for end in usual):
        return ("cannot_tell", lost_in_noise, usual) if floor > delta else ("same", "", usual)
    if not own:
        return "cannot_tell", "too_few_rounds", None
    lo, hi = own
    if lo <= 1 <= hi:
        return "cannot_tell", "crosses_1", own
    ratio = math.exp(median(logs))
    if within((hi if ratio < 1 else lo) if floor > delta else ratio, floor):
        return "cannot_tell", lost_in_noise, own
    return "faster" if hi < 1 else "slower", "", own


class Floors:
    """The A/A noise of phases that are alike: on one thread or several, below a millisecond or not, cold or not, read-only or not."""

    def __init__(self, source, times, twins):
        self.times, self.cells = times, {row["cell_id"]: row for row in source["cells"]}
        mids, ends = defaultdict(float), defaultdict(list)
        for (cell, phase), twin in twins.items():
            logs = [math.log(b / a) for _, a, b in pairs(times.get((cell, phase), {}), twin)]
            found = interval(logs, [0] * len(logs)) if logs else None
            if found:
                alike, ratio = self.alike(cell, phase), math.exp(median(logs))
                ends[alike].append(max(found[1] - 1, 1 / found[0] - 1))
                mids[alike] = max(mids[alike], ratio - 1, 1 / ratio - 1)
        self.floors = {alike: max(mids[alike], sorted(of)[len(of) // 2]) for alike, of in ends.items()}

    def alike(self, cell, phase):
        values = [ns for of_round in self.times.get((cell, phase), {}).values() for ns in of_round]
        return int(self.cells[cell]["threads"]) > 1, bool(values) and median(values) < BRIEF_NS, phase in COLD, phase in READ_ONLY

    def of(self, cell, phase):
        """NaN without twins."""
        alike = self.alike(cell, phase)
        others = [floor for of, floor in self.floors.items() if of[2]] if alike[2] else []
        others = others or [floor for of, floor in self.floors.items() if not of[2]]
        own = self.floors.get(alike, max(others, default=math.nan))
        known = [floor for floor in (own, *(self.of(cell, part) for part in SUMS.get(phase, ()))) if floor == floor]
        return max(known, default=math.nan)

    def of_both(self, a, b, phase):
        return max((floor for floor in (self.of(a, phase), self.of(b, phase)) if floor == floor), default=math.nan)


def said(verdict, reason, found):
    return " ".join(filter(None, (verdict, f"({reason})" if reason else "", "between {:.4g} and {:.4g}".format(*found) if found else "")))


def as_stored(row):
    ends = float(row["ci_lo"]), float(row["ci_hi"])
    return row["verdict"], row["reason"], ends if ends[0] == ends[0] else None


def unlike(name, row, expected):
    return f"{name}: called {said(*as_stored(row))}; its samples are {said(*expected)}"


def agree(row, expected):
    verdict, reason, found = as_stored(row)
    is_alike = (verdict, reason) == expected[:2] or (reason == "memory_layout" and (verdict, "crosses_1") == expected[:2])
    return is_alike and (found is None) == (expected[2] is None) and all(is_near(*ends) for ends in zip(found or (), expected[2] or ()))


def differences(source, times, twins):
    """What /compare does not have from the samples, as texts; none if all follows."""
    machine = {row["env_id"]: row["env_hash"] for row in source["env"]}
    input_of = {(machine[row["env_id"]], row["round"]): row["input"] for row in source["shards"]}
    cells, floors = {row["cell_id"]: row for row in source["cells"]}, Floors(source, times, twins)
    families = defaultdict(list)
    for row in source["compare"]:
        name = f"/compare, cell {row['cell_b']} against {row['cell_a']}, {row['phase']}"
        a, b = (times.get((row[side], row["phase"]), {}) for side in ("cell_a", "cell_b"))
        both = pairs(a, b)
        logs, inputs = [math.log(y / x) for _, x, y in both], [input_of.get(key, 0) for key, *_ in both]
        statuses = [cells[row[side]]["status"] for side in ("cell_a", "cell_b")]
        floor = floors.of_both(row["cell_a"], row["cell_b"], row["phase"])
        if len(logs) != row["n_pairs"] or not logs:
            yield f"{name}: not as many rounds as its samples"
        elif not (is_near(floor, row["floor"]) or (floor != floor and row["floor"] != row["floor"])):
            yield f"{name}: not the noise floor of the samples that were timed twice"
        elif "wrong" in statuses:
            if row["verdict"] != "wrong" or row["ratio"] == row["ratio"]:
                yield f"{name}: one of the two is wrong, and it is called {row['verdict']}"
        elif not is_near(math.exp(median(logs)), row["ratio"]):
            yield f"{name}: not the ratio of its samples"
        elif not all(status in RIGHT for status in statuses):
            expected = "cannot_tell", "unchecked", interval(logs, [0] * len(logs))
            if not agree(row, expected):
                yield unlike(name, row, expected)
        else:
            families[row["family"], cells[row["cell_b"]]["task"]].append((name, row, logs, inputs))
    for claims in families.values():
        tests = [sign_test(logs) for _, _, logs, _ in claims]
        levels = [level_of(tests, ERROR * (1 + edge)) for edge in (-ON_THE_EDGE, ON_THE_EDGE)]
        for name, row, logs, inputs in claims:
            floor = row["floor"] if row["floor"] == row["floor"] else 0
            expected = [ruling(logs, inputs, level, floor, row["delta"]) for level in levels]
            if not any(agree(row, one) for one in expected):
                yield unlike(name, row, expected[0])
