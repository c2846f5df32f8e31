"""What `scripts/dropin_bench` had `boxwood replay` measure: a program's calls to FCL's or Coal's manager, with ours in its place.
Its samples, round by round, are here made into medians and intervals, and held against the program's own."""

import json
import math
import statistics
from dataclasses import dataclass
from pathlib import Path

from .checkout import ENV
from .python_times import median_interval, open_mark
from boxwood.results.reader import BadFile
from boxwood.results.words import interval_text, time_text

# What stands in the place of a library's managers, whose names begin with the library's.
OURS = {"fcl": "boxwood.fcl_manager", "coal": "boxwood.coal_manager"}
NEAR = 1e-6  # of the program's own ratio and that of its samples


@dataclass(frozen=True)
class Run:
    """A made program: so many bodies, of which a share moves in each of its frames."""

    bodies: int
    moved: float
    frames: int
    managers: list  # as `boxwood replay --json` has them, of bounds alone, the first of them ours

    def times(self, name):
        """Of a manager, by round; None if it was not there."""
        return next((row["rounds_ns"] for row in self.managers if row["manager"] == name), None)

    def fastest(self):
        """{library: (its manager that takes the least of those that answer rightly, (median, lo, hi) of its time over ours)}."""
        found = {}
        for row in self.managers:
            library = row["manager"].split(".")[0]
            ours = self.times(OURS.get(library, ""))
            if ours and not row["wrong"]:
                over = median_interval([theirs / own for theirs, own in zip(row["rounds_ns"], ours)])
                if library not in found or over < found[library][1]:
                    found[library] = row["manager"], over
        return found

    def fault(self):
        """Why these rows are not to be used; empty if they are."""
        for row in self.managers:
            times, first = row["rounds_ns"], self.managers[0]["rounds_ns"]
            if row["manager"] in OURS.values() and row["wrong"]:
                return f"{row['manager']} is wrong"
            if len(times) != len(first) or len(times) < MIN_ROUNDS or not min(times) > 0:
                return f"{row['manager']} has not a time above 0 of each of {MIN_ROUNDS} rounds at least"
            if not math.isclose(statistics.median(ns / own for ns, own in zip(times, first)), row["over_first"]["mid"], rel_tol=NEAR):
                return f"{row['manager']}: its ratio does not follow from its rounds"
        return "" if self.times(OURS["fcl"]) else f"{OURS['fcl']} is missing"


MIN_ROUNDS = 9


@dataclass(frozen=True)
class DropinTimes:
    rounds: int
    runs: list
    env: dict  # of ENV

    def write(self, path):
        part = Path(f"{path}.part")
        part.write_text(json.dumps({"env": self.env, "rounds": self.rounds, "runs": [vars(run) for run in self.runs]}) + "\n",
                        encoding="utf-8")
        part.replace(path)


def read(path):
    try:
        found = json.loads(Path(path).read_text(encoding="utf-8"))
        times = DropinTimes(int(found["rounds"]), [Run(**run) for run in found["runs"]], {key: found["env"][key] for key in ENV})
        if not times.runs:
            raise ValueError("no program")
        for run in times.runs:
            if run.fault():
                raise ValueError(f"{run.bodies} bodies: {run.fault()}")
        return times
    except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
        raise BadFile(path, f"it is no file of scripts/dropin_bench --out ({error})") from error


def table(times):
    """[header, row, ...] of texts."""
    rows = [["bodies", "that move in a frame", "boxwood::FclBroadPhase", "FCL's fastest / it", "boxwood::CoalBroadPhase", "Coal's fastest / it"]]
    for run in times.runs:
        row = [f"{run.bodies:,}", "all" if run.moved == 1 else f"{100 * run.moved:g} %"]
        fastest = run.fastest()
        for library, name in OURS.items():
            own = run.times(name)
            row.append(f"{time_text(statistics.median(own))} for {run.frames} frames" if own else "")
            manager, over = fastest.get(library, ("", None))
            row.append(f"{interval_text(*over)}{open_mark(over)} {manager}" if over else "")
        rows.append(row)
    return rows
