"""What a file says, held against its own samples: a second way to the numbers of bench/analysis, in another language."""

import math
from collections import defaultdict
from statistics import median

from .run import AA_TWIN

SUMS = {"build+query": ("build", "query"), "update+query": ("update", "query")}
MIN_ROUNDS_OF_INPUT = 3  # fewer have no median that one disturbed round leaves alone
NEAR = 1e-5  # of what is stored and what is computed


def rounds_by_cell(source):
    """{(cell, phase): {(machine, round): [ns, ...]}} without the twins, sums included."""
    machine = {row["env_id"]: row["env_hash"] for row in source["env"]}
    shards = {row["shard_id"]: row for row in source["shards"]}
    rows = [row for row in source["samples"] if not row["flags"] & AA_TWIN and row["wall_ns"] > 0 and math.isfinite(row["wall_ns"])]
    found = defaultdict(lambda: defaultdict(list))
    for row in sorted(rows, key=lambda row: shards[row["shard_id"]]["t0_utc_ns"]):
        key = machine[shards[row["shard_id"]]["env_id"]], row["round"]
        found[row["cell_id"], row["phase"]][key].append(float(row["wall_ns"]))
    for cell in {cell for cell, _ in found}:
        for phase, (first, second) in SUMS.items():
            if (cell, first) in found and (cell, second) in found:
                found[cell, phase] = {key: [a + b for a, b in pairs(found[cell, first], found[cell, second], key)]
                                      for key in found[cell, first].keys() & found[cell, second].keys()}
    return found


def pairs(a, b, key):
    return zip(a[key], b[key])


def narrowest(n):
    """The highest rank, from 1, whose interval to its mirror image holds the median with 95 %; 0 if there is none."""
    rank, misses = 0, 0.0
    while rank < n // 2:
        misses += 2 * math.comb(n, rank) / 2**n
        if misses > 0.05:
            break
        rank += 1
    return rank


def intervals(logs, inputs):
    """All intervals that may stand for these rounds: that of 95 % and the wider ones, with the medians of the inputs."""
    of_input = defaultdict(list)
    for log, number in zip(logs, inputs):
        of_input[number].append(log)
    medians = [median(values) for values in of_input.values() if len(values) >= MIN_ROUNDS_OF_INPUT]
    medians = medians if len(medians) > 1 else []
    ordered = sorted(logs)
    return [(min(ordered[rank - 1], *medians) if medians else ordered[rank - 1],
             max(ordered[-rank], *medians) if medians else ordered[-rank]) for rank in range(narrowest(len(logs)), 0, -1)]


def is_near(a, b):
    return abs(a - b) <= NEAR * max(abs(a), abs(b))


def is_held(row):
    """Whether a verdict's interval lies beyond 1, and the ratio beyond the noise floor; all of the interval, where that is above delta."""
    near_end, floor = row["ci_hi" if row["verdict"] == "faster" else "ci_lo"], row["floor"]
    held = near_end if floor > row["delta"] else row["ratio"]
    beyond_1 = near_end < 1 if row["verdict"] == "faster" else near_end > 1
    return beyond_1 and not (floor >= 0 and 1 / (1 + floor) <= held <= 1 + floor)


def differences(source):
    """What of /medians and /compare does not follow from /samples, as texts; none if all does."""
    times = rounds_by_cell(source)
    machine = {row["env_id"]: row["env_hash"] for row in source["env"]}
    input_of = {(machine[row["env_id"]], row["round"]): row["input"] for row in source["shards"]}
    found = []
    for row in source["medians"]:
        values = [ns for of_round in times.get((row["cell_id"], row["phase"]), {}).values() for ns in of_round]
        if len(values) != row["n"] or not is_near(median(values), row["median_ns"]):
            found.append(f"/medians, cell {row['cell_id']}, {row['phase']}: not the median of its samples")
    for row in source["compare"]:
        if row["ratio"] != row["ratio"]:
            continue
        a, b = (times.get((row[side], row["phase"]), {}) for side in ("cell_a", "cell_b"))
        both = [(key, math.log(y / x)) for key in sorted(a.keys() & b.keys()) for x, y in pairs(a, b, key)]
        logs = [log for _, log in both]
        name = f"/compare, cell {row['cell_b']} against {row['cell_a']}, {row['phase']}"
        if len(logs) != row["n_pairs"] or not is_near(math.exp(median(logs)), row["ratio"]):
            found.append(f"{name}: not the ratio of its samples")
        elif row["ci_lo"] == row["ci_lo"] and not any(
                is_near(math.exp(lo), row["ci_lo"]) and is_near(math.exp(hi), row["ci_hi"])
                for lo, hi in intervals(logs, [input_of[key] for key, _ in both])):
            found.append(f"{name}: not an interval of its samples")
        elif row["verdict"] in ("faster", "slower") and not is_held(row):
            found.append(f"{name}: called {row['verdict']}, and its interval or the noise floor does not")
    return found
