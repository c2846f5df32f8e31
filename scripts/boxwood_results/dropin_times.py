"""What `scripts/dropin_bench` had `boxwood replay` measure: a program's calls to FCL's or Coal's manager, with ours in its place.
Its samples, round by round, are here made into medians and intervals, and held against the program's own."""

import json
import math
import statistics
from dataclasses import dataclass
from pathlib import Path

from .checkout import environment_of
from .python_times import median_interval, open_mark
from boxwood.results.reader import BadFile
from boxwood.results.words import interval_text, time_text

# What stands in the place of a library's managers, whose names begin with the library's.
OURS = {"fcl": "boxwood.fcl_manager", "coal": "boxwood.coal_manager"}
WORLD = "boxwood.world"  # with a narrow phase of its own
# Of made programs: frames by their number of bodies, and the shares that move. Published are all of them.
FRAMES = {1_000: 50, 10_000: 20, 100_000: 10}
MESH_FRAMES = {1_000: 10, 10_000: 2}  # of bodies that are meshes
MOVED = (1, 0.01)
# Of each library its dynamic tree, of pointers or in an array; by bounds in Morton order, too.
TREES = ("dynamic_aabb_tree", "dynamic_aabb_tree_array")
MIN_ROUNDS = 9  # that an interval takes
NEAR = 1e-6  # of the program's own ratio and that of its samples


@dataclass(frozen=True)
class Run:
    """A made program: so many bodies, of which a share moves in each of its frames. With triangles it asks which touch, and in each
    frame for some distances; else for pairs of bounds."""

    bodies: int
    moved: float
    frames: int
    managers: list  # as `boxwood replay --json` has them, of bounds alone or of shapes, the first of them ours
    triangles: int = 0  # of each body
    distances: int = 0  # that are asked for in a frame
    queries: int = 0
    checked: int = 0  # of them, against the truth

    def ours(self, library):
        return WORLD if self.triangles else OURS.get(library, "")

    def times(self, name):
        """Of a manager, by round; None if it was not there."""
        return next((row["rounds_ns"] for row in self.managers if row["manager"] == name), None)

    def over(self, manager, ours):
        """(median, lo, hi) of its time over ours, round by round."""
        return median_interval([theirs / own for theirs, own in zip(self.times(manager), self.times(ours))])

    def fastest(self):
        """{library: (its manager that takes the least of those that answer rightly, (median, lo, hi) of its time over ours)}.

        Where the truth was not known, rightly is as ours does."""
        found = {}
        for row in self.managers:
            library = row["manager"].split(".")[0]
            if library in OURS and self.times(self.ours(library)) and not row["wrong"] and not row.get("differ"):
                over = self.over(row["manager"], self.ours(library))
                if library not in found or over < found[library][1]:
                    found[library] = row["manager"], over
        return found

    def fault(self, rounds):
        """Why these rows are not to be used; empty if they are."""
        for row in self.managers:
            times, first = row["rounds_ns"], self.managers[0]["rounds_ns"]
            if row["manager"] in (*OURS.values(), WORLD) and (row["wrong"] or row.get("differ", 0)):
                return f"{row['manager']} is wrong"
            if len(times) != rounds or rounds < MIN_ROUNDS or not min(times) > 0:
                return f"{row['manager']} has not a time above 0 of each of {max(rounds, MIN_ROUNDS)} rounds"
            if not math.isclose(statistics.median(ns / own for ns, own in zip(times, first)), row["over_first"]["mid"], rel_tol=NEAR):
                return f"{row['manager']}: its ratio does not follow from its rounds"
        if not self.checked:
            return "no answer was checked"
        return "" if self.times(self.ours("fcl")) else f"{self.ours('fcl')} is missing"

    def missing(self):
        """Managers without which the fastest may be missing."""
        if self.triangles:
            wanted = [f"{library}.{tree}, {shapes}" for library, shapes in (("fcl", "FCL's shapes"), ("coal", "Coal's shapes")) for tree in TREES]
        else:
            wanted = [f"{library}.{tree}{order}" for library in OURS for tree in TREES for order in ("", ".morton")]
        return [name for name in wanted if not self.times(name)]

    def why_not(self, names):
        """Of managers that answer wrongly, what the best of them does; empty if one does not, or there is none."""
        rows = [row for row in self.managers if row["manager"] in names]
        faults = [(row["wrong"], row.get("differ", 0)) for row in rows]
        if not faults or (0, 0) in faults:
            return ""
        wrong, differ = min(faults)
        return f"{wrong} wrong" if wrong and self.checked else f"{wrong + differ} unlike ours"


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


def lacks(times):
    """What is missing of what is to be published, in words."""
    there = {(run.bodies, run.moved, bool(run.triangles)) for run in times.runs}
    found = [f"the program of {bodies:,} {'meshes' if are_meshes else 'bodies'} of which {moved:.0%} move"
             for are_meshes, programs in ((False, FRAMES), (True, MESH_FRAMES)) for bodies in programs for moved in MOVED
             if (bodies, moved, are_meshes) not in there]
    found += [f"the program of {run.bodies:,} {'meshes' if run.triangles else 'bodies'} in {wanted} frames: it has one of {run.frames}"
              for run in times.runs if (wanted := (MESH_FRAMES if run.triangles else FRAMES).get(run.bodies, run.frames)) != run.frames]
    return found + [f"{name} with {run.bodies:,} bodies" for run in times.runs for name in run.missing()]


def read(path):
    try:
        found = json.loads(Path(path).read_text(encoding="utf-8"))
        times = DropinTimes(int(found["rounds"]), [Run(**run) for run in found["runs"]], environment_of(found["env"]))
        if not times.runs:
            raise ValueError("no program")
        for run in times.runs:
            if fault := run.fault(times.rounds):
                raise ValueError(f"{run.bodies} bodies: {fault}")
        return times
    except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
        raise BadFile(path, f"it is no file of scripts/dropin_bench --out ({error})") from error


def moved_text(run):
    return "all" if run.moved == 1 else f"{100 * run.moved:g} %"


def times_text(run, name):
    own = run.times(name)
    return f"{time_text(statistics.median(own))} for {run.frames} frames" if own else ""


def over_text(over, what=""):
    return f"{interval_text(*over)}{open_mark(over)} {what}".rstrip()


def table(times):
    """[header, row, ...] of texts: of bounds."""
    rows = [["bodies", "that move in a frame", "boxwood::FclBroadPhase", "FCL's fastest over ours", "boxwood::CoalBroadPhase",
             "Coal's fastest over ours", "queries checked"]]
    for run in times.runs:
        if not run.triangles:
            fastest = run.fastest()
            rows.append([f"{run.bodies:,}", moved_text(run)])
            for library, name in OURS.items():
                manager, over = fastest.get(library, ("", None))
                rows[-1] += [times_text(run, name), over_text(over, manager) if over else ""]
            rows[-1].append(f"{run.checked:,} of {run.queries:,}")
    return rows


def rival_text(run, library):
    """Its fastest manager and shapes over ours, or how many of its answers are wrong."""
    fastest = run.fastest()
    if library in fastest:
        name, over = fastest[library]
        return over_text(over, name.split(",")[0].removeprefix(f"{library}."))
    return run.why_not([row["manager"] for row in run.managers if row["manager"].split(".")[0] == library])


def with_shapes_text(run, library):
    """Of our manager with a library's shapes, in doubles or in floats: the faster."""
    rows = [row for row in run.managers if row["manager"].startswith(OURS[library])]
    right = [run.over(row["manager"], WORLD) for row in rows if not row["wrong"] and not row.get("differ")]
    return over_text(min(right)) if right else run.why_not([row["manager"] for row in rows])


def worlds_table(times):
    """[header, row, ...] of texts: of bodies that are meshes."""
    rows = [["bodies", "triangles of each", "that move in a frame", "distances in a frame", "answers checked", "boxwood::World",
             "FCL's fastest over ours", "Coal's fastest over ours", "FclBroadPhase with FCL's shapes over ours", "CoalBroadPhase with Coal's shapes over ours"]]
    for run in times.runs:
        if run.triangles:
            rows.append([f"{run.bodies:,}", f"{run.triangles:,}", moved_text(run), f"{run.distances:,}", f"{run.checked:,} of {run.queries:,}",
                         times_text(run, WORLD), *(rival_text(run, library) for library in OURS),
                         *(with_shapes_text(run, library) for library in OURS)])
    return rows
