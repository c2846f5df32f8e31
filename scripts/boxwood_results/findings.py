"""What the file says of contenders against each other: rows of /compare and /findings, read and never derived."""

import math
from dataclasses import dataclass

from boxwood.results.words import interval_text

PEERS, OURS, THREADS, STAGES, DEVICES, ERRORS = "peers", "ours", "threads", "stages", "devices", "errors"  # families of /compare
RACE, CALL, KERNEL = "race", "call", "kernel"  # topics of /findings about rivals: times of trees and meshes, of kernels; who is cheapest and right


@dataclass(frozen=True)
class Ratio:
    """A ratio of times with the interval that decided; lo and hi are NaN where there is none."""

    mid: float
    lo: float
    hi: float

    @property
    def known(self):
        return not math.isnan(self.lo)

    @property
    def text(self):
        """'3.12x (2.98 to 3.20)'."""
        return interval_text(self.mid, self.lo, self.hi)

    def inverse(self):
        return Ratio(1 / self.mid, 1 / self.hi, 1 / self.lo)


@dataclass(frozen=True)
class Comparison:
    """A row of /compare: the time of b over that of a."""

    a: object
    b: object
    phase: str
    contender_class: str
    rounds: int
    ratio: Ratio
    p: float
    floor: float  # the A/A noise of its class; NaN where there is none
    family: str
    verdict: str
    reason: str
    verdict_text: str

    @property
    def gain(self):
        """Time of a over that of b: above 1, b is the faster."""
        return self.ratio.inverse()

    @property
    def is_open(self):
        return self.verdict == "cannot_tell"

    @property
    def text(self):
        return self.gain.text


@dataclass(frozen=True)
class Finding:
    """A row of /findings. Cells are None where the row names none."""

    topic: str
    is_headline: bool
    is_loss: bool
    task: str
    threads: int
    contender_class: str
    question: str
    together: str
    alone: str
    certainty: str
    ours: object
    rival: object
    ours_alone: object
    rival_alone: object


def read_comparisons(table, cells):
    return [
        Comparison(
            cells[row["cell_a"]], cells[row["cell_b"]], row["phase"], row["class"], int(row["n_pairs"]),
            Ratio(float(row["ratio"]), float(row["ci_lo"]), float(row["ci_hi"])), float(row["p_adj"]), float(row["floor"]),
            row["family"], row["verdict"], row["reason"], row["words"],
        )
        for row in table
    ]


def read_findings(table, cells):
    """In the order of the file: losses first."""
    return [
        Finding(
            row["topic"], bool(row["is_headline"]), bool(row["is_loss"]), row["task"], int(row["threads"]), row["class"], row["question"],
            row["together"], row["alone"], row["certainty"],
            *(cells.get(row[side]) for side in ("ours", "rival", "ours_alone", "rival_alone")),
        )
        for row in sorted(table, key=lambda row: row["place"])
    ]


def footer(run):
    """What to know of every ratio that a figure shows."""
    return f"Each ratio is the median of per-round ratios, with the interval that decided. {run.health['trust']}."


def comparison_rows(comparisons):
    """Columns and rows of comparisons, for a table."""
    columns = ("job", "class", "family", "judged", "against", "phase", "rounds", "time of that / judged", "low", "high",
               "p adjusted", "verdict")
    rows = [
        (str(c.b.job), c.contender_class, c.family, c.b.label, c.a.label if c.a.job == c.b.job else f"{c.a.label}, {c.a.job.where}", c.phase,
         c.rounds, c.gain.mid, c.gain.lo, c.gain.hi, c.p, c.verdict_text)
        for c in comparisons
    ]
    return columns, rows
