"""Kernels on hard cases: what each kernel costs and how often it is wrong."""

from collections import defaultdict
from dataclasses import dataclass

PANELS = ("generic", "touching", "degenerate")
DISTANCES = ("triangle_distance", "segment_segment", "point_triangle", "point_segment")
LEAST_ERROR = 2.0**-53  # a relative error below half an ulp of a double is none


@dataclass
class KernelPoint:
    """One kernel, ours or a peer's, on one family of hard cases."""

    row: object
    cell: object
    conditions: list  # rows of the table `conditions`

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
        """As a label; a peer that has one name in both precisions says which."""
        kernel, precision = self.row["kernel"], self.cell.precision
        return kernel if self.ours or precision == "f64" or precision in kernel else f"{kernel} {precision}"

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
        """Per call: the sweep's median where there is one, else the check's own timing."""
        sweep = self.cell.median("query")
        return sweep / self.n if sweep == sweep and self.n else float(self.row["ns_per_call"])

    @property
    def wrong(self):
        return sum(int(self.row[name]) for name in ("false_pos", "false_neg", "bound_violations"))

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

    @property
    def per_million(self):
        return 1e6 * self.wrong / self.n


def read_costs(table):
    """In the order of the file: those of ours first, by rising time."""
    return [
        Kernel(row["task"], row["panel"], row["kernel"], not row["is_peer"], row["library"], row["promise"],
               float(row["ns"]), int(row["n"]), int(row["wrong"]), int(row["maybe"]), float(row["max_rel_err"]))
        for row in table
    ]


def by_kernel_family(run):
    groups = defaultdict(list)
    for point in run.kernels:
        groups[point.task].append(point)
    return dict(groups)


def is_measured(task):
    """Whether a kernel is judged by its error (distances), not by yes or no."""
    return task in DISTANCES
