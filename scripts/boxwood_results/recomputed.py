"""What a file says, held against its own samples: a second way to the numbers of bench/analysis, in another language."""

import math
from collections import Counter, defaultdict
from statistics import median

from .run import AA_TWIN, WHOLE_QUERY

SUMS = {"build+query": ("build", "query"), "update+query": ("update", "query")}
MIN_ROUNDS_OF_VERDICT = 9
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


DECIDED = ("faster", "slower")
ERROR = 0.05  # of all claims of a task together
OF_THE_INTERVAL = ("too_noisy", "below_the_floor", "crosses_1")


def is_held(row, verdict):
    """Whether a verdict's interval lies beyond 1, and the ratio beyond the noise floor; all of the interval, where that is above delta."""
    near_end, floor = row["ci_hi" if verdict == "faster" else "ci_lo"], row["floor"]
    held = near_end if floor > row["delta"] else row["ratio"]
    beyond_1 = near_end < 1 if verdict == "faster" else near_end > 1
    return beyond_1 and not (floor >= 0 and 1 / (1 + floor) <= held <= 1 + floor)


def is_same(row):
    """Whether all of the interval is within delta of 1, and the noise floor, where it is known, no higher."""
    return all(1 / (1 + row["delta"]) <= row[end] <= 1 + row["delta"] for end in ("ci_lo", "ci_hi")) and not row["floor"] > row["delta"]


def has_enough(row, n_claims):
    """Whether so many rounds have an interval even at the level that a claim has if it is the only clear one of its task."""
    return row["n_pairs"] >= MIN_ROUNDS_OF_VERDICT and 2 * n_claims / 2 ** int(row["n_pairs"]) <= ERROR


def unlike_its_interval(row, n_claims):
    """What is wrong with a verdict, in words; empty if its interval and the noise floor say the same."""
    verdict, reason = row["verdict"], row["reason"]
    if (verdict in DECIDED and not is_held(row, verdict)) or (verdict == "same" and not is_same(row)):
        return f"called {verdict}, and its interval or the noise floor does not"
    if verdict == "cannot_tell" and reason in OF_THE_INTERVAL and any(is_held(row, one) for one in DECIDED):
        return f"called open ({reason}), and its interval and the noise floor decide it"
    if verdict == "cannot_tell" and reason == "too_few_rounds" and has_enough(row, n_claims):
        return f"called open ({reason}), and {row['n_pairs']} are enough"
    return ""


def differences(source):
    """What the tables that are published do not have from /samples and from what was counted, as texts; none if all follows."""
    times = rounds_by_cell(source)
    return [*medians_and_ratios(source, times), *kernels(source, times), *kernel_costs(source), *effect_costs(source, times),
            *device_gains(source, times)]


def kernels(source, times):
    for row in source["kernels"]:
        values = [ns for of_round in times.get((row["cell_id"], "query"), {}).values() for ns in of_round]
        n, wrong = int(row["n"]), sum(int(row[column]) for column in ("false_pos", "false_neg", "bound_violations"))
        name = f"/kernels, cell {row['cell_id']}, {row['kernel']} on {row['family']}"
        if n and values and not is_near(median(values) / n, row["ns"]):
            yield f"{name}: not the time of its samples"
        if wrong != row["wrong"] or (n and not is_near(1e6 * wrong / n, row["wrong_per_million"])):
            yield f"{name}: not as many wrong as were counted"


def kernel_costs(source):
    variants = {row["variant_id"]: row for row in source["variants"]}
    of_cell = {row["cell_id"]: variants[row["variant_id"]] for row in source["cells"]}
    judged = defaultdict(list)
    for row in source["kernels"]:
        if row["family"] != WHOLE_QUERY and row["n"] and row["status"] != "unsupported" and row["ns"] == row["ns"]:
            variant = of_cell[row["cell_id"]]
            judged[row["task"], row["panel"], bool(variant["is_peer"]), variant["library"], row["label"]].append(row)
    best = {}  # (task, panel): badness of the last on the front
    for row in source["kernel_costs"]:
        key = row["task"], row["panel"], bool(row["is_peer"]), row["library"], row["kernel"]
        rows, name = judged.pop(key, []), f"/kernel_costs, {row['task']}, {row['panel']}, {row['kernel']}"
        n, wrong, maybe = (sum(int(one[column]) for one in rows) for column in ("n", "wrong", "maybe"))
        if not rows or (n, wrong, maybe) != (row["n"], row["wrong"], row["maybe"]) or not is_near(1e6 * wrong / n, row["wrong_per_million"]):
            yield f"{name}: not the sums of its families"
        elif not is_near(sum(float(one["ns"]) for one in rows) / len(rows), row["ns"]):
            yield f"{name}: not the mean of its families"
        front = not row["is_peer"] and not maybe and (key[:2] not in best or row["badness"] < best[key[:2]])
        if front != bool(row["on_front"]):
            yield f"{name}: " + ("no faster one that always decides betters it, and it is not on the front" if front else
                                 "on the front, though it leaves cases open or a faster one betters it")
        if front:
            best[key[:2]] = row["badness"]
    for task, panel, _, _, label in judged:
        yield f"/kernel_costs, {task}, {panel}, {label}: missing"


def shared(times, cell, other, phase):
    """The median of a cell in the rounds that another has, too."""
    own, of_other = times.get((cell, phase), {}), times.get((other, phase), {})
    values = [ns for key in own.keys() & of_other.keys() for ns, _ in pairs(own, of_other, key)]
    return median(values) if values else math.nan


def totals_of_cells(source):
    totals = {row["task"]: row["total"] for row in source["tasks"]}
    return {row["cell_id"]: totals[row["task"]] for row in source["cells"]}


def compared(source, family):
    return {(row["cell_a"], row["cell_b"], row["phase"]): row for row in source["compare"] if row["family"] == family}


def is_of(row, comparison, columns=("ratio", "ci_lo", "ci_hi")):
    return row["ratio"] != row["ratio"] or (comparison is not None and all(row[column] == comparison[column] for column in columns))


def effect_costs(source, times):
    totals, ratios = totals_of_cells(source), compared(source, "stages")
    for row in source["effect_costs"]:
        of, without, total = row["cell_with"], row["cell_without"], totals[row["cell_with"]]
        name = f"/effect_costs, cell {of}, {row['what']}"
        if not (is_near(shared(times, of, without, total), row["with_ns"]) and is_near(shared(times, without, of, total), row["without_ns"])):
            yield f"{name}: not the medians of its samples"
        if not is_of(row, ratios.get((without, of, total))):
            yield f"{name}: not the ratio of its comparison"


def device_gains(source, times):
    totals, ratios = totals_of_cells(source), compared(source, "devices")
    for row in source["device_gains"]:
        device = row["cell_device"]
        total = totals[device]
        name = f"/device_gains, {row['task']}, {row['n']}"
        for column, cell in (("cpu_1_ns", "cell_1"), ("cpu_2_ns", "cell_2"), ("cpu_all_ns", "cell_all"), ("end_to_end_ns", "cell_device"),
                             ("resident_ns", "cell_resident"), ("graph_ns", "cell_graph")):
            if row[column] == row[column] and not is_near(shared(times, row[cell], device, total), row[column]):
                yield f"{name}: {column} is not the median of its samples"
        if not is_of(row, ratios.get((row["cell_cpu"], device, total)), ("ratio", "ci_lo", "ci_hi", "verdict")):
            yield f"{name}: not the ratio of its comparison"


def medians_and_ratios(source, times):
    machine = {row["env_id"]: row["env_hash"] for row in source["env"]}
    input_of = {(machine[row["env_id"]], row["round"]): row["input"] for row in source["shards"]}
    task_of = {row["cell_id"]: row["task"] for row in source["cells"]}
    claims = Counter((row["family"], task_of[row["cell_b"]]) for row in source["compare"])
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
        elif unlike := unlike_its_interval(row, claims[row["family"], task_of[row["cell_b"]]]):
            found.append(f"{name}: {unlike}")
    return found
