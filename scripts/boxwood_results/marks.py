"""What was set as a mark beside what the published files say: results/published/marks.toml names each, and where it is measured."""

import math
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from . import dropin_times
from .findings import PEERS, Ratio
from .published_tables import OPEN, kernel_questions
from boxwood.results.reader import BadFile
from boxwood.results.words import ratio_text

FILE = Path("results") / "published" / "marks.toml"
KEYS = {"work": str, "against": str, "mean": (int, float), "least": (int, float), "highest": (int, float), "sweep": str, "dropin": str, "tasks": list, "phase": str,
        "scenes": str, "ours": str, "rivals": str, "class": str, "family": str, "bodies": list, "needs": dict, "missing": str}
TABLES = {"bounds": False, "worlds": True}  # of dropin.json -> whether bodies are meshes


@dataclass(frozen=True)
class Gain:
    """What one job shows: the time of the best rival over that of the best of ours."""

    where: str
    job: str  # 'sphere_mesh_near/n10000', or of a program its number of bodies
    ratio: Ratio
    is_open: bool

    @property
    def text(self):
        return self.ratio.text + (OPEN if self.is_open else "")


@dataclass(frozen=True)
class Mark:
    work: str
    against: str
    mean: float = 0  # 0: not asked for
    least: float = 0
    highest: float = 0
    sweep: str = ""
    dropin: str = ""
    tasks: tuple = ()
    phase: str = "query"
    scenes: str = ""
    ours: str = ""
    rivals: str = ""
    contender_class: str = ""
    family: str = PEERS
    bodies: tuple = ()
    needs: dict = field(default_factory=dict)  # {what in words: pattern of a job that must be among those measured}
    missing: str = ""

    def takes(self, row):
        return (row.b.job.task in self.tasks and row.contender_class == self.contender_class and row.verdict != "wrong"
                and all(re.search(pattern, text) for pattern, text in ((self.scenes, row.b.job.scene), (self.ours, row.b.contender),
                                                                       (self.rivals, row.a.contender))))

    @property
    def text(self):
        """'12x, least 6x'."""
        return ", ".join(f"{name}{wanted:g}x" for name, wanted in (("", self.mean), ("least ", self.least), ("at most ", self.highest)) if wanted)


def read(path):
    """The marks of a file. An unknown key, or one of another kind, is an error."""
    try:
        found = tomllib.loads(path.read_text(encoding="utf-8")).get("marks", [])
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise BadFile(path, str(error)) from error
    if not found:
        raise BadFile(path, "it holds no [[marks]]")
    for row in found:
        faults = [f"key '{key}' is not known, or of another kind" for key, value in row.items() if not isinstance(value, KEYS.get(key, ()))]
        faults += [f"key '{key}' is missing" for key in ("work", "against") if key not in row]
        if len({"sweep", "dropin", "missing"} & row.keys()) != 1:
            faults.append("one of the keys 'sweep', 'dropin', 'missing' must say where it is measured")
        if row.get("dropin", "bounds") not in TABLES:
            faults.append(f"dropin: {' or '.join(TABLES)}")
        if not {"mean", "least", "highest", "missing"} & row.keys():
            faults.append("none of 'mean', 'least', 'highest' says what must be reached")
        if faults:
            raise BadFile(path, f"mark '{row.get('work', '?')}': {'; '.join(faults)}")
    return [Mark(**{"contender_class" if key == "class" else key: tuple(value) if isinstance(value, list) else value
                    for key, value in row.items()}) for row in found]


def best_of_jobs(mark, run):
    """Of each job the best of ours against its best rival, among those that the mark takes."""
    rows_of = {}
    for row in run.family(mark.family, mark.phase):
        if mark.takes(row):
            rows_of.setdefault(row.b.job, {}).setdefault(row.b.cell_id, []).append(row)
    for of_ours in rows_of.values():
        rows = sorted(of_ours.values(), key=lambda rows: rows[0].b.median(mark.phase))[0]
        yield sorted(rows, key=lambda row: row.gain.mid)[0]


def of_kernels(mark, run):
    """The same of kernels alone, of which some leave cases open or err."""
    for question in kernel_questions(run, mark.tasks):
        rows = sorted((row for row in question.rows if mark.takes(row)), key=lambda row: row.gain.mid)
        yield from rows[:1]


def gains_of_sweep(mark, run):
    tasks = {point.task for point in run.kernels}
    rows = of_kernels(mark, run) if tasks & set(mark.tasks) else best_of_jobs(mark, run)
    return [Gain(f"{row.b.scene_title}" + (f", {row.b.task.title}" if len(mark.tasks) > 1 else ""), f"{row.b.job.scene}/n{row.b.job.n}", row.gain, row.is_open)
            for row in rows]


def gains_of_dropin(mark, times):
    gains = []
    for run in times.runs:
        if bool(run.triangles) == TABLES[mark.dropin] and (not mark.bodies or run.bodies in mark.bodies):
            _, over = run.fastest().get("fcl", ("", None))
            if over:
                gains.append(Gain(f"{run.bodies:,} bodies, {dropin_times.moved_text(run)} moved", str(run.bodies), Ratio(*over),
                                  bool(dropin_times.open_mark(over))))
    return gains


def geometric_mean(ratios):
    return math.exp(math.fsum(math.log(ratio) for ratio in ratios) / len(ratios))


def reached(mark, gains):
    """'yes' where the intervals' ends reach it, too; and what the mark names that no published file holds."""
    def short(lowest, highest):
        low, high = [[end(gain.ratio) if gain.ratio.known else gain.ratio.mid for gain in gains] for end in (lowest, highest)]
        return [name for name, is_missed in (("mean", geometric_mean(low) < mark.mean), ("least", min(low) < mark.least),
                                             ("greatest", max(high) > (mark.highest or math.inf))) if is_missed]

    missed, unsure = short(lambda ratio: ratio.mid, lambda ratio: ratio.mid), short(lambda ratio: ratio.lo, lambda ratio: ratio.hi)
    verdict = f"no: the {' and the '.join(missed)}" if missed else f"open: the {' and the '.join(unsure)}" if unsure else "yes"
    absent = [what for what, pattern in mark.needs.items() if not any(re.search(pattern, gain.job) for gain in gains)]
    return f"{verdict}, without {', '.join(absent)}: not measured yet" if absent else verdict


def row_of(mark, gains):
    if not gains:
        return [mark.work, mark.against, mark.text, "", "", "", mark.missing or "not measured yet"]
    mean, by_gain = geometric_mean([gain.ratio.mid for gain in gains]), sorted(gains, key=lambda gain: gain.ratio.mid)
    worst = by_gain[-1 if mark.highest else 0]
    return [mark.work, mark.against, mark.text, str(len(gains)), f"{ratio_text(mean)}x", f"{worst.text}: {worst.where}", reached(mark, gains)]


HEADER = ["work", "against", "mark: geometric mean, least", "measured in", "geometric mean", "least, or greatest of what may be at most so much (interval)", "reached"]


def table(marks, runs, dropin):
    """[header, row, ...] of texts. runs: {sweep: run} of those that are published; dropin: DropinTimes, or None."""
    rows = [HEADER]
    for mark in marks:
        gains = []
        if mark.sweep in runs:
            gains = gains_of_sweep(mark, runs[mark.sweep])
        elif mark.dropin and dropin:
            gains = gains_of_dropin(mark, dropin)
        rows.append(row_of(mark, gains))
    return rows
