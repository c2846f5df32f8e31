"""What a file says, held against its own samples: a second way to the numbers of bench/analysis, in another language."""

import math
from collections import defaultdict
from statistics import median

from . import verdicts
from .run import AA_TWIN, WHOLE_QUERY
from .verdicts import SUMS, is_near, pairs


def rounds_by_cell(source, of_twins=False):
    """{(cell, phase): {(machine, round): [ns, ...]}} without the twins, sums included; or of what was timed twice the second times."""
    machine = {row["env_id"]: row["env_hash"] for row in source["env"]}
    shards = {row["shard_id"]: row for row in source["shards"]}
    rows = [row for row in source["samples"] if bool(row["flags"] & AA_TWIN) == of_twins and row["wall_ns"] > 0 and math.isfinite(row["wall_ns"])]
    found = defaultdict(lambda: defaultdict(list))
    for row in sorted(rows, key=lambda row: shards[row["shard_id"]]["t0_utc_ns"]):
        key = machine[shards[row["shard_id"]]["env_id"]], row["round"]
        found[row["cell_id"], row["phase"]][key].append(float(row["wall_ns"]))
    for cell in {cell for cell, _ in found} if not of_twins else ():
        for phase, (first, second) in SUMS.items():
            if (cell, first) in found and (cell, second) in found:
                found[cell, phase] = defaultdict(list)
                for key, a, b in pairs(found[cell, first], found[cell, second]):
                    found[cell, phase][key].append(a + b)
    return found


def differences(source):
    """What the tables that are published do not have from /samples and from what was counted, as texts; none if all follows."""
    times = rounds_by_cell(source)
    twins = rounds_by_cell(source, of_twins=True)
    return [*medians(source, times), *statuses(source), *verdicts.differences(source, times, twins), *kernels(source, times), *kernel_costs(source),
            *effect_costs(source, times), *device_gains(source, times)]


def statuses(source):
    for row in source["checks"]:
        wrong = row["missing"] or row["extra"] or row["bound_violations"]
        if (row["status"] == "wrong" and not (wrong or row["witness"])) or (row["status"] == "exact" and wrong):
            yield f"/checks, cell {row['cell_id']}: called {row['status']}, and what was counted says otherwise"


def kernels(source, times):
    for row in source["kernels"]:
        took = own_median(times, row["cell_id"], "query")
        n, wrong = int(row["n"]), sum(int(row[column]) for column in ("false_pos", "false_neg", "bound_violations"))
        name = f"/kernels, cell {row['cell_id']}, {row['kernel']} on {row['family']}"
        if n and took == took and not is_near(took / n, row["ns"]):
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


def own_median(times, cell, phase):
    values = [ns for of_round in times.get((cell, phase), {}).values() for ns in of_round]
    return median(values) if values else math.nan


def shared(times, cell, other, phase):
    """The median of a cell in the rounds that another has, too."""
    own, of_other = times.get((cell, phase), {}), times.get((other, phase), {})
    values = [ns for _, ns, _ in pairs(own, of_other)]
    return median(values) if values else math.nan


def totals_of_cells(source):
    totals = {row["task"]: row["total"] for row in source["tasks"]}
    return {row["cell_id"]: totals[row["task"]] for row in source["cells"]}


def compared(source, family):
    return {(row["cell_a"], row["cell_b"], row["phase"]): row for row in source["compare"] if row["family"] == family}


def is_of(row, comparison, columns=("ratio", "ci_lo", "ci_hi")):
    if comparison is None:
        return row["ratio"] != row["ratio"]
    both = [(row[column], comparison[column]) for column in columns]
    return all(a == b or (a != a and b != b) for a, b in both)  # numbers may be NaN


def effect_costs(source, times):
    totals, ratios = totals_of_cells(source), compared(source, "stages")
    for row in source["effect_costs"]:
        of, without, total = row["cell_with"], row["cell_without"], totals[row["cell_with"]]
        name = f"/effect_costs, cell {of}, {row['what']}"
        if not (is_near(own_median(times, of, total), row["with_ns"]) and is_near(own_median(times, without, total), row["without_ns"])):
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


def medians(source, times):
    for row in source["medians"]:
        n = sum(len(of_round) for of_round in times.get((row["cell_id"], row["phase"]), {}).values())
        if n != row["n"] or not is_near(own_median(times, row["cell_id"], row["phase"]), row["median_ns"]):
            yield f"/medians, cell {row['cell_id']}, {row['phase']}: not the median of its samples"
