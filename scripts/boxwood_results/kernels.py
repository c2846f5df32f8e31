"""Kernels on hard cases: what each kernel costs and how often it is wrong."""

from collections import defaultdict
from dataclasses import dataclass

from boxwood.results.words import count_text

MIN_ERROR = 2.0**-53  # a relative error below half an ulp of a double is none


@dataclass
class KernelPoint:
    """A row of /kernels: one kernel, ours or a peer's, on one family of hard cases."""

    row: object
    cell: object

    @property
    def task(self):
        return self.row["task"]

    @property
    def panel(self):
        return self.row["panel"]

    @property
    def cases(self):
        """The family with its parameters."""
        return self.cell.job.scene

    @property
    def kernel(self):
        return self.row["label"]

    @property
    def ours(self):
        return self.cell.ours

    @property
    def library(self):
        return self.cell.library

    @property
    def supported(self):
        return self.row["status"] != "unsupported" and self.n > 0

    @property
    def n(self):
        return int(self.row["n"])

    @property
    def ns(self):
        return float(self.row["ns"])

    @property
    def wrong(self):
        return int(self.row["wrong"])

    @property
    def maybe(self):
        """Cases without an answer, or with one that says nothing."""
        return int(self.row["maybe"])

    @property
    def error(self):
        return float(self.row["max_rel_err"])

    @property
    def tiers(self):
        return [int(self.row[f"tier_{k}"]) for k in range(4)]


@dataclass
class Kernel:
    """A row of /kernel_costs: one kernel over all families of one panel."""

    task: str
    panel: str
    name: str
    ours: bool
    library: str
    promise: str
    ns: float  # mean over the families
    n: int
    wrong: int
    maybe: int
    error: float  # the worst; NaN if it gives no numbers
    per_million: float
    unexcluded: float  # of a million: what so many right answers do not exclude; NaN if some are wrong
    by_error: bool  # its task is judged by errors, not by yes or no
    badness: float  # wrong of a million; or the error, 0 where there is none to speak of, infinite where no digit is right
    on_front: bool  # ours, never undecided, and no faster such one errs less
    peer: object = None  # a cell of its library, if that is another

    @property
    def open_text(self):
        """How many of its cases it does not decide; empty if none."""
        return f"{count_text(self.maybe)} of {count_text(self.n)}" if self.maybe else ""


def read_costs(table, peers):
    """In the order of the file: of each task its panels, of each panel those of ours first, by rising time."""
    return [
        Kernel(row["task"], row["panel"], row["kernel"], not row["is_peer"], row["library"], row["promise"],
               float(row["ns"]), int(row["n"]), int(row["wrong"]), int(row["maybe"]), float(row["max_rel_err"]),
               float(row["wrong_per_million"]), float(row["unexcluded_per_million"]), bool(row["by_error"]),
               float(row["badness"]), bool(row["on_front"]), peers.get(row["library"]))
        for row in table
    ]


def by_kernel_family(run):
    groups = defaultdict(list)
    for point in run.kernels:
        groups[point.task].append(point)
    return dict(groups)
