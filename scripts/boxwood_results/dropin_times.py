"""What `scripts/dropin_bench` had `boxwood replay` measure: a program's calls to FCL's manager, with ours in its place. Medians,
ratios and intervals are the program's."""

import json
from dataclasses import dataclass
from pathlib import Path

from .checkout import ENV
from boxwood.results.reader import BadFile
from boxwood.results.words import interval_text, time_text

OURS = "boxwood.fcl_manager"
LIBRARIES = {"fcl": "FCL", "coal": "Coal"}  # a manager's name begins with its library


@dataclass(frozen=True)
class Run:
    """A made program: so many bodies, of which a share moves in each of its frames."""

    bodies: int
    moved: float
    frames: int
    managers: list  # as `boxwood replay --json` has them, of bounds alone

    @property
    def ours(self):
        return next(row for row in self.managers if row["manager"] == OURS)

    def fastest(self):
        """{library: its manager that takes the least of those that answer rightly}."""
        found = {}
        for row in sorted(self.managers, key=lambda row: row["over_first"]["mid"]):
            if not row["wrong"]:
                found.setdefault(row["manager"].split(".")[0], row)
        return found


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
            if run.ours["wrong"] or not run.ours["total_ns"] > 0:
                raise ValueError(f"{run.bodies} bodies: ours is wrong, or took no time")
            for row in run.managers:
                if not 0 < row["over_first"]["lo"] <= row["over_first"]["mid"] <= row["over_first"]["hi"]:
                    raise ValueError(f"{run.bodies} bodies: {row['manager']} has no interval; it takes 9 rounds")
        return times
    except (OSError, ValueError, KeyError, TypeError, StopIteration) as error:
        raise BadFile(path, f"it is no file of scripts/dropin_bench --out ({error})") from error


def table(times):
    """[header, row, ...] of texts."""
    rows = [["bodies", "that move in a frame", "boxwood::FclBroadPhase", *(f"{title}'s fastest / ours" for title in LIBRARIES.values())]]
    for run in times.runs:
        fastest = run.fastest()
        ratios = [ratio_of(fastest[library]) if library in fastest else "" for library in LIBRARIES]
        rows.append([f"{run.bodies:,}", "all" if run.moved == 1 else f"{100 * run.moved:g} %",
                     f"{time_text(run.ours['total_ns'])} for {run.frames} frames", *ratios])
    return rows


def ratio_of(row):
    over = row["over_first"]
    mark = " ?" if over["lo"] <= 1 <= over["hi"] else ""
    return f"{interval_text(over['mid'], over['lo'], over['hi'])}{mark} {row['manager']}"
